"""Triangular carrier, and the pulses that its comparison with the modulating signal gives to the three legs."""

import math
from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.plant.inverter import K_PWM
from pvlvrt_compliance.vectors import Phases, phases_of, scaled


class Pulse(NamedTuple):
    """Instants in a carrier period at which a leg is told to switch up and down; infinite: it does not switch."""

    up: float  # (s)
    down: float  # (s)


class Pulses(NamedTuple):
    """Pulses of the three legs."""

    a: Pulse
    b: Pulse
    c: Pulse


@kernel
def duties(m: complex) -> Phases:
    """Share of a period that each leg is up (-).

    The phase voltages are 2/3 v_DC m, shifted so that the largest and the smallest lie equally far from the ends of the
    link (min-max zero-sequence injection). The shift drives no current and widens the linear range to |u_inv| =
    v_DC/sqrt(2).
    """
    u = phases_of(scaled(K_PWM, m))
    shift = 0.5 - 0.5 * (max(u.a, u.b, u.c) + min(u.a, u.b, u.c))
    return Phases(a=u.a + shift, b=u.b + shift, c=u.c + shift)


@kernel
def pulse_of(duty: float, T: float) -> Pulse:
    """Pulse of a leg in a carrier period of length T (s).

    The carrier falls from its upper extreme to the lower in half a period and comes back: pulses lie in the middle.
    """
    if duty <= 0.0:
        return Pulse(up=math.inf, down=math.inf)
    if duty >= 1.0:
        return Pulse(up=-math.inf, down=math.inf)
    return Pulse(up=0.5 * (1 - duty) * T, down=0.5 * (1 + duty) * T)


@kernel
def pulses_of(m: complex, T: float) -> Pulses:
    """Pulses of a carrier period (s) under a modulating signal, which is held for it (regular sampling)."""
    duty = duties(m)
    return Pulses(a=pulse_of(duty.a, T), b=pulse_of(duty.b, T), c=pulse_of(duty.c, T))


@kernel
def is_up(t: float, pulse: Pulse, i: float, t_dead: float) -> bool:
    """Whether a leg connects to the upper end of the link at an instant (s).

    For the dead time after either command both switches are off, and the current (A, out of the leg) chooses the diode.
    """
    if pulse.up <= t < pulse.up + t_dead or pulse.down <= t < pulse.down + t_dead:
        return i < 0.0
    return pulse.up <= t < pulse.down


@kernel
def sooner(t: float, instant: float, end: float) -> float:
    """Instant if it lies after ``t`` and before ``end``; else ``end`` (s)."""
    return instant if t < instant < end else end


@kernel
def change_after(t: float, pulse: Pulse, t_dead: float, end: float) -> float:
    """Next instant after ``t`` at which a leg may change, ``end`` at the latest (s)."""
    end = sooner(t, pulse.up, end)
    end = sooner(t, pulse.up + t_dead, end)
    end = sooner(t, pulse.down, end)
    return sooner(t, pulse.down + t_dead, end)


@kernel
def next_change(t: float, pulses: Pulses, t_dead: float, end: float) -> float:
    """Next instant after ``t`` at which any leg may change, ``end`` at the latest (s)."""
    end = change_after(t, pulses.a, t_dead, end)
    end = change_after(t, pulses.b, t_dead, end)
    return change_after(t, pulses.c, t_dead, end)
