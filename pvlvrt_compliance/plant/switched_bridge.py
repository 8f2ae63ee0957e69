"""Two-level bridge, switched: legs that change within a plant step, dead time, device drops and losses."""

import math
from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.plant.carrier import Pulse, Pulses, is_up, next_change
from pvlvrt_compliance.plant.line import LineParams, line_part
from pvlvrt_compliance.vectors import Phases, dot, phases_of, scaled, vector_of


class DeviceParams(NamedTuple):
    """The six devices. What they have of resistance is in series with the line, as one conducts in every leg."""

    t_dead: float  # dead time (s)
    v_drop: float  # voltage across a conducting device at no current (V)
    t_loss: float  # energy of turning on and off, per volt and ampere switched (s)


class PeriodMean(NamedTuple):
    """Means over the carrier period that has ended, or over what has passed of it."""

    u: complex  # inverter voltage (V)
    i: complex  # current (A)


class SwitchedFlow(NamedTuple):
    """Where a plant step has led to, and its means."""

    i: complex  # current at its end (A)
    v_dc: float  # DC-link voltage at its end (V)
    mean: PeriodMean


@kernel
def added_to_mean(x: PeriodMean, step: PeriodMean, n: int, ratio: int) -> PeriodMean:
    """Mean over a period with the mean of its plant step ``n`` of ``ratio`` added; the first begins anew."""
    share = 1.0 / ratio
    before = 0.0 if n == 0 else 1.0
    return PeriodMean(
        u=scaled(before, x.u) + scaled(share, step.u),
        i=scaled(before, x.i) + scaled(share, step.i),
    )


@kernel
def leg_states(t: float, pulses: Pulses, i: Phases, t_dead: float) -> Phases:
    """State of each leg at an instant (s): 1 at the upper end of the link, 0 at the lower."""
    return Phases(
        a=1.0 if is_up(t, pulses.a, i.a, t_dead) else 0.0,
        b=1.0 if is_up(t, pulses.b, i.b, t_dead) else 0.0,
        c=1.0 if is_up(t, pulses.c, i.c, t_dead) else 0.0,
    )


@kernel
def drop(i: complex, v_drop: float) -> complex:
    """Voltage vector (V) across the devices that carry a current vector (A), but for their resistance."""
    x = phases_of(i)
    return vector_of(Phases(a=math.copysign(v_drop, x.a), b=math.copysign(v_drop, x.b), c=math.copysign(v_drop, x.c)))


@kernel
def switched_charge(t: float, pulse: Pulse, i: float, t_loss: float) -> float:
    """Charge (A s) that a leg's commutation at this very instant takes from the link: half of E_on + E_off over v_DC.

    Energies go with the voltage and the current (A) that are switched.
    """
    return 0.5 * t_loss * abs(i) if t in (pulse.up, pulse.down) else 0.0


@kernel
def commutation_charge(t: float, pulses: Pulses, i: Phases, t_loss: float) -> float:
    """Charge (A s) that the commutations of all legs at this very instant take from the link."""
    charge = switched_charge(t, pulses.a, i.a, t_loss)
    charge += switched_charge(t, pulses.b, i.b, t_loss)
    return charge + switched_charge(t, pulses.c, i.c, t_loss)


@kernel
def switched_flow(
    i: complex,
    v_dc: float,
    i_pv: float,
    e: complex,
    n: int,
    pulses: Pulses,
    line: LineParams,
    C: float,
    T_S: float,
    p: DeviceParams,
) -> SwitchedFlow:
    """Advance line and link by plant step ``n`` of the carrier period.

    Between two changes of the legs the line is solved exactly under the link's voltage at the middle, and i_DC is the
    sum of the currents of the legs that are up. No instant is rounded to the plant step. A dead time that the end of
    the carrier period cuts short is not carried over.

    Parameters
    ----------
    i, v_dc : complex, float
        Current (A) and DC-link voltage (V) at the beginning.
    i_pv, e : float, complex
        Array current (A) and source (V), constant over the step.
    pulses : Pulses
        Commands of this carrier period.
    C, T_S : float
        DC-link capacitance (F) and plant step (s).
    """
    t, end = n * T_S, (n + 1) * T_S
    u_mean, i_mean = 0j, 0j
    while t < end:
        legs = phases_of(i)
        v_dc -= commutation_charge(t, pulses, legs, p.t_loss) / C
        s = vector_of(leg_states(t, pulses, legs, p.t_dead))
        t_next = next_change(t, pulses, p.t_dead, end)
        dt = t_next - t
        v_mid = v_dc + 0.5 * dt / C * (i_pv - dot(s, i))
        u = scaled(v_mid, s) - drop(i, p.v_drop)
        i_next = line_part(i, u, e, dt / T_S, line)
        i_mid = scaled(0.5, i + i_next)
        v_dc = max(v_dc + dt / C * (i_pv - dot(s, i_mid)), 0.0)
        u_mean += scaled(dt / T_S, u)
        i_mean += scaled(dt / T_S, i_mid)
        i, t = i_next, t_next
    return SwitchedFlow(i=i, v_dc=v_dc, mean=PeriodMean(u=u_mean, i=i_mean))
