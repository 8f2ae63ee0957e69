"""Tests of scenarios that are given as tables."""

from pvlvrt_compliance.disturbance.asked import disturbance_asked
from pvlvrt_compliance.disturbance.model import NormalVoltage
from pvlvrt_compliance.results import Status, TestResult
from pvlvrt_compliance.scenario.scenario import Scenario

NORMAL = NormalVoltage(low_pu=0.9, high_pu=1.1, negative_pu=0.1)


def result(scenario=None, **fields):
    """A test of a scenario, given as a table."""
    table = {"sag": {"depth": 0}, "duration_s": 0.5} | (scenario or {})
    made = Scenario.model_validate(table)
    grid = {} if "disturbance" in fields else {"disturbance": disturbance_asked(made, NORMAL)}
    return TestResult(id="t", status=Status.PASS, scenario=made.model_dump(mode="json"), **grid, **fields)
