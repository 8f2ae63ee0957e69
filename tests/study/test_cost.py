"""What a run would cost is known before it starts, and more than one may take is refused then."""

import math
from types import SimpleNamespace

import pytest

from pvlvrt_compliance.errors import SimulationError, UsageError
from pvlvrt_compliance.scenario.events import Harmonic, PhaseJump
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation import simulate as simulating
from pvlvrt_compliance.simulation.columns import CHANNELS
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.thinning import COLUMNS, MOST_BYTES, too_much
from pvlvrt_compliance.study.cost import MOST_STEPS, refuse_costly, rows_of
from pvlvrt_compliance.study.job import Asked, make_job

SCENARIOS = {
    "short": Scenario(sag=Sag(depth=0.5), duration_s=0.25),
    "thin": Scenario(sag=Sag(depth=0.5), duration_s=7.0, events=(PhaseJump(t_s=4.0, angle_deg=5),)),
}
SETTINGS = {"usual": (), "settled": ("simulation.record_settling=true",), "fine": ("simulation.control_ratio=4",)}


def test_columns_are_those_of_a_record():
    """Their number is known without a compiler."""
    assert len(CHANNELS) == COLUMNS


@pytest.mark.parametrize("scenario", SCENARIOS)
@pytest.mark.parametrize("settings", SETTINGS)
def test_the_rows_are_those_of_the_record(scenario, settings):
    """What is said beforehand is what is there afterwards, to the row."""
    parameters = parameters_from(SETTINGS[settings])
    record = simulating.simulate(SCENARIOS[scenario], parameters)
    found = sum(len(segment) for segment in (*record.settling, *record.segments))
    assert rows_of(SCENARIOS[scenario], parameters) == found


def refusal(events=0, **asked):
    """What a job of one sag with so many events, one a second, is refused for; empty where it is not."""
    jumps = tuple(PhaseJump(t_s=float(k), angle_deg=1) for k in range(events))
    try:
        make_job(Asked(**{"profiles": ("iec61400-21",), "sag": 0.5, "events": jumps} | asked))
    except UsageError as error:
        return str(error)
    return ""


def test_samples_are_bounded():
    """As often as something happens every sample is kept: an hour of that is told in GiB, and no simulation begins."""
    most_rows = MOST_BYTES // (8 * COLUMNS)
    seconds = math.floor(most_rows * 40.9568e-6) - 10
    assert refusal(events=seconds, duration=float(seconds)) == ""
    said = refusal(events=seconds + 20, duration=float(seconds + 20))
    assert said.startswith("iec61400-21.sag-50pct-abc: 2.0")
    assert "GiB of samples; 2 GiB are allowed; this follows from simulation.plant_step_us" in said
    assert "15.7 GiB of samples" in refusal(events=3599, duration=3600.0)


@pytest.mark.parametrize(("factor", "refused"), [(1.001, False), (0.999, True)])
@pytest.mark.parametrize("harmonics", [0, 16])
def test_steps_are_bounded(factor, refused, harmonics):
    """The longest test with the shortest step would take days; what comes before the record counts, too."""
    events = tuple(Harmonic(order=5, amplitude_pu=0.01) for _ in range(harmonics))
    scenario = Scenario(sag=Sag(depth=0.5), duration_s=3600.0, events=events)
    step_us = factor * 1e6 * (1 + harmonics / 8) * (scenario.end_s + 0.5 + 0.2) / MOST_STEPS
    parameters = parameters_from([f"simulation.plant_step_us={step_us}", "simulation.control_ratio=100"])
    tests = [SimpleNamespace(key="code.test", test=SimpleNamespace(scenario=scenario))]
    if not refused:
        refuse_costly(tests, parameters)
        return
    with pytest.raises(UsageError, match=r"^code\.test: 1e\+10 plant steps, .*; 1e\+10 are allowed; this follows from"):
        refuse_costly(tests, parameters)


@pytest.mark.parametrize(("more", "refused"), [(0, False), (1, True)])
def test_the_last_row_that_is_allowed(more, refused):
    """Just inside and just outside."""
    assert (too_much(MOST_BYTES // (8 * COLUMNS) + more) is not None) == refused


def test_a_record_that_turns_out_too_large_is_an_error(monkeypatch):
    """What is not known before a run, as what a recording holds, is seen before the memory is taken."""
    monkeypatch.setattr(simulating, "too_much", lambda rows: f"{rows} rows")
    with pytest.raises(SimulationError, match=r"^\d+ rows$"):
        simulating.simulate(SCENARIOS["short"], parameters_from(()))


def test_a_start_that_no_array_has_is_an_error():
    """A DC link far beyond the open circuit of the array has no current in finite numbers."""
    parameters = parameters_from(["controller.mppt_voltage_min_v=99999", "controller.mppt_voltage_max_v=100000"])
    with pytest.raises(SimulationError, match="no steady state in finite numbers"):
        simulating.simulate(SCENARIOS["short"], parameters)
