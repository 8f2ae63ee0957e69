"""A scenario as breakpoints: between two of them, voltages and frequency move along straight lines."""

import math
from typing import NamedTuple

from pvlvrt_compliance.scenario.events import (
    FrequencyRamp,
    FrequencyStep,
    FurtherSag,
    GridStrength,
    Harmonic,
    Irradiance,
    PhaseJump,
    VoltageProfile,
)
from pvlvrt_compliance.scenario.sag import through_transformer
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.space_vectors import Sequences

LONG_AGO_S = -1e3
"""First breakpoint: before any run, and near enough for the angle there to be exact."""


class Entry(NamedTuple):
    """The grid from one breakpoint on. Times from the start of the record."""

    t_s: float
    angle_rad: float  # of phase a's healthy fundamental, at t_s
    frequency_hz: float  # at t_s
    rocof_hz_s: float
    sequences_pu: Sequences  # at t_s
    slope_pu_s: Sequences
    scr: float | None
    xr: float


def entries(scenario: Scenario) -> list[Entry]:
    """Breakpoints of the grid in order of time; the first lies before any run."""
    times = _breakpoints(scenario)
    frequencies = [_frequency(scenario, t) for t in times]
    angles = [0.0]
    for index in range(1, len(times)):
        f, rate = frequencies[index - 1]
        dt = times[index] - times[index - 1]
        angles.append(angles[-1] + 2 * math.pi * (f * dt + 0.5 * rate * dt**2) + _jump_at(scenario, times[index]))
    at_start = times.index(scenario.start_s)
    anchor = math.radians(scenario.point_on_wave_deg) + _jump_at(scenario, scenario.start_s) - angles[at_start]
    return [
        Entry(
            t,
            math.remainder(angles[k] + anchor, 2 * math.pi),
            *frequencies[k],
            *_voltages(scenario, t, last=k == len(times) - 1),
            *_grid(scenario, t),
        )
        for k, t in enumerate(times)
    ]


def irradiance_points(scenario: Scenario) -> list[tuple[float, float]]:
    """Irradiance as points (s from the start of the record, W/m2) joined by straight lines."""
    points = [(LONG_AGO_S, scenario.irradiance_w_m2)]
    for event in sorted((e for e in scenario.events if isinstance(e, Irradiance)), key=lambda e: e.t_s):
        t = scenario.start_s + event.t_s
        points += [(t, points[-1][1]), (t + event.ramp_s, event.to_w_m2)]
    return points


def busy_stretches(scenario: Scenario) -> list[tuple[float, float]]:
    """When something changes, begin and end (s from the start of the record), an instant ending where it begins.

    A ramp is busy where it begins and where it ends, not between. What a recording holds is not known here.
    """
    instants = {*_breakpoints(scenario), *(t for t, _ in irradiance_points(scenario))} - {LONG_AGO_S}
    for event in scenario.events:
        if isinstance(event, Harmonic) and event.t_s is not None:
            instants.add(scenario.start_s + event.t_s)
        if isinstance(event, Harmonic) and event.duration_s is not None:
            instants.add((LONG_AGO_S if event.t_s is None else scenario.start_s + event.t_s) + event.duration_s)
    return [(t, t) for t in sorted(instants)]


def asked_sequences_pu(scenario: Scenario, t_s: float) -> Sequences:
    """Symmetrical components that the source is asked for at an instant from the start of the record (pu)."""
    factor, _ = _profile(scenario, t_s)
    return Sequences(*(factor * part for part in _sagged(scenario, t_s)))


def _breakpoints(scenario: Scenario) -> list[float]:
    times = {LONG_AGO_S, scenario.start_s, scenario.clear_s}
    for event in scenario.events:
        if isinstance(event, VoltageProfile):
            times.update(scenario.start_s + t for t, _ in event.points)
        elif isinstance(event, FurtherSag | FrequencyRamp):
            times.update((scenario.start_s + event.t_s, scenario.start_s + event.t_s + event.duration_s))
        elif isinstance(event, PhaseJump | FrequencyStep | GridStrength):
            times.add(scenario.start_s + event.t_s)
    return sorted(times)


def _frequency(scenario: Scenario, t: float) -> tuple[float, float]:
    """Frequency (Hz) and its rate of change (Hz/s) from an instant on."""
    f, rate = scenario.frequency_hz, 0.0
    events = (e for e in scenario.events if isinstance(e, FrequencyStep | FrequencyRamp))
    for event in sorted(events, key=lambda e: e.t_s):
        begin = scenario.start_s + event.t_s
        if t < begin:
            break
        if isinstance(event, FrequencyStep):
            f, rate = event.to_hz, 0.0
        else:
            # The end as `_breakpoints` has it: rounding must not let the ramp run on for the whole of the next entry.
            running = t < begin + event.duration_s
            f += event.rate_hz_s * (t - begin if running else event.duration_s)
            rate = event.rate_hz_s if running else 0.0
    return f, rate


def _jump_at(scenario: Scenario, t: float) -> float:
    jumps = (e for e in scenario.events if isinstance(e, PhaseJump) and scenario.start_s + e.t_s == t)
    return math.radians(sum(jump.angle_deg for jump in jumps))


def _sagged(scenario: Scenario, t: float) -> Sequences:
    sags = [(scenario.start_s, scenario.clear_s, scenario.sag)]
    for event in scenario.events:
        if isinstance(event, FurtherSag):
            begin = scenario.start_s + event.t_s
            sags.append((begin, begin + event.duration_s, event.sag))
    holding = [(begin, sag) for begin, end, sag in sags if begin <= t < end]
    if not holding:
        return Sequences(1 + 0j, 0j, 0j)
    sequences = max(reversed(holding), key=lambda item: item[0])[1].sequences_pu()
    return sequences if scenario.vector_group is None else through_transformer(sequences, scenario.vector_group)


def _profile(scenario: Scenario, t: float) -> tuple[float, float]:
    """Factor of the voltage profiles (pu) and its slope (pu/s) from an instant on."""
    factor, slope = 1.0, 0.0
    for event in scenario.events:
        if isinstance(event, VoltageProfile):
            level, rate = _along([(scenario.start_s + at, u) for at, u in event.points], t)
            factor, slope = factor * level, slope * level + factor * rate
    return factor, slope


def _along(points: list[tuple[float, float]], t: float) -> tuple[float, float]:
    """Level and slope of a profile right after an instant: 1 before its first point, the last level held."""
    after = [k for k, (at, _) in enumerate(points) if at > t]
    if len(after) == len(points):
        return 1.0, 0.0
    if not after:
        return points[-1][1], 0.0
    (t_a, u_a), (t_b, u_b) = points[after[0] - 1], points[after[0]]
    slope = (u_b - u_a) / (t_b - t_a)
    return u_a + slope * (t - t_a), slope


def _voltages(scenario: Scenario, t: float, last: bool) -> tuple[Sequences, Sequences]:
    sagged = _sagged(scenario, t)
    factor, slope = _profile(scenario, t)
    slope = 0.0 if last else slope  # nothing moves after the last breakpoint, whatever rounding says
    return Sequences(*(factor * part for part in sagged)), Sequences(*(slope * part for part in sagged))


def _grid(scenario: Scenario, t: float) -> tuple[float | None, float]:
    """Short-circuit ratio and X/R from an instant on."""
    scr, xr = scenario.scr, scenario.xr
    for event in sorted((e for e in scenario.events if isinstance(e, GridStrength)), key=lambda e: e.t_s):
        if scenario.start_s + event.t_s <= t:
            scr, xr = event.scr, event.xr
    return scr, xr
