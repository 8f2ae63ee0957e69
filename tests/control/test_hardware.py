"""Sensors, converters and delays, each block alone: what they make of a number in closed form."""

import numpy as np
import pytest

from pvlvrt_compliance.control import delays, hardware, sensors
from pvlvrt_compliance.control.controller import Measured

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
    assert in_python(sensors.converted)(value, 0, 0.5, params(**settings)) == pytest.approx(seen, abs=1e-9)


def test_ideal_sensors_see_what_there_is(in_python):
    """The zero sequence that the transducers see, too, drops out of the space vector."""
    found = in_python(sensors.measure)(TRUE, 57.0, np.ones(8), params())
    assert found == pytest.approx(TRUE)


def test_an_offset_of_phase_a_alone_is_a_space_vector(in_python):
    """10 V in phase a are sqrt(2/3) 10 V along alpha, eq (1)."""
    alone = params()
    alone.offset[0] = 10.0
    found = in_python(sensors.measure)(TRUE, 0.0, np.zeros(8), alone)
    assert found.u_g_ab - TRUE.u_g_ab == pytest.approx(np.sqrt(2 / 3) * 10)
    assert found.i_ab == pytest.approx(TRUE.i_ab)


@pytest.mark.parametrize("late", [0, 1, 3])
def test_what_is_measured_comes_so_many_periods_late(in_python, late):
    """Of a ramp, the controller reads the value of as many periods ago; before the run what had been under way."""
    ideal = hardware.Hardware(params(), delays.filled(delays.DelayParams(late, 1), TRUE, 0j), np.zeros((1, 8)))
    for n in range(8):
        found = in_python(hardware.read)(TRUE._replace(v_dc=100.0 + n), 0.0, n, 0, ideal)
        assert found.v_dc == pytest.approx(100.0 + n - late if n >= late else TRUE.v_dc)


@pytest.mark.parametrize("late", [1, 2, 4])
def test_what_is_computed_acts_so_many_periods_later(in_python, late):
    """The modulating signal of period n acts in period n + late; until then what had been sent off before."""
    lines = delays.filled(delays.DelayParams(0, late), TRUE, 0.5j)
    acted = []
    for n in range(8):
        acted.append(in_python(delays.acting)(lines, n))
        in_python(delays.put)(lines, n, complex(n))
    assert acted == [0.5j if n < late else complex(n - late) for n in range(8)]
