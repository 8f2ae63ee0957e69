"""The paper's three sags, judged for any controller; what is simulated; a folder that a run has been put in."""

from functools import partial

import pytest
import small_runs

from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.simulation import simulate as simulation
from pvlvrt_compliance.simulation.loop import run as right_run
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.study.run import run_test

SAGS = {
    "three-phase 90 %": Sag(depth=0.9),
    "phase c 90 %": Sag(depth=0.9, phases="c"),
    "phase c 50 %": Sag(depth=0.5, phases="c"),
}


@pytest.fixture
def runs(monkeypatch):
    """Scenarios that were simulated, in order."""
    seen, right = [], simulation.simulate

    def simulate(scenario, parameters):
        seen.append(scenario)
        return right(scenario, parameters)

    monkeypatch.setattr(simulation, "simulate", simulate)
    return seen


@pytest.fixture
def begun(tmp_path):
    """Output folder with a first run, an interrupted one, and foreign files."""
    small_runs.begin(tmp_path / "out")
    return tmp_path / "out"


@pytest.fixture(scope="session")
def profile():
    """The shipped profile with the envelope."""
    return load_profile("iec61400-21")


@pytest.fixture(scope="session")
def judge(profile):
    """Judge a sag of the paper: ``judge(name of the sag, run, assignments, **scenario fields) -> TestResult``."""

    def judge(sag, run=right_run, assignments=(), **fields):
        test = profile.ad_hoc_test(SAGS[sag], **fields)
        return run_test(profile, test, parameters_from(assignments), partial(simulation.simulate, run=run)).result

    return judge


def _long_sag(profile, assignments):
    test = profile.ad_hoc_test(SAGS["three-phase 90 %"], 0.5)
    return run_test(profile, test, parameters_from(assignments)).result


@pytest.fixture(scope="session")
def long_sag(profile):
    """A three-phase sag of 90 % that lasts 0.5 s."""
    return _long_sag(profile, [])


@pytest.fixture(scope="session")
def long_sag_early_trip(profile):
    """The same with an undervoltage relay that does not wait for the envelope."""
    return _long_sag(profile, ["protection.undervoltage_curve=[[0,0],[0.05,0],[0.4,0.85]]"])
