"""A scenario as breakpoints: between two of them, voltages and frequency move along straight lines."""

import math
from bisect import bisect_right
from collections import deque
from collections.abc import Iterator, Sequence
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
from pvlvrt_compliance.scenario.sag import Sag, through_transformer
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.spans import Span, last_begun
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
    frequencies = list(_frequencies(scenario, times))
    jumps = _jumps(scenario)
    angles = [0.0]
    for index in range(1, len(times)):
        f, rate = frequencies[index - 1]
        dt = times[index] - times[index - 1]
        angles.append(angles[-1] + 2 * math.pi * (f * dt + 0.5 * rate * dt**2) + jumps.get(times[index], 0.0))
    at_start = times.index(scenario.start_s)
    anchor = math.radians(scenario.point_on_wave_deg) + jumps.get(scenario.start_s, 0.0) - angles[at_start]
    voltages, grids = _voltages(scenario, times), _grids(scenario, times)
    return [
        Entry(t, math.remainder(angle + anchor, 2 * math.pi), *frequency, *voltage, *grid)
        for t, angle, frequency, voltage, grid in zip(times, angles, frequencies, voltages, grids, strict=True)
    ]


def irradiance_points(scenario: Scenario) -> list[tuple[float, float]]:
    """Irradiance as points (s from the start of the record, W/m2) in order of time, joined by straight lines.

    A change ends the ramp before it, where it is.
    """
    points = [(LONG_AGO_S, scenario.irradiance_w_m2)]
    for event in sorted((e for e in scenario.events if isinstance(e, Irradiance)), key=lambda e: e.t_s):
        t = scenario.start_s + event.t_s
        (begin_s, first), (end_s, level) = points[-2:] if len(points) > 1 else points * 2
        if t < end_s:
            points.pop()
            level = first + (level - first) * (t - begin_s) / (end_s - begin_s)
        points += [(t, level), (t + event.ramp_s, event.to_w_m2)]
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
    ((factor, _),) = _profiles(scenario, [t_s])
    (sagged,) = _sagged(scenario, [t_s])
    return Sequences(*(factor * part for part in sagged))


def sag_spans(scenario: Scenario) -> list[Span[Sag]]:
    """Begin and end of every sag (s from the start of the record), that of the test first."""
    spans = [Span(scenario.start_s, scenario.clear_s, scenario.sag)]
    for event in scenario.events:
        if isinstance(event, FurtherSag):
            begin_s = scenario.start_s + event.t_s
            spans.append(Span(begin_s, begin_s + event.duration_s, event.sag))
    return spans


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


class _Moving(NamedTuple):
    """What the frequency does from an instant on; a step is a ramp of no length."""

    from_hz: float
    rate_hz_s: float
    begin_s: float
    duration_s: float

    def at(self, t: float) -> tuple[float, float]:
        """Frequency (Hz) and its rate of change (Hz/s)."""
        # The end as `_breakpoints` has it: rounding must not let the ramp run on for the whole of the next entry.
        running = t < self.begin_s + self.duration_s
        moved_hz = self.rate_hz_s * (t - self.begin_s if running else self.duration_s)
        return self.from_hz + moved_hz, self.rate_hz_s if running else 0.0


def _frequencies(scenario: Scenario, times: Sequence[float]) -> Iterator[tuple[float, float]]:
    """Frequency (Hz) and its rate of change (Hz/s) from each instant on: a ramp or step ends the ramp before it."""
    found = [event for event in scenario.events if isinstance(event, FrequencyStep | FrequencyRamp)]
    ahead = deque(sorted(found, key=lambda event: event.t_s))
    now = _Moving(scenario.frequency_hz, 0.0, times[0], 0.0)
    for t in times:
        while ahead and (begin_s := scenario.start_s + ahead[0].t_s) <= t:
            event = ahead.popleft()
            if isinstance(event, FrequencyStep):
                now = _Moving(event.to_hz, 0.0, begin_s, 0.0)
            else:
                now = _Moving(now.at(begin_s)[0], event.rate_hz_s, begin_s, event.duration_s)
        yield now.at(t)


def _jumps(scenario: Scenario) -> dict[float, float]:
    """Jump of the angle (rad) at each instant that has one."""
    jumps_deg: dict[float, float] = {}
    for event in scenario.events:
        if isinstance(event, PhaseJump):
            at_s = scenario.start_s + event.t_s
            jumps_deg[at_s] = jumps_deg.get(at_s, 0.0) + event.angle_deg
    return {at_s: math.radians(angle_deg) for at_s, angle_deg in jumps_deg.items()}


def _sagged(scenario: Scenario, times: Sequence[float]) -> Iterator[Sequences]:
    """Symmetrical components that the sags leave from each instant on (pu)."""
    for sag in last_begun(sag_spans(scenario), times):
        sequences = Sequences(1 + 0j, 0j, 0j) if sag is None else sag.sequences_pu()
        beyond = sag is not None and scenario.vector_group is not None
        yield through_transformer(sequences, str(scenario.vector_group)) if beyond else sequences


def _profiles(scenario: Scenario, times: Sequence[float]) -> Iterator[tuple[float, float]]:
    """Factor of the voltage profiles (pu) and its slope (pu/s) from each instant on.

    A profile that has come to its end is the level that it holds, so that only those under way are looked at.
    """
    events = [event for event in scenario.events if isinstance(event, VoltageProfile)]
    ahead = deque(sorted((_Course(scenario.start_s, k, event) for k, event in enumerate(events)), key=_Course.begins))
    held, under_way = 1.0, list[_Course]()
    for t in times:
        while ahead and ahead[0].times[0] <= t:
            under_way.append(ahead.popleft())
        for course in sorted((course for course in under_way if course.times[-1] <= t), key=_Course.place_of):
            held *= course.levels[-1]
            under_way.remove(course)
        factor, slope = held, 0.0
        for course in sorted(under_way, key=_Course.place_of):
            level, rate = course.at(t)
            factor, slope = factor * level, slope * level + factor * rate
        yield factor, slope


class _Course:
    """A voltage profile, its instants from the start of the record."""

    def __init__(self, start_s: float, place: int, event: VoltageProfile) -> None:
        self.place = place
        self.times = [start_s + at for at, _ in event.points]
        self.levels = [level for _, level in event.points]

    def begins(self) -> float:
        """When its first point is (s)."""
        return self.times[0]

    def place_of(self) -> int:
        """Its place among the profiles."""
        return self.place

    def at(self, t: float) -> tuple[float, float]:
        """Level and slope right after an instant between its first and its last point."""
        k = bisect_right(self.times, t)
        t_a, t_b = self.times[k - 1], self.times[k]
        u_a, u_b = self.levels[k - 1], self.levels[k]
        slope = (u_b - u_a) / (t_b - t_a)
        return u_a + slope * (t - t_a), slope


def _voltages(scenario: Scenario, times: Sequence[float]) -> Iterator[tuple[Sequences, Sequences]]:
    for t, sagged, (factor, slope) in zip(times, _sagged(scenario, times), _profiles(scenario, times), strict=True):
        moving = 0.0 if t == times[-1] else slope  # nothing moves after the last breakpoint, whatever rounding says
        yield Sequences(*(factor * part for part in sagged)), Sequences(*(moving * part for part in sagged))


def _grids(scenario: Scenario, times: Sequence[float]) -> Iterator[tuple[float | None, float]]:
    """Short-circuit ratio and X/R from each instant on."""
    ahead = deque(sorted((e for e in scenario.events if isinstance(e, GridStrength)), key=lambda e: e.t_s))
    scr, xr = scenario.scr, scenario.xr
    for t in times:
        while ahead and scenario.start_s + ahead[0].t_s <= t:
            event = ahead.popleft()
            scr, xr = event.scr, event.xr
        yield scr, xr
