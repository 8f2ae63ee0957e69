"""One check alone, and judges that go wrong."""

import re
from pathlib import Path

import pytest

from pvlvrt_compliance.checks.alone import judge_alone
from pvlvrt_compliance.checks.judging import judge_safely
from pvlvrt_compliance.checks.registry import FunctionCheck
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import NotApplicable
from pvlvrt_compliance.results import Status

CONTRIBUTING = Path(__file__).parents[2] / "CONTRIBUTING.md"


@pytest.mark.parametrize("kind", ["ride_through", "current_limit", "reactive_support", "dc_ripple"])
def test_alone_as_in_a_run(bench, kind):
    """A check says the same alone as in a run of its profile."""
    made = bench(depth=0.5, q_sag_kvar=240, dc_ripple_percent=0.2)
    demand = getattr(made.profile.requirements, kind)
    assert judge_alone(kind, demand, made.waveforms(), made.test.scenario) == made.check(kind)


def test_unknown_kind_alone(bench, iec):
    """A kind that nothing judges is told to who writes the test."""
    made = bench()
    with pytest.raises(LookupError, match="unheard_of"):
        judge_alone("unheard_of", iec.requirements.dc_ripple, made.waveforms(), made.test.scenario)


@pytest.mark.parametrize(
    ("raised", "status", "message"),
    [
        (NotApplicable("let off"), Status.NOT_APPLICABLE, "let off"),
        (MeasurementError("no current"), Status.NOT_EVALUATED, "no current"),
        (KeyError("limit_pu"), Status.ERROR, "the check raised KeyError: 'limit_pu'"),
        (ZeroDivisionError("division by zero"), Status.ERROR, "the check raised ZeroDivisionError: division by zero"),
        (RecursionError(), Status.ERROR, "the check raised RecursionError"),
    ],
)
def test_whatever_a_judge_raises_is_a_verdict(bench, iec, raised, status, message):
    """A faulty check gives an error with its text; it never ends a run."""

    def check_faulty(_requirement, _evidence):
        raise raised

    made = bench()
    check = judge_alone(check_faulty, iec.requirements.dc_ripple, made.waveforms(), made.test.scenario)
    assert (check.check, check.status, check.message) == ("faulty", status, message)


def test_judge_that_returns_no_verdict(iec):
    """A judge that forgets to return its verdict is an error."""
    mine = FunctionCheck("mine", lambda _requirement, _evidence: None)
    check = judge_safely(mine, iec.requirements.dc_ripple, None)
    assert check.status is Status.ERROR
    assert "NoneType" in check.message


@pytest.mark.parametrize("exception", [KeyboardInterrupt, SystemExit])
def test_interruption_is_not_a_verdict(iec, exception):
    """Who interrupts a run ends it, also inside a check."""

    def interrupted(_requirement, _evidence):
        raise exception

    with pytest.raises(exception):
        judge_safely(FunctionCheck("mine", interrupted), iec.requirements.dc_ripple, None)


def test_example_in_contributing():
    """The example of a check alone runs as it stands."""
    examples = re.findall(r"```python\n(.*?)```", CONTRIBUTING.read_text(encoding="utf-8"), re.DOTALL)
    assert examples
    for example in examples:
        exec(compile(example, str(CONTRIBUTING), "exec"), {})
