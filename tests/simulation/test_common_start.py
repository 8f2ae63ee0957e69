"""Runs that go on from the settled state of another give its record to the bit, or are told apart beforehand."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.scenario.events import FrequencyStep, Harmonic, Irradiance, PhaseJump
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation import settled_run
from pvlvrt_compliance.simulation.common_start import CommonStarts, parted
from pvlvrt_compliance.simulation.parameters import Parameters, parameters_from
from pvlvrt_compliance.simulation.recorder import RecordingPlan
from pvlvrt_compliance.simulation.settled_run import LoopState, settling_periods, start_of
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.simulation.translate import control_period_s
from same_records import are_the_same

DEFAULTS = Parameters()
SHORT = {"duration_s": 0.15, "after_s": 0.1, "before_s": 0.25}
FIRST, OTHER = Scenario(sag=Sag(depth=0.9), **SHORT), Scenario(sag=Sag(depth=0.4, phases="c"), **SHORT)
STEP = FrequencyStep(kind="frequency_step", t_s=0.05, to_hz=50.4)


def once(*scenarios, parameters=DEFAULTS):
    """Records of scenarios, as far as they start alike from one state."""
    starts = CommonStarts(start_of(scenario, parameters).key for scenario in scenarios)
    return [simulate(scenario, parameters, starts=starts) for scenario in scenarios]


HARDWARE = (
    "sensors.adc_bits=10",
    "sensors.voltage_noise_v=2.0",
    "sensors.current_noise_a=1.5",
    "sensors.measurement_delay_samples=2",
    "controller.computation_delay_samples=3",
)


@pytest.mark.parametrize(
    "settings",
    [
        (),
        ("simulation.record_settling=true",),
        ("simulation.settling_s=0",),
        ("controller.synchronisation=dsc-pll",),
        ("controller.synchronisation=ddsrf-pll", "controller.precision=single"),
        ("controller.synchronisation=dsc-pll", "controller.precision=single"),
        ("simulation.fidelity=switched",),
        HARDWARE,
    ],
    ids=" ".join,
)
def test_the_record_is_that_of_one_run(settings):
    """However the state is made up, every channel has the bits that it has when the test settles for itself."""
    parameters = parameters_from(settings)
    for scenario, record in zip((FIRST, OTHER), once(FIRST, OTHER, parameters=parameters), strict=True):
        assert are_the_same(record, simulate(scenario, parameters))


def test_a_long_record_is_thinned_as_it_is_in_one_run():
    """Where a record keeps fewer periods before it parts, the same rows are taken of those that all have kept."""
    long = [s.model_copy(update={"before_s": 3.0, "after_s": 2.5}) for s in (FIRST, OTHER)]
    made = once(*long)
    assert len(made[0].segments) > 1
    assert all(are_the_same(record, simulate(s, Parameters())) for s, record in zip(long, made, strict=True))


def test_only_what_comes_after_is_simulated_again(monkeypatch):
    """The loop runs the settling and the record up to the sag once, the rest for each."""
    begun, right = [], settled_run.through

    def through(first, plan, loop, *others):
        def counted(x, plan):
            begun.append((x.period, int(plan.first[-1])))
            return loop(x, plan)

        return right(first, plan, counted, *others)

    monkeypatch.setattr("pvlvrt_compliance.simulation.simulate.through", through)
    once(FIRST, OTHER)
    part, T_reg = start_of(FIRST, Parameters()).period, control_period_s(Parameters())
    end = int(FIRST.end_s / T_reg) + 1
    assert begun == [(-settling_periods(Parameters()), part), (part, end), (part, end)]
    assert 0 <= FIRST.start_s - part * T_reg < 2 * T_reg + 1e-9


@pytest.mark.parametrize("left_out", LoopState._fields)
def test_a_state_that_is_left_out_shows(monkeypatch, left_out):
    """A state of which any part is still that of the beginning gives another record: nothing of it is there in vain."""
    settings = () if left_out == "m" else HARDWARE  # in which what was given is under way, besides
    parameters = parameters_from((*settings, "controller.synchronisation=dsc-pll"))
    right = settled_run._settled

    def wrong(first, start, loop):
        found = right(first, start, loop)
        beginning = settled_run.copied(first)
        return found._replace(state=found.state._replace(**{left_out: getattr(beginning, left_out)}))

    monkeypatch.setattr(settled_run, "_settled", wrong)
    record, _ = once(FIRST, OTHER, parameters=parameters)
    assert not are_the_same(record, simulate(FIRST, parameters))


@pytest.mark.parametrize(
    "other",
    [
        {"frequency_hz": 50.2},
        {"irradiance_w_m2": 700.0},
        {"cell_temperature_c": 40.0},
        {"scr": 5.0},
        {"reactive_power_pu": 0.2},
        {"point_on_wave_deg": 90.0},
        {"before_s": 0.26},
        {"events": (Harmonic(kind="harmonic", order=5, amplitude_pu=0.02),)},
        {"events": (PhaseJump(kind="phase_jump", t_s=-0.1, angle_deg=20.0),)},
        {"events": (Irradiance(kind="irradiance", t_s=0.1, to_w_m2=500.0, ramp_s=0.1),)},
    ],
    ids=str,
)
def test_what_differs_before_is_told_apart(other):
    """A run that starts otherwise, parts earlier, or is told of another array has a key of its own."""
    assert start_of(FIRST.model_copy(update=other), Parameters()).key != start_of(FIRST, Parameters()).key
    changed = [FIRST.model_copy(update=other), OTHER.model_copy(update=other)]
    records = once(FIRST, *changed)
    assert all(are_the_same(r, simulate(s, Parameters())) for s, r in zip((FIRST, *changed), records, strict=True))


def test_what_differs_later_starts_alike():
    """Sags, their length, what the transformer makes of them, and events from the sag on are no part of the key."""
    later = {"sag": Sag(depth=0.2), "duration_s": 0.3, "after_s": 0.5, "vector_group": "Dyn11", "events": (STEP,)}
    assert start_of(FIRST.model_copy(update=later), Parameters()) == start_of(FIRST, Parameters())


def test_no_parameter_is_left_out_of_the_key():
    """Another parameter is another start."""
    assert start_of(FIRST, parameters_from(["plant.dc_link_capacitance_f=0.05"])) != start_of(FIRST, Parameters())


def test_a_run_that_does_not_come_so_far_says_why_itself():
    """Relays that trip in the settling: nothing is gone on from, and the record is that of one run."""
    parameters = parameters_from(["protection.overcurrent_pu=0.5"])
    record, _ = once(FIRST, OTHER, parameters=parameters)
    assert record.tripped_at_s is not None
    assert are_the_same(record, simulate(FIRST, parameters))


def test_what_one_run_alone_starts_from_is_not_kept():
    """A state is made for the first of several, and let go of after the last."""
    made = []
    start = start_of(FIRST, Parameters())
    starts = CommonStarts([start.key, start.key, "other"])

    def make(start):
        made.append(start)
        return "state"

    lone = start._replace(key="other")
    assert starts.of(lone, make) is None
    assert [starts.of(start, make) for _ in range(2)] == ["state"] * 2
    assert starts.of(start, make) is None  # of a further run that nobody knew of
    assert made == [start]


@given(
    begins=st.lists(st.integers(0, 400), min_size=2, max_size=6, unique=True).map(sorted),
    steps=st.lists(st.integers(1, 60), min_size=6, max_size=6),
    period=st.integers(0, 400),
)
def test_no_row_of_a_plan_is_lost(begins, steps, period):
    """The rows before, and those of the rest, are those of the plan in their order, each on its side."""
    plan = RecordingPlan(np.array(begins), np.array(steps[: len(begins) - 1]))
    period = min(period, begins[-1] - 1)
    here = parted(plan, period)
    before, rest = [n for rows in here.before for n in rows], rows_of(here.rest)
    assert before + rest == rows_of(plan)
    assert all(n < period for n in before)
    assert all(n >= period for n in rest)
    assert here.rows == len(before)
    assert sum(here.rest.rows) == len(rest)
    kept = np.arange(begins[-1] + 5, dtype=np.float64)[:, None] - 5
    taken = np.empty((len(before) + 2, 1))
    here.put(kept, -5, taken)
    assert taken[: len(before), 0].tolist() == before


def rows_of(plan):
    """Periods of all rows."""
    return [
        n for (a, b), N in zip(pairwise(plan.first.tolist()), plan.step.tolist(), strict=True) for n in range(a, b, N)
    ]
