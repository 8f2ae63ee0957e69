"""What the grid did, in words: what a scenario asked of grid and weather, and the state that a stretch is in."""

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from typing import Any

from pvlvrt_compliance.disturbance.model import Fact, Kind, Voltage
from pvlvrt_compliance.scenario.events import (
    Event,
    FrequencyRamp,
    FrequencyStep,
    FurtherSag,
    GridStrength,
    Harmonic,
    Irradiance,
    PhaseJump,
    Recording,
    VoltageProfile,
)
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.spans import last_begun
from pvlvrt_compliance.scenario.timeline import sag_spans

NO_DISTURBANCE = "no disturbance"

_AN_INSTANT_S = 1e-9  # what lies nearer is at the same time


def state_in_words(kind: Kind, first: Voltage, last: Voltage | None = None, other_hz: float | None = None) -> str:
    """What holds in a stretch in which nothing begins: its voltage, and a frequency other than the usual one (Hz)."""
    at = "" if other_hz is None else f" at {other_hz:.6g} Hz"
    if kind == "normal":
        return f"normal voltage{at}" if at else "normal grid"
    positive, negative = f"V+ {first.positive_pu:.3f}", f"V- {first.negative_pu:.3f}"
    if last is not None:
        positive, negative = f"{positive} to {last.positive_pu:.3f}", f"{negative} to {last.negative_pu:.3f}"
    return f"{kind}: {positive} pu, {negative} pu{at}"


def events_of(scenario: Scenario) -> tuple[Fact, ...]:
    """Events besides the sag, each as what there is to say of it."""
    return tuple(map(_event, scenario.events))


def in_words(scenario: Scenario, events: Sequence[Fact]) -> str:
    """Sag and events (`events_of`) in one line."""
    sag = [describe_sag(scenario.sag)] if _is_something(scenario.sag) else []
    return "; ".join([*sag, *map(_in_a_line, events)]) or NO_DISTURBANCE


def facts_of(scenario: Scenario, events: Sequence[Fact]) -> Iterator[Fact]:
    """What there is to know of a scenario, one thing a fact: sag and events (`events_of`), then grid and weather."""
    if _is_something(scenario.sag) or not scenario.events:
        yield Fact(name="turn" if _is_turn(scenario.sag) else "sag", text=describe_sag(scenario.sag))
    yield from events
    yield Fact(name="duration", text=_seconds(scenario.duration_s))
    yield Fact(name="point on wave", text=f"{scenario.point_on_wave_deg:.6g} °")
    yield Fact(name="grid frequency", text=f"{scenario.frequency_hz:.6g} Hz")
    yield Fact(name="grid", text=_grid(scenario.scr, scenario.xr))
    if scenario.vector_group is not None:
        yield Fact(name="beyond a transformer", text=scenario.vector_group)
    yield Fact(name="irradiance", text=f"{scenario.irradiance_w_m2:.6g} W/m²")
    yield Fact(name="cell temperature", text=f"{scenario.cell_temperature_c:.6g} °C")
    if scenario.reactive_power_pu:
        yield Fact(name="reactive power set", text=f"{scenario.reactive_power_pu:.6g} pu")
    yield Fact(name="record before the start", text=_seconds(scenario.before_s))
    yield Fact(name="record after clearing", text=_seconds(scenario.after_s))


def describe_sag(sag: Sag) -> str:
    """Name depth, phases and kind of a sag, and what is left of the voltage."""
    where = _phases(sag.phases)
    turned = f", turned by {sag.angle_deg:+g} °" if sag.angle_deg else ""
    if sag.depth == 0:
        return f"{where}{turned}" if turned else "none"
    lost, left = f"{100 * sag.depth:.6g} %", f"{100 * (1 - sag.depth):.4g} % left"
    if sag.type:
        return f"type {sag.type}, {lost}, {left}"
    if sag.two_phase:
        return f"{lost} of the line-to-line voltage {sag.phases}, {left}"
    return f"{lost} in {where}, {left}{turned}"


def stretches_in_words(scenario: Scenario, events: Sequence[Fact], begins_s: Sequence[float]) -> Iterator[str]:
    """Sag that holds from each instant of the record on (s, in order), and events that begin there; empty without.

    ``events`` are those of `events_of`.
    """
    sags = last_begun([span for span in sag_spans(scenario) if _is_something(span.item)], begins_s)
    others = [(k, event) for k, event in enumerate(scenario.events) if not isinstance(event, FurtherSag)]
    begun = sorted((t, k) for k, event in others if (t := _begins_s(event)) is not None)
    for t_s, sag in zip(begins_s, sags, strict=True):
        at_s = t_s - scenario.start_s
        here = begun[bisect_left(begun, (at_s - _AN_INSTANT_S,)) : bisect_left(begun, (at_s + _AN_INSTANT_S,))]
        facts = [events[k] for k in sorted(k for _, k in here)]
        yield "; ".join([*([] if sag is None else [describe_sag(sag)]), *map(_in_a_line, facts)])


def _in_a_line(fact: Fact) -> str:
    return f"{fact.name} {fact.text}"


def _begins_s(event: Event) -> float | None:
    """When an event begins (s, from the start of the test), None of one that is there from the beginning."""
    return event.points[0][0] if isinstance(event, VoltageProfile) else event.t_s


def _is_something(sag: Sag) -> bool:
    return sag.depth > 0 or _is_turn(sag)


def _is_turn(sag: Sag) -> bool:
    return sag.depth == 0 and sag.angle_deg != 0


def _phases(phases: str) -> str:
    return "all three phases" if phases == "abc" else f"phase{'s' * (len(phases) > 1)} {' and '.join(phases)}"


def _grid(scr: float | None, xr: float) -> str:
    return "stiff: the source at the terminals" if scr is None else f"short-circuit ratio {scr:g}, X/R {xr:g}"


def _event(event: Any) -> Fact:
    """An event besides the sag; instants count from the start of the test."""
    match event:
        case FurtherSag():
            name, text = "further sag", f"{describe_sag(event.sag)}, for {_seconds(event.duration_s)}"
        case VoltageProfile():
            return Fact(name="voltage profile", text="; ".join(_along(event.points)))
        case PhaseJump():
            name, text = "phase jump", f"all phases by {event.angle_deg:+g} °"
        case FrequencyStep():
            name, text = "frequency step", f"to {event.to_hz:g} Hz"
        case FrequencyRamp():
            name, text = "frequency ramp", f"{event.rate_hz_s:+g} Hz/s for {_seconds(event.duration_s)}"
        case GridStrength():
            name, text = "grid strength", _grid(event.scr, event.xr)
        case Harmonic():
            length = "" if event.duration_s is None else f" for {_seconds(event.duration_s)}"
            name = "harmonic"
            text = f"order {event.order}, {100 * event.amplitude_pu:g} %, {event.natural_sequence} sequence{length}"
        case Irradiance():
            ramp = f" within {_seconds(event.ramp_s)}" if event.ramp_s else ""
            name, text = "irradiance", f"to {event.to_w_m2:g} W/m²{ramp}"
        case Recording():
            name, text = "recording", f"{event.file}, channels {', '.join(event.channels)}"
    return Fact(name=name, text=text if event.t_s is None else f"{text}, at {event.t_s:g} s")


def _along(points: Sequence[tuple[float, float]]) -> Iterator[str]:
    """Steps and ramps of a voltage profile, each once; a level that holds is not said again."""
    before_s, before_pu = None, 1.0
    for t_s, u_pu in points:
        if u_pu != before_pu:
            step = before_s is None or t_s == before_s
            yield f"{u_pu:g} pu from {t_s:g} s" if step else f"ramp from {before_s:g} s to {u_pu:g} pu at {t_s:g} s"
        before_s, before_pu = t_s, u_pu


def _seconds(value_s: float) -> str:
    return f"{value_s:.3f} s"
