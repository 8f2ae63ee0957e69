"""Sensors, converters and delays, each block alone: what they make of a number in closed form."""

import math

import numpy as np
import pytest

from pvlvrt_compliance.hardware import delays, hardware, sensors
from pvlvrt_compliance.measured import Measured

QUIET = np.zeros(len(sensors.CHANNELS))
TRUE = Measured(u_g_ab=398 - 120j, i_ab=1250 + 300j, v_dc=831.4, i_pv=600.2)


def params(gain=1.0, offset=0.0, noise=0.0, step=0.0, reach=1e9):
    """The same for all channels."""
    parts = {"gain": gain, "offset": offset, "noise": noise, "step": step, "low": -reach, "high": reach}
    return sensors.SensorParams(**{name: np.full(len(sensors.CHANNELS), x) for name, x in parts.items()})


@pytest.mark.parametrize(
    ("value", "settings", "seen"),
    [
        (100.0, {}, 100.0),
        (100.0, {"gain": 1.02, "offset": -3.0}, 99.0),
        (100.0, {"noise": 2.0}, 101.0),  # half a standard deviation
        (100.0, {"reach": 50.0}, 50.0),
        (-100.0, {"reach": 50.0}, -50.0),
        (100.0, {"step": 0.3}, 99.9),
        (-100.0, {"step": 0.3}, -99.9),
    ],
)
def test_what_a_converter_makes_of_a_number(in_python, value, settings, seen):
    """Gain and offset, noise, the ends of the range, and the nearest step, in that order."""
    assert in_python(sensors.converted)(value, sensors.CHANNELS.index("u_a"), 0.5, params(**settings)) == pytest.approx(
        seen, abs=1e-9
    )


def test_ideal_sensors_see_what_there_is(in_python):
    """The zero sequence that the transducers see, too, drops out of the space vector."""
    found = in_python(sensors.measure)(TRUE, 57.0, np.ones(len(sensors.CHANNELS)), params())
    assert found == pytest.approx(TRUE)


def test_an_offset_of_phase_a_alone_is_a_space_vector(in_python):
    """10 V in phase a are sqrt(2/3) 10 V along alpha, eq (1)."""
    alone = params()
    alone.offset[sensors.CHANNELS.index("u_a")] = 10.0
    found = in_python(sensors.measure)(TRUE, 0.0, QUIET.copy(), alone)
    assert found.u_g_ab - TRUE.u_g_ab == pytest.approx(np.sqrt(2 / 3) * 10)
    assert found.i_ab == pytest.approx(TRUE.i_ab)


def numbers_of(y):
    """What is measured, by channel; phases without their zero sequence."""
    along = [math.sqrt(2 / 3) * np.exp(-2j * math.pi * k / 3) for k in range(3)]
    phases = [(z * axis).real for z in (y.u_g_ab, y.i_ab) for axis in along]
    return dict(zip(sensors.CHANNELS, (*phases, y.v_dc, y.i_pv), strict=True))


@pytest.mark.parametrize("channel", sensors.CHANNELS)
@pytest.mark.parametrize("part", ["gain", "offset", "noise"])
def test_each_channel_has_a_sensor_of_its_own(in_python, channel, part):
    """What is wrong with one sensor, its own random number included, is in its signal alone.

    A space vector holds no zero sequence: of an error in one phase that phase has two thirds, the others lose one.
    """
    place, wrong, random = sensors.CHANNELS.index(channel), params(), QUIET.copy()
    getattr(wrong, part)[place], random[place] = 1.5, 2.0
    true, seen = numbers_of(TRUE), numbers_of(in_python(sensors.measure)(TRUE, 0.0, random, wrong))
    error = {"gain": 0.5 * true[channel], "offset": 1.5, "noise": 3.0}[part]
    three = [f"{channel[0]}_{phase}" for phase in "abc"] if channel[:2] in {"u_", "i_"} and channel != "i_pv" else []
    shares = {**dict.fromkeys(three, -1 / 3), channel: 2 / 3 if three else 1.0}
    assert seen == pytest.approx({name: x + error * shares.get(name, 0.0) for name, x in true.items()})


@pytest.mark.parametrize("late", [0, 1, 3])
def test_what_is_measured_comes_so_many_periods_late(in_python, late):
    """Of a ramp, the controller reads the value of as many periods ago; before the run what had been under way."""
    ideal = hardware.Hardware(params(), delays.filled(delays.DelayParams(late, 1), TRUE, 0j), QUIET[np.newaxis])
    for n in range(8):
        found = in_python(hardware.seen_at)(TRUE._replace(v_dc=100.0 + n), 0.0, n, ideal)
        assert found.v_dc == pytest.approx(100.0 + n - late if n >= late else TRUE.v_dc)


@pytest.mark.parametrize("late", [0, 1, 2, 4])
def test_what_is_computed_acts_so_many_samples_later(in_python, late):
    """The modulating signal of sample n acts from sample n + late; until then what had been sent off before.

    Computed at once it acts from its own sample on, though not as that was taken.
    """
    around = hardware.Hardware(params(), delays.filled(delays.DelayParams(0, late), TRUE, 0.5j), QUIET[np.newaxis])
    before, since = [], []
    for n in range(8):
        before.append(in_python(hardware.acting_as_sampled)(-1j, n, around))
        since.append(in_python(hardware.acting_from)(before[-1], complex(n), n, around))
    assert since == [0.5j if n < late else complex(n - late) for n in range(8)]
    assert before == (since if late > 0 else [0.5j, *since[:-1]])


def test_without_hardware_all_is_ideal_and_one_sample_late(in_python):
    """What there is is seen, zero sequence aside; what was computed last acts from the next sample on."""
    assert in_python(hardware.seen_at)(TRUE, 57.0, 3, None) == TRUE
    assert in_python(hardware.acting_as_sampled)(0.25j, 3, None) == 0.25j
    assert in_python(hardware.acting_from)(0.25j, 1j, 3, None) == 0.25j
