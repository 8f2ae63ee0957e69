"""The power subsystem: wires array, DC link, inverter, line, grid and protection (Fig. 1)."""

from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.plant.carrier import Pulses, pulses_of
from pvlvrt_compliance.plant.diode_bridge import blocked_dc_current, blocked_flow, blocked_voltage
from pvlvrt_compliance.plant.grid import (
    GridTable,
    HarmonicTable,
    PlaybackTable,
    Source,
    half_step_later,
    or_playback,
    source_at,
    source_voltage,
    step_later,
    with_harmonics,
    zero_or_playback,
    zero_sequence,
    zero_with_harmonics,
)
from pvlvrt_compliance.plant.inverter import limit_modulation, modulated
from pvlvrt_compliance.plant.line import LineParams, LineTable, line_at, line_step, pcc_voltage
from pvlvrt_compliance.plant.protection import (
    NO_TRIP,
    ProtectionParams,
    RelayState,
    UndervoltageCurve,
    relays_step,
    undervoltage_limit,
)
from pvlvrt_compliance.plant.pv_array import PvParams, array_current, diode_voltage
from pvlvrt_compliance.plant.switched_bridge import DeviceParams, PeriodMean, SwitchedFlow, added_to_mean, switched_flow
from pvlvrt_compliance.plant.weather import IrradianceTable, irradiance_at
from pvlvrt_compliance.vectors import scaled


class PlantParams(NamedTuple):
    """Parameters by block, and the plant step. No arrays: they would be reference-counted in every step."""

    pv: PvParams
    line: LineParams
    protection: ProtectionParams
    devices: DeviceParams | None  # of the switched inverter; none: averaged. numba compiles only what is there
    C: float  # DC-link capacitance (F)
    G: float  # irradiance, in units of 1000 W/m2 (-)
    t_breaker: float  # after a trip the breaker parts by then, though current may still flow (s)
    T_S: float  # plant step (s)
    ratio: int  # plant steps in a control period, which is also the carrier's (-)


class PlantTables(NamedTuple):
    """What is looked up in arrays, once a control period."""

    grid: GridTable
    harmonics: HarmonicTable | None
    playback: PlaybackTable | None
    lines: LineTable
    irradiance: IrradianceTable
    undervoltage: UndervoltageCurve


class PlantState(NamedTuple):
    """States by block."""

    i: complex  # inverter current (A)
    v_dc: float  # DC-link voltage (V)
    x_pv: float  # junction voltage of a module (V)
    i_pv: float  # array current (A)
    relay: RelayState
    trip: int  # code of the trip (-)
    t_trip: float  # time since the trip (s)
    closed: bool  # breaker
    blocked: bool  # bridge, by its controller
    mean: PeriodMean  # of the switched bridge; the averaged one leaves it alone


class Flow(NamedTuple):
    """Where a plant step leads line, link and array to, before the relays look."""

    i: complex  # inverter current (A)
    v_dc: float  # DC-link voltage (V)
    x_pv: float  # junction voltage of a module (V)
    i_pv: float  # array current (A)
    u_inv: complex  # inverter voltage, mean over the step (V)
    i_mid: complex  # current, mean over the step (A)


class Observed(NamedTuple):
    """Quantities at an instant, for sensors and recorders."""

    u_ab: complex  # voltage at the PCC (V)
    u0_ab: complex  # voltage of the source, as without the inverter's current (V)
    u_zero: float  # zero-sequence voltage, phase to neutral (V)


@kernel
def is_blocked(x: PlantState) -> bool:
    """Whether no device of the bridge is turned on: by the controller, or since a trip."""
    return x.blocked or x.trip != NO_TRIP


@kernel
def dc_current(x: PlantState, m: complex) -> float:
    """Current that the bridge takes from the DC link (A), averaged over a carrier period, or blocked."""
    return blocked_dc_current(x.i) if is_blocked(x) else modulated(limit_modulation(m), x.i, x.v_dc).i_dc


@kernel
def drop_of(devices: DeviceParams | None) -> float:
    """Voltage across a conducting diode (V)."""
    if devices is None:
        return 0.0
    return devices.v_drop


@kernel
def terminal_voltage(x: PlantState, i: complex, u_inv: complex, e: complex, p: PlantParams) -> complex:
    """Voltage at the PCC (V): the source's own once no current can flow."""
    conducting = x.closed and (not is_blocked(x) or i != 0)
    return pcc_voltage(i, u_inv, e, p.line) if conducting else e


@kernel
def as_at(t: float, k: int, p: PlantParams, tables: PlantTables) -> PlantParams:
    """Parameters as they are at an instant (s) in entry ``k`` of the grid's breakpoints: line and irradiance change."""
    return PlantParams(
        pv=p.pv,
        line=line_at(k, tables.lines),
        protection=p.protection,
        devices=p.devices,
        C=p.C,
        G=irradiance_at(t, tables.irradiance),
        t_breaker=p.t_breaker,
        T_S=p.T_S,
        ratio=p.ratio,
    )


@kernel
def inverter_voltage(x: PlantState, m: complex, e: complex, devices: DeviceParams | None) -> complex:
    """Inverter voltage (V) that sensors see: of the switched bridge the mean over the period that has ended."""
    if is_blocked(x):
        return blocked_voltage(x.i, e, x.v_dc, drop_of(devices))
    if devices is None:
        return modulated(limit_modulation(m), x.i, x.v_dc).u
    return x.mean.u


@kernel
def observe(x: PlantState, m: complex, source: Source, t: float, p: PlantParams, tables: PlantTables) -> Observed:
    """Voltages at the instant ``t`` (s) of a state and its source, as the period begins in which ``m`` acts."""
    e = with_harmonics(source_voltage(source), source, t, tables.harmonics)
    e = or_playback(e, t, tables.playback)
    zero = zero_with_harmonics(zero_sequence(source), source, t, tables.harmonics)
    zero = zero_or_playback(zero, t, tables.playback)
    u_ab = terminal_voltage(x, x.i, inverter_voltage(x, m, e, p.devices), e, p)
    return Observed(u_ab=u_ab, u0_ab=e, u_zero=zero)


@kernel
def averaged_flow(x: PlantState, m: complex, e: complex, p: PlantParams) -> Flow:
    """Advance line, link and array by one plant step under the averaged bridge.

    Second order: DC voltage and source are taken at the middle of the step, the line is solved exactly over it.
    """
    per_farad = p.T_S / p.C
    v_mid = max(x.v_dc + 0.5 * per_farad * (x.i_pv - modulated(m, x.i, x.v_dc).i_dc), 0.0)
    u_inv = modulated(m, x.i, v_mid).u
    i = line_step(x.i, u_inv, e, p.line) if x.closed else 0j
    i_mid = scaled(0.5, x.i + i)
    x_pv = diode_voltage(v_mid, p.G, x.x_pv, p.pv)
    i_pv = array_current(v_mid, x_pv, p.pv)
    v_dc = max(x.v_dc + per_farad * (i_pv - modulated(m, i_mid, v_mid).i_dc), 0.0)
    return Flow(i=i, v_dc=v_dc, x_pv=x_pv, i_pv=i_pv, u_inv=u_inv, i_mid=i_mid)


@kernel
def after_array(x: PlantState, found: SwitchedFlow, p: PlantParams) -> Flow:
    """Flow of a step in which the link has felt the array's current of the step before, corrected by its own."""
    v_mid = 0.5 * (x.v_dc + found.v_dc)
    x_pv = diode_voltage(v_mid, p.G, x.x_pv, p.pv)
    i_pv = array_current(v_mid, x_pv, p.pv)
    v_dc = max(found.v_dc + p.T_S / p.C * (i_pv - x.i_pv), 0.0)
    return Flow(i=found.i, v_dc=v_dc, x_pv=x_pv, i_pv=i_pv, u_inv=found.mean.u, i_mid=found.mean.i)


@kernel
def after_relays(x: PlantState, flow: Flow, mean: PeriodMean, e: complex, u_min: float, p: PlantParams) -> PlantState:
    """State after a plant step: where it has led to, what the relays and the breaker make of it."""
    tripped = x.trip != NO_TRIP
    u_pcc = terminal_voltage(x, flow.i_mid, flow.u_inv, e, p)
    relay, trip = relays_step(x.relay, u_pcc, flow.i, flow.v_dc, u_min, p.protection, p.T_S)
    t_trip = x.t_trip + p.T_S if tripped else 0.0
    return PlantState(
        i=flow.i,
        v_dc=flow.v_dc,
        x_pv=flow.x_pv,
        i_pv=flow.i_pv,
        relay=relay,
        trip=x.trip if tripped else trip,
        t_trip=t_trip,
        closed=x.closed and not (tripped and (flow.i == 0 or t_trip > p.t_breaker)),
        blocked=x.blocked,
        mean=mean,
    )


@kernel
def plant_step(x: PlantState, m: complex, e: complex, u_min: float, p: PlantParams) -> PlantState:
    """Advance by one plant step under a constant modulating signal; ``e`` is the source (V) at its middle."""
    return after_relays(x, averaged_flow(x, m, e, p), x.mean, e, u_min, p)


@kernel
def blocked_plant_step(x: PlantState, e: complex, u_min: float, p: PlantParams) -> PlantState:
    """Advance by one plant step under a blocked bridge; ``e`` is the source (V) at its middle."""
    source = e if x.closed else 0j  # of an open line: no potential turns a diode on
    found = blocked_flow(x.i if x.closed else 0j, x.v_dc, x.i_pv, source, p.line, p.C, p.T_S, drop_of(p.devices))
    return after_relays(x, after_array(x, found, p), x.mean, e, u_min, p)


@kernel
def switched_plant_step(
    x: PlantState, pulses: Pulses, n: int, e: complex, u_min: float, p: PlantParams, devices: DeviceParams
) -> PlantState:
    """Advance by plant step ``n`` of a carrier period; ``e`` is the source (V) at the middle of the step.

    Second order: the link first feels the array's current of the step before, which is then corrected by its own.
    """
    found = switched_flow(x.i, x.v_dc, x.i_pv, e, n, pulses, p.line, p.C, p.T_S, devices)
    return after_relays(x, after_array(x, found, p), added_to_mean(x.mean, found.mean, n, p.ratio), e, u_min, p)


@kernel
def pulses_if_switched(m: complex, period: float, devices: DeviceParams | None) -> Pulses | None:
    """Commands of a carrier period of this length (s); none for the averaged inverter."""
    if devices is None:
        return None
    return pulses_of(m, period)


@kernel
def either_plant_step(
    x: PlantState,
    m: complex,
    pulses: Pulses | None,
    n: int,
    e: complex,
    u_min: float,
    p: PlantParams,
    devices: DeviceParams | None,
) -> PlantState:
    """Advance by plant step ``n`` of a period: switched where there are devices and the bridge is not blocked."""
    if is_blocked(x):
        return blocked_plant_step(x, e, u_min, p)
    if devices is None or pulses is None:
        return plant_step(x, m, e, u_min, p)
    return switched_plant_step(x, pulses, n, e, u_min, p, devices)


@kernel
def advance(x: PlantState, m: complex, source: Source, t: float, p: PlantParams, tables: PlantTables) -> PlantState:
    """Advance by one control period under the modulating signal given for it.

    ``source`` and ``p`` are the grid and the parameters at the beginning, the instant ``t`` (s). A breakpoint within
    the period takes effect in the plant step whose middle it precedes; the line and the irradiance change with the
    next period, so that what follows from them alone is computed once a period.
    """
    m = limit_modulation(m)
    u_min = undervoltage_limit(x.relay, p.protection, tables.undervoltage)
    pulses = pulses_if_switched(m, p.ratio * p.T_S, p.devices)
    source = half_step_later(source)
    for n in range(p.ratio):
        t_mid = t + (n + 0.5) * p.T_S
        if n > 0:
            source = step_later(source)
        if t_mid >= source.t_end:
            source = source_at(t_mid, source.k, tables.grid)
        # Tables, if any, go no further than this: passing them on costs more than a whole step.
        e = with_harmonics(source_voltage(source), source, t_mid, tables.harmonics)
        e = or_playback(e, t_mid, tables.playback)
        x = either_plant_step(x, m, pulses, n, e, u_min, p, p.devices)
    return x
