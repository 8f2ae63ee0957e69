import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.checks.evaluate import evaluate
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.scenario.events import FrequencyRamp, Harmonic, Irradiance, VoltageProfile
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.timeline import busy_stretches
from pvlvrt_compliance.simulation.columns import CHANNELS
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.recorder import RecordingPlan, plan_of
from pvlvrt_compliance.simulation.simulate import available_power_w, record_of, simulate
from pvlvrt_compliance.simulation.thinning import AFTER_S, BEFORE_S, LEAST_RATE_HZ, MOST_ROWS
from pvlvrt_compliance.simulation.translate import nominal_of

T_REG = 40.9568e-6
PARAMETERS = Parameters()
TRIPS = Scenario(
    sag=Sag(depth=0),
    duration_s=7.0,
    events=(FrequencyRamp(t_s=0.0, rate_hz_s=-1.0, duration_s=6.5),),
)


LONG = {
    "three-phase": Scenario(sag=Sag(depth=0.1), duration_s=8.0),
    "one phase, half the power": Scenario(sag=Sag(depth=0.3, phases="c"), duration_s=8.0, irradiance_w_m2=500),
    "60 Hz, weak grid": Scenario(sag=Sag(depth=0.3), duration_s=8.0, frequency_hz=60.0, scr=10.0),
    "trip": TRIPS,
}

NOMINAL_OF_UNIT = {"kw": 500, "kvar": 500, "percent": 100, "v": 834, "hz": 50, "pu": 1, "s": 1}


def plan_for(scenario):
    """Plan of a scenario's record."""
    return plan_of(busy_stretches(scenario), int(scenario.end_s / T_REG) + 1, T_REG)


def recorded(plan):
    """Control periods that a plan records."""
    spans = zip(plan.first[:-1], plan.first[1:], plan.step, strict=True)
    return np.concatenate([np.arange(begin, end, step) for begin, end, step in spans])


@given(
    st.lists(st.floats(-10, 400), max_size=12),
    st.floats(0.5, 3600),
    st.sampled_from([T_REG, 5e-6, 100e-6, 1e-3]),
)
def test_any_plan(instants, length_s, T_reg):
    """One grid from the first period to the last, all periods around each instant and at the end, not too many rows."""
    periods = int(length_s / T_reg) + 1
    plan = plan_of([(t, t) for t in instants], periods, T_reg)
    N = int(plan.step.max())
    assert (plan.first[0], plan.first[-1], plan.step[-1]) == (0, periods, 1)
    assert (np.diff(plan.first) > 0).all()
    assert not (plan.first[:-1] % N).any()
    assert set(plan.step.tolist()) <= {1, N}
    rows, dense_s = sum(plan.rows), (len(instants) + 1) * (BEFORE_S + AFTER_S + 1.0)
    assert rows <= MOST_ROWS + 2 * N * len(plan.rows) + dense_s / T_reg or int(1 / (LEAST_RATE_HZ * T_reg)) <= N
    assert N == 1 or 1 / (N * T_reg) >= LEAST_RATE_HZ
    for begin, end, step in zip(plan.first[:-1], plan.first[1:], plan.step, strict=True):
        for t in [*instants, periods * T_reg]:
            assert step == 1 or (
                end * T_reg <= t - BEFORE_S + 1e-9 or begin * T_reg >= min(t + AFTER_S, length_s) - 1e-9
            )


@pytest.mark.parametrize("duration_s", [0.1, 3.5])
def test_short_records_hold_every_period(duration_s):
    """One segment, one row a control period."""
    plan = plan_for(Scenario(sag=Sag(depth=0.5), duration_s=duration_s))
    assert (plan.step.tolist(), len(plan.first)) == ([1], 2)


@pytest.mark.parametrize(("duration_s", "most_mb"), [(60, 50), (120, 85), (1800, 221), (3600, 375)])
def test_long_records_are_kept_small(duration_s, most_mb):
    """What a record takes is known from its rows: 8 bytes a channel."""
    plan = plan_for(Scenario(sag=Sag(depth=0.1), duration_s=duration_s))
    assert 8 * len(CHANNELS) * sum(plan.rows) < 1e6 * most_mb


def test_what_counts_as_happening():
    """Sag, points of profiles, both ends of ramps, harmonics that come and go."""
    events = (
        VoltageProfile(points=((10.0, 1.0), (20.0, 0.9))),
        FrequencyRamp(t_s=30.0, rate_hz_s=0.1, duration_s=5.0),
        Harmonic(order=5, amplitude_pu=0.01, t_s=40.0, duration_s=1.0),
        Harmonic(order=7, amplitude_pu=0.01),
        Irradiance(t_s=50.0, to_w_m2=500, ramp_s=2.0),
    )
    scenario = Scenario(sag=Sag(depth=0.1), duration_s=60.0, before_s=1.0, events=events)
    assert busy_stretches(scenario) == [(t + 1.0,) * 2 for t in (0, 10, 20, 30, 35, 40, 41, 50, 52, 60)]


@pytest.fixture(scope="module")
def both():
    """The same runs recorded thin and whole: ``both(scenario) -> thin, whole``."""
    kept = {}

    def make(scenario):
        if scenario not in kept:
            kept[scenario] = tuple(simulate(scenario, PARAMETERS, thin=thin) for thin in (True, False))
        return kept[scenario]

    return make


def test_a_thin_record_holds_samples_of_the_whole_one(both):
    """Bit by bit: what is recorded does not change what happens."""
    scenario = LONG["one phase, half the power"]
    thin, whole = both(scenario)
    periods = recorded(plan_for(scenario))
    assert (len(thin.segments), len(whole.segments)) == (3, 1)
    assert len(periods) < 0.5 * len(whole.segments[0])
    for name in CHANNELS:
        assert np.array_equal(np.concatenate([s[name] for s in thin]), whole.segments[0][name][periods]), name
    assert np.allclose(np.concatenate([s.t_s for s in thin]), T_REG * periods, rtol=0, atol=1e-9)


def test_a_trip_where_nothing_was_expected(both):
    """A relay that trips half-way along a ramp: every period around it is recorded, the instant is the whole run's."""
    thin, whole = both(TRIPS)
    opened_s = [next(s.t_s[s["connected"] < 0.5][0] for s in w if s["connected"][-1] < 0.5) for w in (thin, whole)]
    assert opened_s[0] == pytest.approx(opened_s[1], abs=1e-9)
    assert TRIPS.start_s + AFTER_S < opened_s[0] < TRIPS.clear_s - 0.5 - BEFORE_S
    around = thin.window(opened_s[0] - 0.3, opened_s[0] + 1.4)
    assert around.dt_s == pytest.approx(T_REG)
    at_s = [x.window(opened_s[0] - 0.3, opened_s[0] + 0.5)["i_a_a"] for x in (thin, whole)]
    assert np.array_equal(*at_s)


def same(a, b, within):
    """Whether two numbers are the same within so much, or both missing."""
    return (a is None and b is None) or a == pytest.approx(b, rel=0, abs=within)


@pytest.mark.parametrize("name", LONG)
@pytest.mark.parametrize("profile_name", ["iec61400-21", "spain-q-curve"])
def test_verdicts_do_not_depend_on_the_recording(both, name, profile_name):
    """Every check gives the same verdict with the same margin on a thin record and on the whole one.

    Margins and measurements are the same to 1e-5 of nominal; a mean over a window in which the inverter trips also
    depends on where, between two samples of the thin grid, its power ends: by half a step of the window's length.
    """
    profile, scenario = load_profile(profile_name), LONG[name]
    test = profile.ad_hoc_test(scenario.sag, scenario.duration_s).model_copy(update={"scenario": scenario})
    power_w, nominal = available_power_w(scenario, PARAMETERS), nominal_of(PARAMETERS, scenario)
    thin, whole = (evaluate(profile, test, record, nominal, power_w) for record in both(scenario))
    for a, b in zip(thin.checks, whole.checks, strict=True):
        assert (a.check, a.status) == (b.check, b.status)
        assert same(a.margin, b.margin, 1e-5 * NOMINAL_OF_UNIT.get(a.unit, 100)), a
    within = 1e-5 + (0.5 * 8 * T_REG / 6.88 if name == "trip" else 0.0)
    for window in ("before", "during", "after"):
        a, b = (getattr(result.measurements, window).model_dump() for result in (thin, whole))
        for quantity in a:
            assert same(a[quantity], b[quantity], within * NOMINAL_OF_UNIT[quantity.split("_")[-1]]), (window, quantity)


@pytest.mark.parametrize("rows", [1, 512, 1300])
def test_rows_become_columns(rows):
    """Each channel is a column of the rows, in one piece of memory."""
    samples = np.arange(rows * len(CHANNELS), dtype=np.float64).reshape(rows, len(CHANNELS))
    (segment,) = record_of(samples, RecordingPlan(np.array([0, rows]), np.array([1])), 1e-4).segments
    for number, name in enumerate(CHANNELS):
        assert segment[name].tolist() == samples[:, number].tolist()
        assert segment[name].flags.c_contiguous


def test_columns_that_are_there_stay_where_they_are():
    """A record whose channels were written in one piece each is not written a second time."""
    samples = np.arange(5.0 * len(CHANNELS)).reshape(len(CHANNELS), 5).T
    first, second = record_of(
        samples, RecordingPlan(np.array([-2, 0, 3]), np.array([1, 1])), 1e-4
    ).with_settling.segments
    for number, name in enumerate(CHANNELS):
        assert [*first[name], *second[name]] == samples[:, number].tolist()
        assert np.shares_memory(first[name], samples)
        assert second[name].flags.c_contiguous
