"""Blocked bridge: no device is turned on, and what the six diodes carry the line and the link alone decide.

A diode conducts from the lower end of the link to a phase whose current flows to the grid, and from a phase whose
current flows into the inverter to the upper end: v_DC drives every current to zero against its sign. A phase without
current stays without while its potential lies between the ends of the link; where all three are, while no line-to-line
voltage of the source exceeds v_DC. Else the bridge rectifies.
"""

from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.plant.line import LineParams, line_part
from pvlvrt_compliance.plant.switched_bridge import PeriodMean, SwitchedFlow
from pvlvrt_compliance.vectors import Phases, phases_of, scaled, vector_of

NO_CURRENT = 1e-6
"""Phase current that counts as none (A): a thousandth of what rounding leaves of a nominal one would do."""

_MOST_PARTS = 8  # of a plant step: three currents may end in it and three begin, and no more where it is short


class Diodes(NamedTuple):
    """What conducts in each phase: 1 the upper diode, -1 the lower, 0 neither."""

    a: float
    b: float
    c: float


@kernel
def carrying(i: float) -> float:
    """Diode that carries a phase current (A), positive to the grid."""
    if abs(i) <= NO_CURRENT:
        return 0.0
    return -1.0 if i > 0 else 1.0


@kernel
def floating(potential: float, v_half: float) -> float:
    """Diode that a potential (V, against the middle of the link) turns on in a phase without current."""
    if abs(potential) <= v_half:
        return 0.0
    return 1.0 if potential > 0 else -1.0


@kernel
def turned_on(e: Phases, v: float) -> Diodes:
    """Diodes that the source's phase voltages (V) turn on at no current: of the two phases farthest apart, if any."""
    most, least = max(e.a, e.b, e.c), min(e.a, e.b, e.c)
    if most - least <= v:
        return Diodes(a=0.0, b=0.0, c=0.0)
    return Diodes(
        a=1.0 if e.a == most else (-1.0 if e.a == least else 0.0),
        b=1.0 if e.b == most and e.a != most else (-1.0 if e.b == least and e.a != least else 0.0),
        c=1.0
        if e.c == most and most not in (e.a, e.b)
        else (-1.0 if e.c == least and least not in (e.a, e.b) else 0.0),
    )


@kernel
def conducting(i: Phases, e: Phases, v: float) -> Diodes:
    """Diodes that conduct.

    Parameters
    ----------
    i : Phases
        Currents (A), positive to the grid.
    e : Phases
        Phase voltages of the source, their sum zero (V).
    v : float
        Between the outer ends of two diodes in series with the link (V): v_DC and the drops of both.
    """
    s = Diodes(a=carrying(i.a), b=carrying(i.b), c=carrying(i.c))
    if s.a == 0 and s.b == 0 and s.c == 0:
        s = turned_on(e, v)
    # With two phases conducting, at opposite ends, half the difference of their currents passes: the potential of the
    # third is e + e / 2.
    if s.a == 0 and s.b * s.c < 0:
        s = Diodes(a=floating(1.5 * e.a, 0.5 * v), b=s.b, c=s.c)
    elif s.b == 0 and s.a * s.c < 0:
        s = Diodes(a=s.a, b=floating(1.5 * e.b, 0.5 * v), c=s.c)
    elif s.c == 0 and s.a * s.b < 0:
        s = Diodes(a=s.a, b=s.b, c=floating(1.5 * e.c, 0.5 * v))
    return s


@kernel
def driven(s: Diodes, e: Phases, v: float) -> Phases:
    """Voltages (V) that drive the phase currents, u - e; a phase without current has none."""
    on = abs(s.a) + abs(s.b) + abs(s.c)
    if on < 2:
        return Phases(a=0.0, b=0.0, c=0.0)
    d = Phases(
        a=0.5 * v * s.a - e.a if s.a != 0 else 0.0,
        b=0.5 * v * s.b - e.b if s.b != 0 else 0.0,
        c=0.5 * v * s.c - e.c if s.c != 0 else 0.0,
    )
    common = (d.a + d.b + d.c) / on
    return Phases(
        a=d.a - common if s.a != 0 else 0.0,
        b=d.b - common if s.b != 0 else 0.0,
        c=d.c - common if s.c != 0 else 0.0,
    )


@kernel
def blocked_voltage(i: complex, e: complex, v_dc: float, v_drop: float) -> complex:
    """Voltage vector of a blocked bridge (V); the source's own where it carries no current."""
    source = phases_of(e)
    v = v_dc + 2 * v_drop
    return e + vector_of(driven(conducting(phases_of(i), source, v), source, v))


@kernel
def blocked_dc_current(i: complex) -> float:
    """Current that a blocked bridge takes from the link (A): what the upper diodes carry, back into it."""
    x = phases_of(i)
    return -0.5 * (abs(x.a) + abs(x.b) + abs(x.c))


@kernel
def ends_at(i: float, i_next: float, s: float) -> float:
    """Share of the way to a current (A) at which it ends, as it would reverse; more than 1: it goes on."""
    if s == 0 or i_next * s <= 0:  # a diode's current is against its sign
        return 2.0
    if i * s >= 0:  # one that had none would begin the wrong way
        return 0.0
    return i / (i - i_next)


@kernel
def kept(i: float, s: float, ends: bool) -> float:
    """Phase current (A) of a diode that conducts; none where it has just ended, or would flow against the diode."""
    return 0.0 if ends or i * s >= -NO_CURRENT else i


@kernel
def of_two(i: Phases) -> complex:
    """Vector of phase currents of which some have just been set to zero: the others keep their sum at zero."""
    on = (1.0 if i.a != 0 else 0.0) + (1.0 if i.b != 0 else 0.0) + (1.0 if i.c != 0 else 0.0)
    if on < 2:
        return 0j
    common = (i.a + i.b + i.c) / on
    return vector_of(
        Phases(
            a=i.a - common if i.a != 0 else 0.0,
            b=i.b - common if i.b != 0 else 0.0,
            c=i.c - common if i.c != 0 else 0.0,
        )
    )


@kernel
def blocked_flow(
    i: complex, v_dc: float, i_pv: float, e: complex, line: LineParams, C: float, T_S: float, v_drop: float
) -> SwitchedFlow:
    """Advance line and link by one plant step under a blocked bridge.

    Between two changes of what conducts the line is solved exactly, under the link's voltage at the middle; where a
    current ends within the step, the rest of the step goes on without it.

    Parameters
    ----------
    i, v_dc : complex, float
        Current (A) and DC-link voltage (V) at the beginning.
    i_pv, e : float, complex
        Array current (A) and source (V), constant over the step.
    C, T_S, v_drop : float
        DC-link capacitance (F), plant step (s), voltage across a conducting diode (V).
    """
    source = phases_of(e)
    left = 1.0
    u_mean, i_mean = 0j, 0j
    for part in range(_MOST_PARTS):
        v_mid = max(v_dc + 0.5 * left * T_S / C * (i_pv - blocked_dc_current(i)), 0.0)
        v = v_mid + 2 * v_drop
        now = phases_of(i)
        s = conducting(now, source, v)
        u = e + vector_of(driven(s, source, v))
        then = phases_of(line_part(i, u, e, left, line))
        ends = Phases(a=ends_at(now.a, then.a, s.a), b=ends_at(now.b, then.b, s.b), c=ends_at(now.c, then.c, s.c))
        share = min(ends.a, ends.b, ends.c, 1.0)
        if part == _MOST_PARTS - 1:
            share = 1.0
        length = share * left
        then = phases_of(line_part(i, u, e, length, line))
        i_next = of_two(
            Phases(
                a=kept(then.a, s.a, ends.a <= share),
                b=kept(then.b, s.b, ends.b <= share),
                c=kept(then.c, s.c, ends.c <= share),
            )
        )
        i_mid = scaled(0.5, i + i_next)
        v_dc = max(v_dc + length * T_S / C * (i_pv - 0.5 * (blocked_dc_current(i) + blocked_dc_current(i_next))), 0.0)
        u_mean += scaled(length, u)
        i_mean += scaled(length, i_mid)
        i, left = i_next, left - length
        if left <= 0.0:
            break
    return SwitchedFlow(i=i, v_dc=v_dc, mean=PeriodMean(u=u_mean, i=i_mean))
