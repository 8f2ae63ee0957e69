import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.plant import carrier
from pvlvrt_compliance.plant.inverter import M_MAX
from pvlvrt_compliance.space_vectors import clarke

T = 40.9568e-6
sizes, angles = st.floats(0, 1), st.floats(0, 2 * math.pi)


def modulating(size: float, angle: float) -> complex:
    """Modulating signal by its share of the linear range and its angle."""
    return size * M_MAX * complex(math.cos(angle), math.sin(angle))


def triangle(t: float) -> float:
    """Carrier between 0 and 1, at its upper extreme at the beginning of a period."""
    return abs(1 - 2 * t / T)


@given(sizes, angles)
def test_duties_are_within_the_period_over_the_whole_linear_range(in_python, size, angle):
    """Up to |u_inv| = v_DC / sqrt(2) no leg leaves 0 to 1, and the outer two lie equally far from the ends."""
    duty = in_python(carrier.duties)(modulating(size, angle))
    assert -1e-12 <= min(duty) <= max(duty) <= 1 + 1e-12
    assert max(duty) + min(duty) == pytest.approx(1)


@given(sizes, angles)
def test_duties_mean_what_the_averaged_inverter_gives(in_python, size, angle):
    """The vector of the duties is 2/3 m: per volt of the link, the averaged voltage."""
    m = modulating(size, angle)
    assert clarke(*in_python(carrier.duties)(m)) == pytest.approx(2 / 3 * m, abs=1e-12)


@given(sizes, angles)
@draws(20)
def test_a_leg_is_up_while_its_duty_exceeds_the_carrier(in_python, size, angle):
    """Pulses are what the comparison with the triangle gives, instant by instant."""
    m = modulating(size, angle)
    pulses = in_python(carrier.pulses_of)(m, T)
    for duty, pulse in zip(in_python(carrier.duties)(m), pulses, strict=True):
        for t in np.linspace(0, T, 101)[:-1]:
            if abs(duty - triangle(t)) > 1e-9:
                assert in_python(carrier.is_up)(t, pulse, 1.0, 0.0) == (duty > triangle(t))


@pytest.mark.parametrize(("duty", "up"), [(0.0, False), (-1e-16, False), (1.0, True), (1 + 1e-16, True)])
def test_a_leg_at_the_end_of_its_range_does_not_switch(in_python, duty, up):
    """At a duty of 0 or 1 there is no edge, hence no dead time and no loss."""
    pulse = in_python(carrier.pulse_of)(duty, T)
    assert in_python(carrier.change_after)(0.0, pulse, 1e-6, T) == T
    assert {in_python(carrier.is_up)(t, pulse, i, 1e-6) for t in (0, T / 3, T) for i in (-1.0, 1.0)} == {up}


@pytest.mark.parametrize(("i", "lost"), [(100.0, 1), (-100.0, -1)])
def test_dead_time_takes_from_the_pulse_what_the_current_opposes(in_python, i, lost):
    """Current out of a leg shortens its pulse by the dead time, current into it lengthens it by the same."""
    t_dead = 0.5e-6
    pulse = in_python(carrier.pulse_of)(0.4, T)
    t, up = 0.0, 0.0
    while t < T:
        t_next = in_python(carrier.change_after)(t, pulse, t_dead, T)
        up += (t_next - t) * in_python(carrier.is_up)(t, pulse, i, t_dead)
        t = t_next
    assert up == pytest.approx(0.4 * T - lost * t_dead, rel=1e-12)


def test_a_pulse_shorter_than_the_dead_time_is_left_to_the_diodes(in_python):
    """A switch that would come on after its command has gone stays off: no pulse, or one of the diode."""
    t_dead = 1e-6
    pulse = in_python(carrier.pulse_of)(0.5 * t_dead / T, T)
    times = np.linspace(0, T, 2001)
    assert not any(in_python(carrier.is_up)(t, pulse, 1.0, t_dead) for t in times)
    by_diode = [t for t in times if in_python(carrier.is_up)(t, pulse, -1.0, t_dead)]
    assert max(by_diode) - min(by_diode) == pytest.approx(1.5 * t_dead, abs=2 * T / 2000)
