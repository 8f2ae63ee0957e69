"""Grid, transformer, weather and relays: what they do, as they run and in closed form."""

import math
from collections.abc import Callable, Iterable
from functools import cache

import numba
import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import in_python
from pvlvrt_compliance.plant.grid import source_at, source_voltage, step_later, zero_sequence
from pvlvrt_compliance.plant.protection import NO_TRIP, exceeds, relays_at_rest, relays_step, undervoltage_limit
from pvlvrt_compliance.plant.weather import irradiance_at
from pvlvrt_compliance.scenario.events import Irradiance, PhaseJump
from pvlvrt_compliance.scenario.sag import Sag, Type, through_transformer
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import plant_tables
from pvlvrt_compliance.space_vectors import phases
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.vectors import phases_of
from validation.blocks.power import nominal_plant
from validation.blocks.svg import Axes, Curve, Figure, curve
from validation.simulator.evidence import Row, at_most, shown
from validation.simulator.loops import W

_PHASE_C = Scenario(
    sag=Sag(depth=0.9, phases="c"), duration_s=0.2, events=(PhaseJump(t_s=0.02, angle_deg=30.0),), point_on_wave_deg=0
)
_TYPES: tuple[Type, ...] = ("B", "C", "D", "E", "F", "G")


def source_phases(t_s: Iterable[float], scenario: Scenario) -> NDArray[np.float64]:
    """Phase voltages of the source (V) at instants of the record (s), as the plant's tables give them."""
    table, found = plant_tables(Parameters(), scenario).grid, []
    for t in t_s:
        x = in_python(source_at)(t, 0, table)
        u, zero = in_python(phases_of)(in_python(source_voltage)(x)), in_python(zero_sequence)(x)
        found.append([part + zero for part in u])
    return np.array(found).T


def asked_phases(t_s: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same of the scenario above in closed form: phasors of the sag at the angle of the wave."""
    since = t_s - _PHASE_C.start_s
    angle = W * since + np.where(since >= 0.02 - 1e-9, math.radians(30), 0.0)
    healthy = np.array(Sag(depth=0).phasors_pu())[:, np.newaxis]
    phasors = np.where(since >= -1e-9, np.array(_PHASE_C.sag.phasors_pu())[:, np.newaxis], healthy)
    wave: NDArray[np.float64] = Nominal().phase_voltage_peak_v * (phasors * np.exp(1j * angle)).real
    return wave


def grid_rows() -> tuple[Row, ...]:
    """Turning from step to step beside the angle looked up, and phases beside those asked for."""
    p, table = nominal_plant(), plant_tables(Parameters(), _PHASE_C).grid
    x, turned = in_python(source_at)(0.1, 0, table), 0.0
    for n in range(1, p.ratio + 1):
        x = in_python(step_later)(x)
        turned = max(turned, abs(x.turn - in_python(source_at)(0.1 + n * p.T_S, 0, table).turn))
    t = np.arange(0.2905, 0.35, 0.001)
    worst = np.abs(source_phases(t, _PHASE_C) - asked_phases(t)).max() / Nominal().phase_voltage_peak_v
    return (
        at_most("turned eight times by a step, difference from the angle looked up", turned, 1e-8, floor=1e-9),
        at_most("phase voltages, difference from the phasors of the sag", float(worst), 1e-8, "pu", floor=1e-9),
        shown("length of the nominal voltage vector, √3 · 230 V", Nominal().voltage_ab_v, "V"),
        shown("base impedance: that of a grid with SCR 1", Nominal().impedance_ohm, "Ω"),
        shown(
            "inductance of a grid with SCR 20, X/R 10",
            1e6 * Nominal().impedance_ohm / 20 / math.hypot(1, 0.1) / W,
            "µH",
        ),
    )


def grid_figure() -> Figure:
    """Sag of a phase, and a jump of the angle."""
    t, few = np.linspace(0.29, 0.345, 166), np.arange(0.2905, 0.345, 0.0015)
    exact, found, shift = asked_phases(t), source_phases(few, _PHASE_C), _PHASE_C.start_s
    curves = [curve(f"u_{name}", 1e3 * (t - shift), exact[k]) for k, name in enumerate("abc")]
    for k in range(3):
        said = "" if k else "as it runs"
        curves.append(curve(said, 1e3 * (few - shift), found[k], dots=True, like=k))
    title = "Source: phase c to 10 % at 0 ms, all phases 30° ahead at 20 ms"
    axes = Axes("time from the start of the sag (ms)", "phase to neutral (V)", tuple(curves))
    return Figure("plant/figures/grid.svg", title, (axes,))


def transformer_rows() -> tuple[Row, ...]:
    """Types beyond a delta-star transformer, by what Bollen's table says of them."""
    rows = []
    for seen, beyond, V in (("C", "B", (1 + 2 * 0.5) / 3), ("D", "C", 0.5), ("F", "E", 0.5)):
        sag = Sag(depth=0.5, type=beyond).sequences_pu()
        found = through_transformer(sag, "Dyn11")
        expected = Sag(depth=1 - V, type=seen).sequences_pu()
        said = f"type {beyond}, V = 0.5, through Dyn11: V⁺, as type {seen} with V = {V:.3f}"
        rows.append(Row(said, abs(found.positive), abs(expected.positive), 1e-12, "pu"))
        rows.append(Row("its V⁻", abs(found.negative), abs(expected.negative), 1e-12, "pu"))
        rows.append(at_most("its zero sequence", abs(found.zero), 1e-12, "pu", floor=1e-14))
    return tuple(rows)


def transformer_figure() -> Figure:
    """Phasors on both sides of a delta-star transformer."""
    panels = []
    for beyond in ("B", "C"):
        sag = Sag(depth=0.5, type=beyond)
        near = phases(*through_transformer(sag.sequences_pu(), "Dyn11"))
        curves: list[Curve] = []
        for k, name in enumerate("abc"):
            for said, z, dashed in (
                (f"{name} beyond", sag.phasors_pu()[k], True),
                (f"{name} at the inverter", near[k], False),
            ):
                style = {"like": len(curves) - 1} if not dashed else {}
                curves.append(curve(said, [0, z.real], [0, z.imag], dashed=dashed, **style))
        circle = np.exp(1j * np.linspace(0, 2 * math.pi, 61))
        curves.append(curve("", circle.real, circle.imag, dashed=True, like=None))
        panels.append(Axes(f"type {beyond}, V = 0.5, Dyn11 (pu)", "pu", tuple(curves), equal=True))
    title = "Phasors of a sag beyond a delta-star transformer, and as they arrive at the inverter"
    return Figure("plant/figures/transformer.svg", title, tuple(panels))


def shadow() -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Time (s), irradiance as it runs and by numpy (W/m2), of a cloud that comes quickly and goes slowly."""
    events = (Irradiance(t_s=0.1, to_w_m2=300.0, ramp_s=0.05), Irradiance(t_s=0.4, to_w_m2=900.0, ramp_s=0.3))
    scenario = Scenario(sag=Sag(depth=0), duration_s=0.5, events=events)
    table, t = plant_tables(Parameters(), scenario).irradiance, np.linspace(0.3, 1.2, 46)
    found = np.array([1000 * in_python(irradiance_at)(float(x), table) for x in t])
    return t - scenario.start_s, found, np.interp(t - scenario.start_s, [0.1, 0.15, 0.4, 0.7], [1000, 300, 300, 900])


def weather_rows() -> tuple[Row, ...]:
    """Irradiance along ramps."""
    _, found, expected = shadow()
    return (
        at_most(
            "irradiance, difference from straight lines", float(np.abs(found - expected).max()), 1e-9, "W/m²", 1e-9
        ),
    )


def weather_figure() -> Figure:
    """A cloud."""
    t, found, expected = shadow()
    fine = np.array([0, 0.1, 0.15, 0.4, 0.7, 0.9])
    line = np.interp(fine, t, expected)
    line[1:5] = (1000, 300, 300, 900)
    curves = (curve("asked for", fine, line), curve("as it runs", t, found, dots=True, like=0))
    panel = Axes("time from the start of the sag (s)", "irradiance (W/m²)", curves)
    return Figure(
        "plant/figures/weather.svg", "Irradiance under a cloud that comes in 50 ms and goes in 300 ms", (panel,)
    )


@numba.njit(error_model="numpy")
def _time_of_trip(x, u, w, p, curve, T_S, most):  # type: ignore[no-untyped-def]
    turn, by = u, np.exp(1j * w * T_S)
    for n in range(most):
        u_min = undervoltage_limit(x, p, curve)
        x, trip = relays_step(x, turn, 0j, 800.0, u_min, p, T_S)
        if trip != NO_TRIP:
            return n * T_S
        turn = turn * by
    return -1.0


@cache
def trip_time(residual_pu: float, frequency_hz: float = 50.0) -> float:
    """How long (s) after a step to this balanced voltage or frequency the relays trip; not a number: never in 3 s."""
    p, tables = nominal_plant(), plant_tables(Parameters(), _PHASE_C)
    relay = relays_at_rest(complex(p.protection.u_nom), W)
    u, w = complex(residual_pu * p.protection.u_nom), 2 * math.pi * frequency_hz
    t = float(_time_of_trip(relay, u, w, p.protection, tables.undervoltage, p.T_S, round(3 / p.T_S)))
    return t if t >= 0 else math.nan


def protection_rows() -> tuple[Row, ...]:
    """When each relay trips."""
    p = nominal_plant().protection
    curve_of = Parameters().protection.undervoltage_curve
    at_half = float(np.interp(0.5, [u for _, u in curve_of[1:]], [t for t, _ in curve_of[1:]]))
    peak = math.sqrt(1.5)  # length of the vector by the largest phase of a balanced current at its peak
    low, high = 1.5, 2.5
    for _ in range(50):
        middle = 0.5 * (low + high)
        beyond = in_python(exceeds)(complex(peak * middle * Nominal().phase_current_peak_a), p.i_max)
        low, high = (low, middle) if beyond else (middle, high)
    settle = trip_time(1.0, 56.0) - Parameters().protection.frequency_delay_s
    return (
        Row("overcurrent: a balanced current trips above", low, 2.0, 1e-6, "pu peak"),
        shown("the same", p.i_max, "A"),
        Row("undervoltage: 0.5 pu trips after", trip_time(0.5), at_half + p.curve_delay, 0.01, "s"),
        Row("undervoltage: 0.0 pu trips after", trip_time(0.0), 0.15 + p.curve_delay, 0.01, "s"),
        shown("frequency: a step to 56 Hz trips after", trip_time(1.0, 56.0), "s"),
        shown("of that, to measure it", 1e3 * settle, "ms"),
        Row("frequency: a step to 54 Hz trips (1: never)", float(math.isnan(trip_time(1.0, 54.0))), 1.0, 0.0),
        shown("bandwidth of its filter, 1/(2π · 20 ms)", 1 / (2 * math.pi * 0.02), "Hz"),
    )


def protection_figure() -> Figure:
    """Times to trip beside the curve."""
    t, u = np.array(Parameters().protection.undervoltage_curve).T
    delay = nominal_plant().protection.curve_delay
    residuals = np.array([0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.84])
    times = [trip_time(float(r)) for r in residuals]
    voltage = (
        curve("ridden through above", [*t, 1.8], [*u, u[-1]]),
        curve("curve as the relay has it", [*(t + delay), 1.8], [*u, u[-1]], dashed=True, like=0),
        curve("trips, as it runs", times, residuals, dots=True),
    )
    hz = np.array([40.0, 42.0, 44.0, 44.8, 55.2, 56.0, 58.0, 60.0])
    frequency = (
        curve("trips, as it runs", hz, [1e3 * trip_time(1.0, float(f)) for f in hz], dots=True, like=None),
        curve("t_frequency", [40, 60], [200, 200], dashed=True),
    )
    panels = (
        Axes("time since the voltage fell (s)", "V⁺ (pu)", voltage, share=1.3),
        Axes("frequency after a step (Hz)", "time to the trip (ms)", frequency),
    )
    return Figure("plant/figures/protection.svg", "When the undervoltage and the frequency relay trip", panels)


ROWS: dict[str, Callable[[], tuple[Row, ...]]] = {
    "grid": grid_rows,
    "transformer": transformer_rows,
    "weather": weather_rows,
    "protection": protection_rows,
}
FIGURES: tuple[Callable[[], Figure], ...] = (grid_figure, transformer_figure, weather_figure, protection_figure)
