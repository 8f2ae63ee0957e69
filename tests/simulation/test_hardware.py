"""What hardware-in-the-loop shows and plain simulation hides: sensors, converters and delays."""

import numpy as np
import pytest

from pvlvrt_compliance.hardware.sensors import CHANNELS
from pvlvrt_compliance.measure.fourier import component, mean
from pvlvrt_compliance.measure.power import instantaneous_power
from pvlvrt_compliance.measure.sequences import sequence_phasors
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.electronics import sensor_params
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.study.run import run_test

NOMINAL_A = 1024.8
REALISTIC = (
    *("sensors.adc_bits=12", "sensors.voltage_gain=[1.004,0.997,1.0]", "sensors.current_gain=[0.996,1.003,1.0]"),
    *("sensors.current_offset_a=[3,-2,0]", "sensors.current_noise_a=2", "sensors.voltage_noise_v=0.5"),
    *("sensors.dc_voltage_noise_v=0.5", "controller.precision=single"),
)


def run(*settings, depth=0.0, **fields):
    """Waveforms with these settings; the sag, if any, starts at 0.3 s."""
    scenario = Scenario(sag=Sag(depth=depth), duration_s=0.309, **fields)
    return simulate(scenario, parameters_from(settings)).segments[0]


def before(segment):
    """Five cycles before the sag."""
    return segment.slice(0.18, 0.28)


def test_every_setting_reaches_its_channel():
    """Gains, offsets, noise and ranges are those of the channel that they name."""
    of_phases, alone = "[2,3,4]", ("5", "6")
    settings = [
        *(f"sensors.{name}={of_phases}" for name in ("voltage_gain", "voltage_offset_v")),
        *(f"sensors.{name}=[7,8,9]" for name in ("current_gain", "current_offset_a")),
        *(f"sensors.{name}={x}" for name, x in zip(("dc_voltage_gain", "pv_current_gain"), alone, strict=True)),
        *(f"sensors.{name}={x}" for name, x in zip(("dc_voltage_offset_v", "pv_current_offset_a"), alone, strict=True)),
        *("sensors.voltage_noise_v=1", "sensors.current_noise_a=2", "sensors.dc_voltage_noise_v=3"),
        *("sensors.pv_current_noise_a=4", "sensors.adc_bits=1", "sensors.voltage_range_v=11"),
        *("sensors.current_range_a=12", "sensors.dc_voltage_range_v=13", "sensors.pv_current_range_a=14"),
    ]
    p = sensor_params(parameters_from(settings).sensors)
    each = {"u_a": 2, "u_b": 3, "u_c": 4, "i_a": 7, "i_b": 8, "i_c": 9, "v_dc": 5, "i_pv": 6}
    noise, ends = {"u": 1, "i": 2, "v_dc": 3, "i_pv": 4}, {"u": 11, "i": 12, "v_dc": 13, "i_pv": 14}

    def per_kind(numbers):
        return [numbers.get(name, numbers.get(name[0])) for name in CHANNELS]

    assert list(p.gain) == list(p.offset) == [each[name] for name in CHANNELS]
    assert list(p.noise) == per_kind(noise)
    assert list(p.low) == [
        0 if name in {"v_dc", "i_pv"} else -x for name, x in zip(CHANNELS, per_kind(ends), strict=True)
    ]
    assert list(p.high + p.step) == per_kind(ends)


def test_ideal_hardware_changes_nothing():
    """Hardware that is there but ideal gives the same waveforms as none: the same path of the signal."""
    plain = run(depth=0.9)
    ideal = run("sensors.voltage_range_v=1e6", depth=0.9)
    for name in plain.channels:
        assert np.allclose(plain[name], ideal[name], rtol=0, atol=1e-6), name


def test_current_offset_comes_out():
    """An offset of the current sensor comes out as a direct current of opposite sign: the PR has no gain against it."""
    segment = before(run("sensors.current_offset_a=[10,-5,-5]"))
    direct = [mean(i, segment.dt_s, 50.0) for i in segment.three_phase("i")]
    assert direct == pytest.approx([-10, 5, 5], abs=0.5)


def test_current_gain_comes_out():
    """A current sensor that reads 2 % too much in all phases gives 2 % less current."""
    right, wrong = before(run()), before(run("sensors.current_gain=[1.02,1.02,1.02]", irradiance_w_m2=1000))
    ratio = instantaneous_power(wrong).p.mean() / instantaneous_power(right).p.mean()
    assert ratio == pytest.approx(1 / 1.02, rel=2e-3)


def test_unequal_gains_unbalance_the_currents():
    """Current sensors of unequal gain make a negative sequence of a third of their difference."""
    segment = before(run("sensors.current_gain=[1.03,1,1]"))
    phasors = sequence_phasors(segment, "i", 50.0)
    assert abs(phasors.negative[-1]) / abs(phasors.positive[-1]) == pytest.approx(0.01, abs=0.001)


def test_resolution():
    """An 8-bit converter makes the current rougher than a 12-bit one, by about the ratio of their steps."""
    rough = {}
    for bits in (8, 12):
        segment = before(run(f"sensors.adc_bits={bits}"))
        i = segment["i_a_a"]
        fundamental = component(i, segment.dt_s, 50.0)
        t = segment.t_s - segment.t0_s
        wave = (fundamental * np.exp(2j * np.pi * 50 * t)).real
        rough[bits] = (i - wave - (i - wave).mean()).std()
    assert rough[8] > 4 * rough[12]
    assert rough[12] < 0.005 * NOMINAL_A


def test_range_clips():
    """A converter whose range ends below the peak of the voltage lets the controller see a sag that is not there."""
    segment = run("sensors.adc_bits=12", "sensors.voltage_range_v=200")
    assert before(segment)["v_fault_pu"].mean() < 0.85


def test_noise_is_reproducible():
    """The same seed gives the same waveforms, another seed others."""
    settings = ("sensors.current_noise_a=5", "sensors.voltage_noise_v=1")
    one, same = run(*settings), run(*settings)
    other = run(*settings, "sensors.noise_seed=1")
    assert np.array_equal(one["i_a_a"], same["i_a_a"])
    assert not np.array_equal(one["i_a_a"], other["i_a_a"])


def test_measurement_delay_turns_the_currents():
    """Samples that arrive late make the current lag by the delay's angle at 50 Hz, hence positive Q."""
    delay, period = 4, 40.9568e-6
    power = instantaneous_power(before(run(f"sensors.measurement_delay_samples={delay}")))
    lag = np.arctan2(power.q.mean(), power.p.mean())
    # The voltage is late, so the reference is; the current is late, too, and is made to meet it where it is measured.
    assert abs(lag) < 2 * np.pi * 50 * delay * period


def test_computation_delay_costs_the_margin():
    """An integrating loop with a gain w_c at crossover swings up once w_c times its delay is beyond pi/2.

    w_c = K_PWM v_DC K_P / L at 834 V and a delay of N + 1/2 periods: one is far inside, ten are outside.
    """
    w_c = 2 / 3 * 833.7 * 0.0011 / 0.15e-3
    calm, swinging = 1, 10
    assert w_c * (calm + 0.5) * 40.9568e-6 < np.pi / 2 < w_c * (swinging + 0.5) * 40.9568e-6
    assert np.abs(run(f"controller.computation_delay_samples={calm}")["i_a_a"]).max() < 1.01 * NOMINAL_A
    segment = run(f"controller.computation_delay_samples={swinging}")
    assert segment["connected"].min() == 0 or np.abs(segment["i_a_a"]).max() > 1.3 * NOMINAL_A


@pytest.mark.slow
def test_realistic_hardware_passes():
    """The paper's control passes its own sags with the tolerances, noise and resolution of ordinary hardware."""
    profile = load_profile("iec61400-21")
    for sag in (Sag(depth=0.9), Sag(depth=0.9, phases="c"), Sag(depth=0.5, phases="c")):
        result = run_test(profile, profile.ad_hoc_test(sag), parameters_from(REALISTIC)).result
        assert result.status is Status.PASS, [check.message for check in result.checks]
