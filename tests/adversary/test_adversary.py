"""No wrong controller passes a profile while it clearly breaks one of its sentences; no right one fails."""

from pathlib import Path

import pytest

from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.results import Status
from trials import CODES, GRIDS, Trial, drawn, outcome_of, right_trial
from validation.mutations.slips import Slip, What, When

SEED, DRAWS, PARTS = 11, 100, 4
TWO = ((0.0, 0.25, "abc", 0.5), (0.55, 0.8, "abc", 0.7))


@pytest.mark.slow
@pytest.mark.parametrize("part", range(PARTS))
def test_nothing_is_let_through(part):
    """Of 100 wrong controllers none passes a profile while it breaks one of its sentences in the waveform."""
    found = {}
    for number, trial in enumerate(drawn(SEED, DRAWS)):
        if number % PARTS == part:
            outcome = outcome_of(trial)
            if outcome.is_let_through:
                found[trial.in_words] = outcome.broken
    assert not found


@pytest.mark.slow
@pytest.mark.parametrize("grid", GRIDS)
@pytest.mark.parametrize("name", CODES)
def test_the_right_controller_passes_and_breaks_nothing(name, grid):
    """Sags within sags, restrikes, swells, fifteen faults: the right controller passes, and every sentence holds."""
    outcome = outcome_of(right_trial(name, grid))
    assert (outcome.result.status, outcome.failed, outcome.broken) == (Status.PASS, set(), ())


@pytest.mark.slow
def test_sentences_see_what_is_wrong():
    """The sentences are no less strict than they claim: each of these slips breaks some, and is failed, too."""
    for slip in (
        Slip(What.CURRENT_TIMES, 0.0, first=2),
        Slip(What.CURRENT_TIMES, 1.3, first=2),
        Slip(What.Q_TIMES, 0.33, first=2),
        Slip(What.P_IS, 0.0, first=2),
        Slip(What.P_SWINGS, 0.2, 10.0, first=2),
        Slip(What.Q_PLUS, 0.2, when=When.AFTER),
        Slip(What.TRIP, when=When.AFTER, begin_s=0.1),
    ):
        outcome = outcome_of(Trial("spain-q-curve", TWO, slip, 0.0))
        assert outcome.broken, slip.in_words
        assert outcome.failed, slip.in_words


PYTHON = f"{Path(__file__).with_name('slipping.py')}:Slipping"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("what", "amount"),
    [("current", 0.0), ("reactive power", 0.3), ("reactive power", -1.0), ("active power", 0.0), ("swing", 0.3)],
)
def test_controllers_in_python(what, amount):
    """A controller in Python that is right in the first sag and wrong in the second is not let through."""
    simulator = ForeignSimulator(PYTHON, {"what": what, "amount": amount})
    outcome = outcome_of(Trial("spain-q-curve", TWO, Slip(), 0.0), simulator)
    assert outcome.broken
    assert outcome.result.status is Status.FAIL
    for check in outcome.result.checks:
        if check.status is Status.FAIL and check.stretch:
            assert "second sag" in check.stretch
