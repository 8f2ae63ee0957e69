"""One slip of a controller, by numbers alone: what goes wrong, by how much, and when. No slip costs a compilation.

A slip acts in some phases of a record (before any sag, in sags, after them, in swells), in some of its sags (the first,
the second and later), for some time of the phase, and at some voltages.
"""

import math
from enum import IntEnum, IntFlag
from typing import NamedTuple

from pvlvrt_compliance.control.lvrt import LvrtOrder
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.plant.grid import Source
from pvlvrt_compliance.plant.plant import PlantParams, PlantState, PlantTables, advance
from pvlvrt_compliance.plant.protection import NO_TRIP, UNDERVOLTAGE
from pvlvrt_compliance.vectors import scaled


class What(IntEnum):
    """What goes wrong; ``amount`` and ``rate`` of a slip are in the units given here."""

    NOTHING = 0
    CURRENT_TIMES = 1  # current reference times amount
    Q_TIMES = 2  # reactive power times amount
    Q_PLUS = 3  # reactive power plus amount (pu)
    P_TIMES = 4  # active power times amount
    P_AT_MOST = 5  # active power, amount (pu)
    P_IS = 6  # active power, amount (pu); negative: taken from the grid
    Q_SWINGS = 7  # reactive power plus a swing of amplitude amount (pu) at rate (Hz)
    P_SWINGS = 8  # active power plus the same
    TONE = 9  # current reference plus a vector of amount (pu) that turns at rate (Hz): 0 direct, -50 negative sequence
    HOLD = 10  # orders are those of before
    TURN = 11  # current reference turned by amount (rad)
    TRIP = 12  # the breaker opens
    DROPS = 13  # current reference times amount in every second half of a period of rate (Hz)
    PHASE_A_TIMES = 14  # current reference of phase a times amount
    NEGATIVE_TIMES = 15  # negative sequence that the references are made from, times amount


class When(IntFlag):
    """Phases of a record."""

    BEFORE = 1  # normal voltage, no sag yet
    SAG = 2
    AFTER = 4  # normal voltage, after a sag
    SWELL = 8
    NORMAL = 5
    ALWAYS = 15


class Slip(NamedTuple):
    """What goes wrong and when. Numbers, as compiled code takes them."""

    what: int = 0
    amount: float = 0.0
    rate: float = 0.0
    when: int = int(When.SAG)
    first: int = 0  # sag, counted from 1, from which on it happens
    last: int = 1000  # and up to which
    begin_s: float = 0.0  # from this time of the phase on (s)
    end_s: float = 1e3  # up to this
    low_pu: float = -1.0  # V+ from which on (pu)
    high_pu: float = 10.0  # and up to which

    @property
    def as_numbers(self) -> "Slip":
        """The same in the types that the loop is compiled for."""
        whole = {"what", "when", "first", "last"}
        return Slip._make(int(x) if name in whole else float(x) for name, x in self._asdict().items())

    @property
    def in_words(self) -> str:
        """As a table shows it."""
        said = [f"What.{What(self.what).name}", _phases(self.when)]
        for name in self._fields[1:3] + self._fields[4:]:
            value = getattr(self, name)
            if value != self._field_defaults[name]:
                said.append(f"{name}={value:g}")
        return ", ".join(said)


def _phases(when: int) -> str:
    if when == When.ALWAYS:
        return "When.ALWAYS"
    names = [phase.name for phase in (When.BEFORE, When.SAG, When.AFTER, When.SWELL) if when & phase]
    return "|".join(f"When.{name}" for name in names)


class Lapse(NamedTuple):
    """What a slip remembers."""

    phase: int  # as `When` counts
    t: float  # since it began (s)
    sags: int  # begun so far
    P_limit: float  # orders while it last did not act
    Q_ref: float


NO_SLIP = Slip()
NO_LAPSE = Lapse(phase=1, t=0.0, sags=0, P_limit=0.0, Q_ref=0.0)

# Compiled code knows numbers, not an enumeration.
_CURRENT, _Q_TIMES, _Q_PLUS, _P_TIMES, _P_AT_MOST, _P_IS, _Q_SWINGS, _P_SWINGS = (int(What(k)) for k in range(1, 9))
_TONE, _HOLD, _TURN, _TRIP, _DROPS, _PHASE_A, _NEGATIVE = (int(What(k)) for k in range(9, 16))
_BEFORE, _SAG, _AFTER, _SWELL = 1, 2, 4, 8

_SWELL_FROM = 1.1  # V+ (pu)
_OPEN = 1e6  # a modulating signal that opens the breaker (-)


@kernel
def lapsed(x: Lapse, slip: Slip, order: LvrtOrder, T: float) -> Lapse:
    """Advance what is remembered by one sample."""
    sags = x.sags + 1 if order.fault and x.phase != _SAG else x.sags
    phase = _AFTER if sags > 0 else _BEFORE
    if order.fault:
        phase = _SAG
    elif order.V_fault > _SWELL_FROM:
        phase = _SWELL
    t = x.t + T if phase == x.phase else 0.0
    now = Lapse(phase=phase, t=t, sags=sags, P_limit=x.P_limit, Q_ref=x.Q_ref)
    if acts(slip, now, order.V_fault):
        return now
    return Lapse(phase=phase, t=t, sags=sags, P_limit=order.P_limit, Q_ref=order.Q_ref)


@kernel
def acts(slip: Slip, x: Lapse, V_fault: float) -> bool:
    """Whether the slip happens now."""
    if slip.what == 0 or not (slip.when & x.phase) or not (slip.first <= x.sags <= slip.last):
        return False
    return slip.begin_s <= x.t <= slip.end_s and slip.low_pu <= V_fault <= slip.high_pu


@kernel
def slipped_order(right: LvrtOrder, slip: Slip, x: Lapse, S_nom: float) -> LvrtOrder:
    """Orders for active and reactive power."""
    P_limit, Q = right.P_limit, right.Q_ref
    if not acts(slip, x, right.V_fault):
        return right
    if slip.what == _Q_TIMES:
        Q *= slip.amount
    elif slip.what == _Q_PLUS:
        Q += slip.amount * S_nom
    elif slip.what == _Q_SWINGS:
        Q += slip.amount * S_nom * math.sin(2 * math.pi * slip.rate * x.t)
    elif slip.what == _P_AT_MOST:
        P_limit = min(P_limit, slip.amount * S_nom)
    elif slip.what == _HOLD:
        P_limit, Q = x.P_limit, x.Q_ref
    return LvrtOrder(V_fault=right.V_fault, fault=right.fault, P_limit=P_limit, Q_ref=Q)


@kernel
def slipped_power(P_ref: float, V_fault: float, slip: Slip, x: Lapse, S_nom: float) -> float:
    """Active power that is asked for (W)."""
    if not acts(slip, x, V_fault):
        return P_ref
    if slip.what == _P_TIMES:
        return slip.amount * P_ref
    if slip.what == _P_IS:
        return slip.amount * S_nom
    if slip.what == _P_SWINGS:
        return P_ref + slip.amount * S_nom * math.sin(2 * math.pi * slip.rate * x.t)
    return P_ref


@kernel
def slipped_negative(V_fault: float, slip: Slip, x: Lapse) -> float:
    """What the negative sequence is taken times."""
    return slip.amount if slip.what == _NEGATIVE and acts(slip, x, V_fault) else 1.0


@kernel
def slipped_current(i_ref: complex, I_nom: float, V_fault: float, slip: Slip, x: Lapse) -> complex:
    """Current reference (A); ``I_nom`` is the length of the nominal current's vector."""
    if not acts(slip, x, V_fault):
        return i_ref
    if slip.what == _CURRENT or (slip.what == _DROPS and (x.t * slip.rate) % 1.0 >= 0.5):
        return scaled(slip.amount, i_ref)
    if slip.what == _TURN:
        return i_ref * complex(math.cos(slip.amount), math.sin(slip.amount))
    if slip.what == _TONE:
        angle = 2 * math.pi * slip.rate * x.t
        return i_ref + slip.amount * I_nom * complex(math.cos(angle), math.sin(angle))
    if slip.what == _PHASE_A:  # the others take what is missing, half each: a current without zero sequence
        return complex(slip.amount * i_ref.real, i_ref.imag)
    return i_ref


@kernel
def slipped_m(m: complex, V_fault: float, slip: Slip, x: Lapse) -> complex:
    """Modulating signal, or the one that opens the breaker."""
    return complex(_OPEN, 0.0) if slip.what == _TRIP and acts(slip, x, V_fault) else m


@kernel
def advance_or_trip(
    x: PlantState, m: complex, source: Source, t: float, p: PlantParams, tables: PlantTables
) -> PlantState:
    """Advance the plant by one control period; a controller that asks for it trips it."""
    after = advance(x, m, source, t, p, tables)
    if m.real < _OPEN or after.trip != NO_TRIP:
        return after
    return PlantState(
        i=after.i,
        v_dc=after.v_dc,
        x_pv=after.x_pv,
        i_pv=after.i_pv,
        relay=after.relay,
        trip=UNDERVOLTAGE,
        t_trip=0.0,
        closed=after.closed,
        blocked=after.blocked,
        mean=after.mean,
    )
