"""The loop with a controller from outside, against the bundled one and against what must hold whatever controls."""

import numpy as np
import pytest

from pvlvrt_compliance.scenario.events import FrequencyRamp, Irradiance
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.columns import CHANNELS, PLANT_CHANNELS
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.simulate import available_power_w, simulate
from pvlvrt_compliance.waveforms.trip_causes import in_words

SAME_START = ("simulation.settling_s=0.5", "simulation.synchronising_s=0")
BOTH_KNOW = (*PLANT_CHANNELS, "m_alpha", "m_beta", "v_fault_pu", "q_ref_var", "p_ref_w")


def furthest(mine, theirs, names):
    """Largest difference of two records of one segment, by the largest value of each channel."""
    assert len(mine.segments) == len(theirs.segments) == 1
    pairs = [(mine.segments[0][name], theirs.segments[0][name]) for name in names]
    return max(np.abs(a - b).max() / max(np.abs(b).max(), 1e-3) for a, b in pairs)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("sag", "settings"),
    [
        (Sag(depth=0.9), ()),
        (Sag(depth=0.6, phases="bc", two_phase=True), ()),
        (Sag(depth=0.9, phases="c"), ("controller.computation_delay_samples=2",)),
        (Sag(depth=0.5), ("sensors.adc_bits=12", "sensors.current_offset_a=[3,-2,0]", "sensors.voltage_noise_v=0.5")),
    ],
    ids=["balanced", "two-phase", "late", "sensors"],
)
def test_bundled_controller_through_the_python_door(opened, sag, settings):
    """The bundled controller gives the same waveforms from outside as from inside."""
    scenario = Scenario(sag=sag, duration_s=0.309)
    parameters = parameters_from((*SAME_START, *settings))
    mine = opened("bundled.py:Bundled")(scenario, parameters)
    assert furthest(mine, simulate(scenario, parameters), BOTH_KNOW) < 1e-9


@pytest.mark.slow
def test_bundled_controller_on_the_switched_inverter(opened):
    """The same with every leg as it switches."""
    scenario = Scenario(sag=Sag(depth=0.9), duration_s=0.1, after_s=0.1)
    parameters = parameters_from((*SAME_START, "simulation.fidelity=switched"))
    mine = opened("bundled.py:Bundled")(scenario, parameters)
    assert furthest(mine, simulate(scenario, parameters), BOTH_KNOW) < 1e-9


def test_channels_of_a_record(opened):
    """The plant's channels come first, as ever; those that only the bundled controller has are not there."""
    names = record(opened).names
    assert names[: len(PLANT_CHANNELS)] == CHANNELS[: len(PLANT_CHANNELS)]
    assert set(names) & {"fault_signal", "v_dc_ref_v"} == set()


def record(opened, *settings, **given):
    """Record without a sag."""
    scenario = Scenario(sag=Sag(depth=0.0), duration_s=0.1, after_s=0.1)
    return opened("misbehaving.py:Controller", **given)(scenario, parameters_from(settings))


def test_controller_starts_at_rest_long_before_the_record(opened):
    """It sees the steady state for 0.2 s, acts for another second, and then the record begins."""
    (segment,) = record(opened)
    assert segment["time_s"][0] == pytest.approx(1.2)
    assert segment["enabled"].min() == 1.0


def test_controller_is_called_by_a_counter(opened):
    """Its sample time is 200 us; the record has five rows a sample time, and a sample is that of its own instant."""
    (segment,) = record(opened)
    assert segment.dt_s == pytest.approx(40e-6)
    times = np.unique(segment["time_s"])
    assert np.allclose(np.diff(times), 200e-6, rtol=1e-9)
    assert np.array_equal(segment["u_sampled_v"][::5], segment["u_a_v"][::5])
    assert np.array_equal(segment["u_sampled_v"][4::5], segment["u_a_v"][:-4:5][: len(segment["u_sampled_v"][4::5])])


def test_command_acts_one_sample_time_later(opened):
    """From a sample to its effect one sample time passes, or as many as are set: the power follows that much later."""
    now, later = (record(opened, f"controller.computation_delay_samples={n}") for n in (0, 2))
    lag = [np.angle(np.fft.rfft(x.segments[0]["i_a_a"][:5000])[10]) for x in (now, later)]
    assert lag[0] != pytest.approx(lag[1], abs=1e-3)


def test_current_into_the_bridge_balances_the_link(opened):
    """In steady state the bridge takes on average what the array gives, sampled often enough to see the average."""
    (segment,) = record(opened, sample_time_s=1e-5)
    cycle = slice(0, 500)
    assert segment["v_dc_v"][500] == pytest.approx(segment["v_dc_v"][0], abs=1e-3)
    assert segment["i_dc_a"][cycle].mean() == pytest.approx(segment["i_pv_a"][cycle].mean(), rel=2e-2)


@pytest.mark.parametrize(("sample_time_s", "dt_s"), [(1e-5, 40e-6), (4e-4, 40e-6), (5e-4, 35.7e-6)])
def test_record_is_fine_whatever_the_sample_time(opened, sample_time_s, dt_s):
    """A row about every 41 us, on one grid."""
    (segment,) = record(opened, sample_time_s=sample_time_s)
    assert segment.dt_s == pytest.approx(dt_s, rel=5e-3) or segment.dt_s <= 41e-6


def test_long_record_is_thin_where_nothing_happens(opened):
    """A record of more than 5 s holds every row only around what happens, on one grid."""
    scenario = Scenario(sag=Sag(depth=0.0), duration_s=0.1, before_s=4.0, after_s=4.0)
    waveforms = opened("misbehaving.py:Controller")(scenario, parameters_from(()))
    steps = {round(segment.dt_s / waveforms.segments[-1].dt_s) for segment in waveforms}
    assert len(waveforms.segments) > 1
    assert len(steps) == 2


FALLING = (FrequencyRamp(t_s=0.0, rate_hz_s=-1.0, duration_s=1.0),)


@pytest.mark.parametrize(
    ("settings", "fields", "cause"),
    [
        (("protection.overcurrent_pu=0.9",), {"sag": Sag(depth=0.9)}, "over-current relay of the plant"),
        (("protection.dc_overvoltage_v=980",), {"sag": Sag(depth=0.9)}, "DC over-voltage relay of the plant"),
        ((), {"sag": Sag(depth=0.97), "duration_s": 0.6}, "under-voltage relay of the plant"),
        (
            ("protection.frequency_min_hz=49.5",),
            {"sag": Sag(depth=0.0), "duration_s": 1.0, "events": FALLING},
            "frequency relay of the plant",
        ),
    ],
)
def test_each_relay_is_named_with_a_controller_from_outside(opened, settings, fields, cause):
    """The record holds the code of the relay that tripped, whoever controls, and the instant of it beside."""
    scenario = Scenario.model_validate({"duration_s": 0.1, "after_s": 0.1, **fields})
    record = opened("misbehaving.py:Controller")(scenario, parameters_from(settings))
    codes = np.concatenate([segment["trip_cause"] for segment in record])
    assert codes[0] == 0
    assert in_words(int(codes.max())) == cause
    first_s = np.concatenate([segment.t_s for segment in record])[codes.argmax()]
    assert record.tripped_at_s == pytest.approx(first_s, abs=2 * record.segments[0].dt_s)


def test_settling_can_be_recorded(opened):
    """It stands before the record, on its grid, up to the controller's first command; the record stays the same."""
    scenario = Scenario(sag=Sag(depth=0.5), duration_s=0.1, after_s=0.1)
    simulator = opened("misbehaving.py:Controller")
    usual, longer = (
        simulator(scenario, parameters_from(("simulation.settling_s=0.3", *more)))
        for more in ((), ("simulation.record_settling=true",))
    )
    (before,) = longer.settling
    assert usual.settling == ()
    assert before.t0_s == pytest.approx(-0.3, abs=2e-4)
    assert before.end_s + before.dt_s == pytest.approx(0.0, abs=1e-9)
    assert furthest(longer, usual, usual.names) == 0
    assert before["enabled"][0] == 1.0


@pytest.mark.parametrize(
    ("irradiance_w_m2", "events", "expected_kw"),
    [
        (1000.0, (), {500.0}),
        (800.0, (), {411.0}),
        (200.0, (Irradiance(t_s=0.0, to_w_m2=800.0, ramp_s=0.05),), {105.0, 411.0}),
    ],
)
def test_active_power_that_is_asked_for_is_what_there_is(opened, irradiance_w_m2, events, expected_kw):
    """All that the array can give (105 kW at 200 W/m2, 411 kW at 800), and at most the nominal power."""
    scenario = Scenario(sag=Sag(depth=0.0), duration_s=0.1, after_s=0.1, irradiance_w_m2=irradiance_w_m2, events=events)
    (segment,) = opened("informed.py:Informed")(scenario, parameters_from(()))
    asked, available = segment["p_set_w"] / 1e3, segment["p_available_w"] / 1e3
    for power in (asked[0], asked[-1]):
        assert min(abs(power - expected) / expected for expected in expected_kw) < 0.03
    assert np.all(asked == np.minimum(available, 500.0))
    steady = segment.t_s < scenario.start_s
    most = available_power_w(scenario, parameters_from(())) / 1e3
    assert available[steady] == pytest.approx(most, rel=1e-6)
    last = available_power_w(scenario.model_copy(update={"irradiance_w_m2": 800.0}), parameters_from(())) / 1e3
    assert not events or available[-1] == pytest.approx(last, rel=1e-6)


def test_plant_data_that_a_controller_is_told(opened):
    """Filter, link and nominal DC voltage (Table 1), as they are set."""
    scenario = Scenario(sag=Sag(depth=0.0), duration_s=0.1, after_s=0.1)
    settings = ("plant.filter_inductance_h=0.0002", "plant.dc_link_capacitance_f=0.05")
    (segment,) = opened("informed.py:Informed")(scenario, parameters_from(settings))
    assert segment["l_h"][0] == 0.0002
    assert segment["r_ohm"][0] == 0.001
    assert segment["c_f"][0] == 0.05
    assert segment["v_nominal_v"][0] == pytest.approx(807.4, rel=1e-3)
