"""Which records are stored, and what a controller has said with them."""

from pathlib import Path

import pytest
from reused import DEFAULTS, SCENARIO

from pvlvrt_compliance.controllers.run import IGNORED_WORDS
from pvlvrt_compliance.errors import SimulationError
from pvlvrt_compliance.study.reuse.simulator import ReusingSimulator


def test_what_fails_is_not_stored(store):
    """It is simulated, and fails, each time."""
    calls = []

    def simulate(*of):
        calls.append(of)
        raise SimulationError("a number stopped being finite")

    for _ in range(2):
        with pytest.raises(SimulationError):
            ReusingSimulator(simulate, None, store)(SCENARIO, DEFAULTS)
    assert (len(calls), store.folder.exists()) == (2, False)


def test_what_time_may_have_decided_is_not_stored(simulated, own):
    """After a trip a controller may be left alone because it did not come back."""
    own.said = (f"{IGNORED_WORDS}: no answer within 60 s",)
    assert (simulated(controller=own), simulated(controller=own)) == (1, 1)


def test_what_a_controller_said_comes_with_its_record(simulated, own):
    """Its notes are those of the run that is not made again."""
    own.said = ("the gain was limited",)
    assert simulated(controller=own) == 1
    own.said = ()
    assert simulated(controller=own) == 0
    assert own.heard == ("the gain was limited",)


def test_a_record_is_not_stored_where_something_changed_meanwhile(simulated, own, tmp_path):
    """It is of neither the old files nor the new ones."""
    change = iter("23")
    during = lambda: (tmp_path / "gains.csv").write_text(next(change))  # noqa: E731
    assert simulated(controller=own, during=during) == 1
    assert simulated(controller=own) == 1
    (tmp_path / "gains.csv").write_text("1")
    assert simulated(controller=own) == 1


def test_a_mapping_that_breaks_meanwhile_ends_no_run(simulated, own):
    """The record is given, and not stored; whoever opens the controller next is told."""
    broken = lambda: Path(own.mapping()).write_text("files = 1")  # noqa: E731
    assert simulated(controller=own, during=broken) == 1
    Path(own.mapping()).write_text('files = ["gains.csv", "lib/*.py"]\n')
    assert simulated(controller=own) == 1
