"""The disturbance that a scenario asks for."""

import cmath
import math
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from itertools import pairwise

from pvlvrt_compliance.disturbance.model import (
    Disturbance,
    Fact,
    Jump,
    Moved,
    NormalVoltage,
    Step,
    Stretch,
    Voltage,
    kind_of,
)
from pvlvrt_compliance.disturbance.words import events_of, facts_of, in_words, state_in_words, stretches_in_words
from pvlvrt_compliance.scenario.events import FrequencyRamp, FrequencyStep, Harmonic, PhaseJump, Recording
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.timeline import Entry, entries, irradiance_points, sag_spans
from pvlvrt_compliance.space_vectors import Sequences, fortescue, phases

Given = Disturbance | Scenario
"""What the grid did, or what it was asked for."""

_SAME_PU = 1e-9


def disturbance_asked(scenario: Scenario, normal: NormalVoltage) -> Disturbance:
    """What the grid is asked to do in a scenario.

    Parameters
    ----------
    scenario : Scenario
        Its times count from the start of the record.
    normal : NormalVoltage
        What is a sag or a swell, and what is neither.
    """
    table, events = entries(scenario), events_of(scenario)
    steps = _steps(scenario, table)
    voltage_steps_s = [step.at_s for step in steps if "voltage" in step.moved]
    irradiance = irradiance_points(scenario)
    return Disturbance(
        start_s=scenario.start_s,
        clear_s=scenario.clear_s,
        end_s=max((scenario.clear_s, *voltage_steps_s)),
        record_end_s=scenario.end_s,
        normal=normal,
        steps=steps,
        jumps=tuple(_jumps(table, [step.at_s for step in steps if "angle" in step.moved])),
        stretches=tuple(_stretches(scenario, table, [step.at_s for step in steps], normal, events)),
        frequency_moves=any(isinstance(event, FrequencyStep | FrequencyRamp | Recording) for event in scenario.events),
        irradiance_w_m2=(irradiance[0][1], irradiance[-1][1]),
        in_words=in_words(scenario, events),
        facts=tuple(facts_of(scenario, events)),
    )


def as_disturbance(given: Given, normal: NormalVoltage) -> Disturbance:
    """A disturbance as it is, or what a scenario asks for."""
    return given if isinstance(given, Disturbance) else disturbance_asked(given, normal)


def _steps(scenario: Scenario, table: list[Entry]) -> tuple[Step, ...]:
    moved: dict[float, set[Moved]] = {}
    for at_s, what in _moves(scenario, table):
        moved.setdefault(at_s, set()).add(what)
    return tuple(Step(at_s=at_s, moved=tuple(sorted(moved[at_s]))) for at_s in sorted(moved))


def _moves(scenario: Scenario, table: list[Entry]) -> Iterator[tuple[float, Moved]]:
    for before, after in pairwise(table):
        if _voltage_moves(before, after):
            yield after.t_s, "voltage"
        if _frequency_moves(before, after):
            yield after.t_s, "frequency"
        if (before.scr, before.xr) != (after.scr, after.xr):
            yield after.t_s, "strength"
    yield from ((at_s, "angle") for at_s in _angle_steps_s(scenario))
    for (begin_s, first), (end_s, last) in pairwise(irradiance_points(scenario)):
        if first != last:
            yield begin_s, "irradiance"
            yield end_s, "irradiance"
    for event in scenario.events:
        if isinstance(event, Recording):
            yield scenario.start_s + event.t_s, "recording"
        if isinstance(event, Harmonic) and event.t_s is not None:
            yield scenario.start_s + event.t_s, "harmonics"
            if event.duration_s is not None:
                yield scenario.start_s + event.t_s + event.duration_s, "harmonics"


def _angle_steps_s(scenario: Scenario) -> set[float]:
    """Instants at which an angle of the voltage asked for is meant to jump."""
    start_s = scenario.start_s
    jumps = {start_s + event.t_s for event in scenario.events if isinstance(event, PhaseJump) and event.angle_deg}
    turns = {t for span in sag_spans(scenario) if span.item.angle_deg for t in (span.begin_s, span.end_s)}
    return jumps | turns


def _voltage_moves(before: Entry, after: Entry) -> bool:
    arrived = _sequences_at(before, after.t_s)
    return any(abs(u - v) > _SAME_PU for u, v in zip(arrived, after.sequences_pu, strict=True)) or any(
        abs(slope - rate) > _SAME_PU for slope, rate in zip(before.slope_pu_s, after.slope_pu_s, strict=True)
    )


def _frequency_moves(before: Entry, after: Entry) -> bool:
    arrived_hz = before.frequency_hz + before.rocof_hz_s * (after.t_s - before.t_s)
    return not math.isclose(arrived_hz, after.frequency_hz) or before.rocof_hz_s != after.rocof_hz_s


def _sequences_at(entry: Entry, t_s: float) -> Sequences:
    dt = t_s - entry.t_s
    return Sequences(*(u + slope * dt for u, slope in zip(entry.sequences_pu, entry.slope_pu_s, strict=True)))


def _jumps(table: list[Entry], instants_s: Sequence[float]) -> Iterator[Jump]:
    place = {entry.t_s: k for k, entry in enumerate(table)}
    for at_s in instants_s:
        before, after = table[place[at_s] - 1], table[place[at_s]]
        dt = at_s - before.t_s
        turned = 2 * math.pi * (before.frequency_hz * dt + 0.5 * before.rocof_hz_s * dt**2)
        turn = cmath.rect(1, after.angle_rad - before.angle_rad - turned)
        last = phases(*_sequences_at(before, at_s))
        then = [turn * u for u in phases(*after.sequences_pu)]
        of_phases = [math.degrees(cmath.phase(b * a.conjugate())) for a, b in zip(last, then, strict=True)]
        positive = complex(fortescue(*then)[0]) * complex(fortescue(*last)[0]).conjugate()
        yield Jump(at_s=at_s, positive_deg=math.degrees(cmath.phase(positive)), phase_deg=max(of_phases, key=abs))


def _stretches(
    scenario: Scenario, table: list[Entry], steps_s: list[float], normal: NormalVoltage, events: Sequence[Fact]
) -> Iterator[Stretch]:
    last_s = max([scenario.end_s, *steps_s])
    bounds = list(dict.fromkeys([min([0.0, *steps_s]), *steps_s, last_s]))
    instants = [entry.t_s for entry in table]
    irradiance = _Irradiance(irradiance_points(scenario))
    told = stretches_in_words(scenario, events, bounds[:-1])
    played_from_s = _played_from_s(scenario)
    for (begin_s, end_s), in_words_of_what_begins in zip(pairwise(bounds), told, strict=True):
        entry = table[bisect_right(instants, begin_s) - 1]
        first = _voltage(_sequences_at(entry, begin_s))
        last = _voltage(_sequences_at(entry, end_s)) if any(entry.slope_pu_s) else None
        frequency_hz = entry.frequency_hz + entry.rocof_hz_s * (begin_s - entry.t_s)
        kind = kind_of(normal, first, last)
        other_hz = None if math.isclose(frequency_hz, scenario.frequency_hz) else frequency_hz
        ramps: tuple[tuple[Moved, bool], ...] = (
            ("voltage", any(entry.slope_pu_s)),
            ("frequency", bool(entry.rocof_hz_s)),
            ("irradiance", irradiance.moves_between(begin_s, end_s)),
            ("recording", played_from_s <= begin_s),
        )
        yield Stretch(
            begin_s=begin_s,
            end_s=end_s,
            kind=kind,
            voltage=first,
            voltage_at_end=last,
            frequency_hz=frequency_hz,
            rocof_hz_s=entry.rocof_hz_s,
            irradiance_w_m2=irradiance.at(begin_s),
            ramps=tuple(what for what, moves in ramps if moves),
            in_words=in_words_of_what_begins or state_in_words(kind, first, last, other_hz),
        )


def _played_from_s(scenario: Scenario) -> float:
    """From when on (s) a recording takes the place of the source, which may hold anything."""
    begins_s = (scenario.start_s + event.t_s for event in scenario.events if isinstance(event, Recording))
    return min(begins_s, default=math.inf)


class _Irradiance:
    """Points (s, W/m2) in order of time, joined by straight lines; of two at one instant the later counts."""

    def __init__(self, points: Sequence[tuple[float, float]]) -> None:
        self._points = points
        self._instants_s = [t for t, _ in points]
        self._ramps_s = [(t, until_s) for (t, first), (until_s, last) in pairwise(points) if first != last]
        self._ends_s = [until_s for _, until_s in self._ramps_s]

    def at(self, t_s: float) -> float:
        """Irradiance at an instant (W/m2)."""
        k = max(bisect_right(self._instants_s, t_s), 1)
        (begin_s, first), (end_s, last) = self._points[k - 1], self._points[min(k, len(self._points) - 1)]
        return first if end_s <= begin_s else first + (last - first) * (t_s - begin_s) / (end_s - begin_s)

    def moves_between(self, begin_s: float, end_s: float) -> bool:
        """Whether it moves anywhere between two instants (s)."""
        k = bisect_right(self._ends_s, begin_s)
        return k < len(self._ramps_s) and self._ramps_s[k][0] < end_s


def _voltage(sequences: Sequences) -> Voltage:
    positive, negative, zero = (abs(part) for part in sequences)
    return Voltage(positive_pu=positive, negative_pu=negative, zero_pu=zero)
