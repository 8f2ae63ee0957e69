"""A controller that is wrong in one of many ways, chosen by a number: all of them cost one compilation."""

import math
from collections.abc import Callable
from enum import IntEnum
from functools import cache, partial
from typing import Any, NamedTuple

from pvlvrt_compliance.control.controller import ControllerParams, ControllerSignals, ControllerState
from pvlvrt_compliance.control.current_references import CurrentReferenceParams, current_references
from pvlvrt_compliance.control.current_regulator import current_regulator_step
from pvlvrt_compliance.control.dc_voltage_regulator import (
    DcVoltageRegulatorParams,
    DcVoltageRegulatorState,
    dc_voltage_regulator_step,
)
from pvlvrt_compliance.control.lvrt import LvrtOrder, LvrtParams, lvrt_step
from pvlvrt_compliance.control.modulator import modulate
from pvlvrt_compliance.control.mppt import mppt_step
from pvlvrt_compliance.control.synchronisation import synchronise
from pvlvrt_compliance.control.synchronised import Synchronisation
from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.vectors import ahead, dot, length, scaled, turned
from validation.mutations.rebuild import Loop, rebuilt_loop
from validation.mutations.slips import (
    NO_LAPSE,
    NO_SLIP,
    Lapse,
    Slip,
    advance_or_trip,
    lapsed,
    slipped_current,
    slipped_m,
    slipped_negative,
    slipped_order,
    slipped_power,
)


class Wrong(IntEnum):
    """What is wrong."""

    NOTHING = 0
    Q_REVERSED = 1
    Q_LATE = 2
    Q_SWINGS = 3
    Q_TOGGLES = 4
    Q_STAYS = 5
    Q_NEGATIVE_REVERSED = 6
    NO_SUPPORT = 7
    NO_ROOM_FOR_NEGATIVE = 8
    P_STAYS_LOW = 9
    P_COMES_BACK_SLOWLY = 10
    FAULT_STAYS = 11
    WINDS_UP = 12
    CEASES = 13
    NEVER_COMES_BACK = 14
    GIVES_UP_AT_A_JUMP = 15
    FALLS_WITH_FREQUENCY = 16
    P_FLOWS_BACK = 17
    NO_CURRENT_LIMIT = 18
    DC_SIGN_REVERSED = 19


# Compiled code knows numbers, not an enumeration.
_Q_REVERSED, _Q_LATE, _Q_SWINGS, _Q_TOGGLES, _Q_STAYS, _Q_NEGATIVE_REVERSED = (int(Wrong(k)) for k in range(1, 7))
_NO_SUPPORT, _NO_ROOM, _P_STAYS_LOW, _P_SLOWLY, _FAULT_STAYS, _WINDS_UP = (int(Wrong(k)) for k in range(7, 13))
_CEASES, _NEVER_BACK, _GIVES_UP, _FALLS, _P_FLOWS_BACK, _NO_LIMIT, _DC_REVERSED = (int(Wrong(k)) for k in range(13, 20))

_LATE = 0.045  # reactive power comes this late (s)
_SWING_HZ = 10.0
_TOGGLE_FROM = 0.75  # support toggles above it (pu)
_TOGGLE_PERIOD, _TOGGLE_ON = 0.2, 0.17  # and is on for the second in each of the first (s)
_Q_LEFT = 0.1  # reactive power that stays after a sag (pu)
_P_LEFT = 0.4  # active power that stays the limit after a sag (pu)
_RAMP = 1.5  # active power after a sag (pu/s), from _RAMP_FROM (pu)
_RAMP_FROM = 0.2
_CEASE_BELOW = 0.6  # V+ (pu)
_SHIFT = math.sin(math.radians(12))  # angle between V+ and its slow copy
_SLOW = 0.1  # time constant of that copy (s)
_HIGH = 2 * math.pi * 50.4  # frequency (rad/s) above which power falls once it has lasted for _HIGH_FOR (s)
_HIGH_FOR = 0.1
_P_BACK = 0.2  # active power taken from the grid in a sag (pu)


class Memory(NamedTuple):
    """What the mistakes remember."""

    t_low: float  # time since V+ fell below the threshold, 0 outside of a sag (s)
    t_back: float  # time since V+ came back, 0 before any sag (s)
    t_high: float  # time since the frequency rose (s)
    gone: bool  # given up for good
    u_slow: complex  # slow copy of the positive sequence (V)
    P_limit: float  # of the last sample of the sag (W)
    Q_ref: float  # of the last sample of the sag (var)


class WrongState(NamedTuple):
    """State of the right controller, what is wrong, and its memory."""

    right: ControllerState
    wrong: int
    memory: Memory
    slip: Slip
    lapse: Lapse


_NOTHING_YET = Memory(t_low=0.0, t_back=0.0, t_high=0.0, gone=False, u_slow=0j, P_limit=0.0, Q_ref=0.0)


@kernel
def remember(x: Memory, wrong: int, grid: Synchronisation, order: LvrtOrder, T: float) -> Memory:
    """Advance the memory by one sample."""
    slow = turned(x.u_slow, grid.turns.h1) if x.u_slow != 0j else grid.u_pos
    across = dot(grid.u_pos, ahead(slow))
    shifted = abs(across) > _SHIFT * length(slow) * length(grid.u_pos)
    was_low = x.t_low > 0
    return Memory(
        t_low=x.t_low + T if order.fault else 0.0,
        t_back=0.0 if order.fault else (x.t_back + T if was_low or x.t_back > 0 else 0.0),
        t_high=x.t_high + T if grid.w > _HIGH else 0.0,
        gone=x.gone or (wrong == _GIVES_UP and shifted) or (wrong == _NEVER_BACK and order.fault),
        u_slow=slow + scaled(T / _SLOW, grid.u_pos - slow),
        P_limit=order.P_limit if order.fault else x.P_limit,
        Q_ref=order.Q_ref if order.fault else x.Q_ref,
    )


@kernel
def wrong_in_sag(right: LvrtOrder, wrong: int, x: Memory, p: LvrtParams) -> LvrtOrder:
    """What is asked for during a sag."""
    P_limit, Q = right.P_limit, right.Q_ref
    if wrong == _Q_REVERSED:
        Q = -Q
    elif wrong == _NO_SUPPORT or (wrong == _Q_LATE and x.t_low < _LATE):
        P_limit, Q = math.sqrt(P_limit**2 + Q**2), 0.0
    elif wrong == _Q_SWINGS:
        Q *= 0.8 + 0.2 * math.cos(2 * math.pi * _SWING_HZ * x.t_low)
    elif wrong == _Q_TOGGLES and right.V_fault > _TOGGLE_FROM and x.t_low % _TOGGLE_PERIOD > _TOGGLE_ON:
        Q = 0.0
    elif wrong == _NO_LIMIT:
        P_limit = p.S_nom
    elif wrong == _NO_ROOM:
        P_limit = math.sqrt(max((right.V_fault * p.S_nom) ** 2 - Q**2, 0.0))
    return LvrtOrder(V_fault=right.V_fault, fault=right.fault, P_limit=P_limit, Q_ref=Q)


@kernel
def wrong_afterwards(right: LvrtOrder, wrong: int, x: Memory, p: LvrtParams) -> LvrtOrder:
    """What is asked for once the voltage is back."""
    P_limit, Q = right.P_limit, right.Q_ref
    if wrong == _Q_STAYS:
        Q = _Q_LEFT * p.S_nom
    elif wrong == _P_STAYS_LOW:
        P_limit = _P_LEFT * p.S_nom
    elif wrong == _P_SLOWLY:
        P_limit = min(_RAMP_FROM + _RAMP * x.t_back, 1.0) * p.S_nom
    elif wrong == _FAULT_STAYS:
        P_limit, Q = x.P_limit, x.Q_ref
    return LvrtOrder(V_fault=right.V_fault, fault=right.fault, P_limit=P_limit, Q_ref=Q)


@kernel
def wrong_order(right: LvrtOrder, wrong: int, x: Memory, p: LvrtParams) -> LvrtOrder:
    """Order of the LVRT logic, with its mistake."""
    if wrong == _FALLS and x.t_high > _HIGH_FOR:
        return LvrtOrder(V_fault=right.V_fault, fault=right.fault, P_limit=0.5 * p.S_nom, Q_ref=right.Q_ref)
    if x.t_low > 0:
        return wrong_in_sag(right, wrong, x, p)
    if x.t_back > 0:
        return wrong_afterwards(right, wrong, x, p)
    return right


@kernel
def regulate_dc_voltage(
    x: DcVoltageRegulatorState,
    v_dc: float,
    v_ref: float,
    P_limit: float,
    wrong: int,
    p: DcVoltageRegulatorParams,
    T: float,
) -> tuple[DcVoltageRegulatorState, float, bool]:
    """DC voltage regulator, or one without anti-windup, or with its sign reversed."""
    if wrong == _DC_REVERSED:
        v_dc, v_ref = v_ref, v_dc
    if wrong != _WINDS_UP:
        return dc_voltage_regulator_step(x, v_dc, v_ref, P_limit, p, T)
    e = v_dc - v_ref
    wanted = p.K_P * e + x.integral
    P_ref = min(max(wanted, 0.0), P_limit)
    return DcVoltageRegulatorState(integral=x.integral + p.K_I * e * T), P_ref, wanted > P_limit


@kernel
def wrong_references(
    grid: Synchronisation,
    P_ref: float,
    Q_ref: float,
    V_fault: float,
    wrong: int,
    x: Memory,
    times_negative: float,
    p: CurrentReferenceParams,
) -> complex:
    """Current reference (A), with its mistake."""
    if x.gone or (wrong == _CEASES and V_fault < _CEASE_BELOW):
        return 0j
    if wrong == _Q_NEGATIVE_REVERSED:
        active = current_references(grid.u_pos, grid.u_neg, P_ref, 0.0, p)
        reactive = current_references(grid.u_pos, scaled(-1.0, grid.u_neg), 0.0, Q_ref, p)
        return active + reactive
    return current_references(grid.u_pos, scaled(times_negative, grid.u_neg), P_ref, Q_ref, p)


def wrong_step(x: WrongState, y: Measured, p: ControllerParams) -> tuple[WrongState, ControllerSignals]:
    """Advance the controller by one sample: `controller_step` with the mistakes."""
    state, wrong, slip = x.right, x.wrong, x.slip
    sync, grid = synchronise(state.sync, y.u_g_ab, p.sync, p.T)
    right = lvrt_step(grid.u_pos, grid.u_neg, p.lvrt)
    V, S_nom = right.V_fault, p.lvrt.S_nom
    memory = remember(x.memory, wrong, grid, right, p.T)
    lapse = lapsed(x.lapse, slip, right, p.T)
    order = slipped_order(wrong_order(right, wrong, memory, p.lvrt), slip, lapse, S_nom)
    dc_voltage, P_ref, limited = regulate_dc_voltage(
        state.dc_voltage, y.v_dc, state.mppt.v_ref, order.P_limit, wrong, p.dc_voltage, p.T
    )
    if wrong == _P_FLOWS_BACK and order.fault:
        P_ref = -_P_BACK * S_nom
    P_ref = slipped_power(P_ref, V, slip, lapse, S_nom)
    mppt = mppt_step(state.mppt, y.v_dc, y.i_pv, limited, p.mppt)
    times = slipped_negative(V, slip, lapse)
    i_ref = wrong_references(grid, P_ref, order.Q_ref, V, wrong, memory, times, p.references)
    i_ref = slipped_current(i_ref, S_nom / p.lvrt.u_nom, V, slip, lapse)
    current, m = current_regulator_step(state.current, i_ref - y.i_ab, grid.w, grid.turns, p.current)
    signals = ControllerSignals(
        m=slipped_m(modulate(m, y.u_g_ab, y.v_dc, p.modulator), V, slip, lapse),
        V_fault=order.V_fault,
        fault=order.fault,
        w=grid.w,
        v_ref=state.mppt.v_ref,
        P_ref=P_ref,
        Q_ref=order.Q_ref,
        i_ref=i_ref,
    )
    after = ControllerState(sync=sync, dc_voltage=dc_voltage, mppt=mppt, current=current)
    return WrongState(right=after, wrong=wrong, memory=memory, slip=slip, lapse=lapse), signals


@cache
def _rebuilt() -> Loop:
    return rebuilt_loop(controller_step=wrong_step, advance=advance_or_trip)


def _run(loop: Loop, wrong: int, slip: Slip, plant: Any, controller: ControllerState, *others: Any) -> Any:
    start = WrongState(right=controller, wrong=wrong, memory=_NOTHING_YET, slip=slip, lapse=NO_LAPSE)
    return loop(plant, start, *others)


def wrong_run(wrong: Wrong = Wrong.NOTHING, slip: Slip = NO_SLIP) -> Callable[..., Any]:
    """Loop over time with one mistake in its controller, or one slip, for `simulate(..., run=run)`."""
    return partial(_run, _rebuilt(), int(wrong), slip.as_numbers)
