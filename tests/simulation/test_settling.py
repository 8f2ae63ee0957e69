"""What is before a record can be kept, and changes nothing of what is judged."""

import numpy as np
import pytest

from pvlvrt_compliance.checks.evaluate import evaluate
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.recorder import every_period, with_settling
from pvlvrt_compliance.simulation.simulate import available_power_w, simulate
from pvlvrt_compliance.simulation.translate import nominal_of
from pvlvrt_compliance.waveforms.csv import write_csv
from pvlvrt_compliance.waveforms.recording import read_waveforms

USUAL = parameters_from(("simulation.settling_s=0.2",))
KEPT = parameters_from(("simulation.settling_s=0.2", "simulation.record_settling=true"))
SCENARIO = Scenario(sag=Sag(depth=0.7, phases="bc"), duration_s=0.2)


@pytest.mark.parametrize(
    "scenario",
    [SCENARIO, SCENARIO.model_copy(update={"duration_s": 6.0}), SCENARIO.model_copy(update={"frequency_hz": 60.0})],
    ids=["short", "thinned out, trips", "60 Hz"],
)
def test_record_is_the_same_to_the_bit(scenario):
    """Every sample and every segment of the record, and the instant of a trip."""
    usual, kept = simulate(scenario, USUAL), simulate(scenario, KEPT)
    assert usual.settling == ()
    assert usual.tripped_at_s == kept.tripped_at_s
    for mine, theirs in zip(kept, usual, strict=True):
        assert (mine.t0_s, mine.dt_s) == (theirs.t0_s, theirs.dt_s)
        assert all(np.array_equal(mine[name], theirs[name]) for name in usual.names)


@pytest.mark.parametrize("name", ["iec61400-21", "es-nts-631-lt110kv", "ieee1547-cat-ii"])
def test_verdicts_are_the_same(name):
    """Whatever a profile demands: the result with the settling in the record is the one without, in every number."""
    profile, test = load_profile(name), TestCase(id="own", title="own", scenario=SCENARIO)
    nominal, available_w = nominal_of(USUAL, SCENARIO), available_power_w(SCENARIO, USUAL)
    results = [
        evaluate(profile, test, simulate(SCENARIO, parameters), nominal, available_w) for parameters in (USUAL, KEPT)
    ]
    assert results[0] == results[1]


def test_settling_goes_on_into_the_record():
    """The last sample of it is one step before the first of the record, and the waves do not jump."""
    kept = simulate(SCENARIO, KEPT)
    (before,), record = kept.settling, kept.segments[0]
    assert before.t0_s == pytest.approx(-0.2, abs=before.dt_s)
    assert before.end_s + before.dt_s == pytest.approx(record.t0_s, abs=1e-9)
    step_v = record["u_a_v"][0] - before["u_a_v"][-1]
    assert abs(step_v) < 2 * np.abs(np.diff(record["u_a_v"][:1000])).max()


def test_files_begin_with_the_settling(tmp_path):
    """A file of the whole has times below 0, and from 0 on the lines of a file without."""
    usual, kept = simulate(SCENARIO, USUAL), simulate(SCENARIO, KEPT)
    for name, record in (("usual.csv", usual), ("kept.csv", kept.with_settling)):
        write_csv(record, tmp_path / name)
    mine, theirs = ((tmp_path / name).read_text().splitlines() for name in ("kept.csv", "usual.csv"))
    assert mine[0] == theirs[0]
    assert mine[-len(theirs) + 1 :] == theirs[1:]
    assert float(mine[1].split(",")[0]) == pytest.approx(-0.2, abs=1e-4)
    assert read_waveforms(tmp_path / "kept.csv", ["u_a_v"]).t0_s < 0


def test_trip_while_settling_is_seen_in_it():
    """A relay that trips while nothing is judged yet: the settling shows the current before it."""
    settings = ("simulation.record_settling=true", "protection.frequency_min_hz=51")  # which takes 0.2 s to tell
    kept = simulate(SCENARIO, parameters_from(settings))
    codes = kept.settling[0]["trip_cause"]
    assert codes[0] == 0
    assert codes[-1] == kept.segments[0]["trip_cause"][0] > 0
    assert kept.settling[0].t_s[codes.argmax()] == pytest.approx(kept.tripped_at_s, abs=2 * kept.settling[0].dt_s)


@pytest.mark.parametrize(("periods", "step", "rows"), [(0, None, 0), (1000, 1, 1000), (1_000_000, 8, 125_000)])
def test_plan_of_a_settling(periods, step, rows):
    """It ends where the record begins; a long one is thin, one of no period leaves the plan as it is."""
    plan = with_settling(every_period(10), periods, 40.9568e-6)
    assert plan.rows[-1] == 10
    if step is None:
        assert len(plan.rows) == 1
    else:
        assert (int(plan.step[0]), plan.rows[0], int(plan.first[1])) == (step, rows, 0)
