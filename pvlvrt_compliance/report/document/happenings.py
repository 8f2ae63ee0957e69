"""What grid and sun do, a sentence each: sags and events of a scenario, at instants of whatever clock they have."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

from pvlvrt_compliance.report.format import number
from pvlvrt_compliance.report.language import Texts

Table = Mapping[str, Any]
"""A sag or an event, as a scenario has it."""

_MOST_LEVELS = 12
"""Steps and ramps of a voltage profile that are told one by one; the table of voltages has them all."""

_NATURAL_SEQUENCE = ("zero", "positive", "negative")  # of a harmonic, by its order modulo 3

_Move = tuple[float | None, float, float]


def is_something(sag: Table) -> bool:
    """Whether a sag changes the voltage at all."""
    return bool(sag["depth"] > 0 or sag.get("angle_deg"))


def has_instant(event: Table) -> bool:
    """Whether an event has a time that counts from the start of the disturbance."""
    return event.get("t_s") is not None or bool(event.get("points"))


def later(event: Table, by_s: float) -> dict[str, Any]:
    """The same event on a clock that began earlier (s)."""
    moved = dict(event)
    if event.get("t_s") is not None:
        moved["t_s"] = event["t_s"] + by_s
    if event.get("points"):
        moved["points"] = [(t_s + by_s, level) for t_s, level in event["points"]]
    return moved


def sag_words(sag: Table, duration_s: float, texts: Texts) -> str:
    """The sag that a test begins with, for how long (s)."""
    return texts(f"scenario.sag.{_kind_of(sag)}", **_of_sag(sag), duration_s=number(duration_s, "s"))


def event_words(event: Table, texts: Texts) -> Iterator[str]:
    """What happens in an event; a sentence, of a voltage profile one a step or ramp."""
    match event["kind"]:
        case "sag":
            sag = event["sag"]
            kind = _kind_of(sag) if is_something(sag) else "nothing"
            times = {"t_s": number(event["t_s"], "s"), "duration_s": number(event["duration_s"], "s")}
            yield texts(f"scenario.further.{kind}", **_of_sag(sag), **times)
        case "voltage_profile":
            yield from _profile(event["points"], texts)
        case "phase_jump":
            way = "ahead" if event["angle_deg"] >= 0 else "back"
            yield _at(event, texts, f"jump.{way}", angle_deg=plain(abs(event["angle_deg"])))
        case "frequency_step":
            yield _at(event, texts, "frequency_step", hz=plain(event["to_hz"]))
        case "frequency_ramp":
            way = "up" if event["rate_hz_s"] >= 0 else "down"
            rate, length = plain(abs(event["rate_hz_s"])), number(event["duration_s"], "s")
            yield _at(event, texts, f"frequency_ramp.{way}", rate=rate, duration_s=length)
        case "grid_strength":
            yield grid_words(event, texts, "strength", t_s=number(event["t_s"], "s"))
        case "harmonic":
            yield _harmonic(event, texts)
        case "irradiance":
            ramp_s = event.get("ramp_s", 0.0)
            how = {"ramp_s": number(ramp_s, "s")} if ramp_s else {}
            kind = "irradiance.ramp" if ramp_s else "irradiance.step"
            yield _at(event, texts, kind, irradiance=plain(event["to_w_m2"]), **how)
        case "recording":
            yield _at(event, texts, "recording", file=event["file"])
        case other:  # of a later version
            yield texts("scenario.unknown", kind=str(other).replace("_", " "))


def grid_words(of: Table, texts: Texts, key: str, **values: str) -> str:
    """What the grid is behind its terminals."""
    if of.get("scr") is None:
        return texts(f"scenario.{key}.stiff", **values)
    return texts(f"scenario.{key}.impedance", scr=plain(of["scr"]), xr=plain(of["xr"]), **values)


def moves_of(points: Sequence[Sequence[float]]) -> list[_Move]:
    """Steps and ramps of a voltage profile: where a ramp begins (s; None: a step), where it ends, at which level."""
    first: list[Sequence[float]] = [(points[0][0], 1.0)] if points else []
    moves = [(before, after) for before, after in pairwise([*first, *points]) if before[1] != after[1]]
    return [(None if before_s == t_s else before_s, t_s, level) for (before_s, _), (t_s, level) in moves]


def move_words(move: _Move, texts: Texts) -> str:
    """A step or a ramp of the voltage."""
    begin_s, t_s, level = move
    values = {"t_s": number(t_s, "s"), "pu": number(level, "pu")}
    if begin_s is None:
        return texts("scenario.profile.step", **values)
    return texts("scenario.profile.ramp", begin_s=number(begin_s, "s"), **values)


def plain(value: float) -> str:
    """A number as it was given: no more digits than it has."""
    return f"{value:.6g}"


def _kind_of(sag: Table) -> str:
    """Which sentence a sag is told in."""
    if sag.get("type"):
        return "type"
    if sag.get("two_phase"):
        return "isolated"
    phases = {1: "one", 2: "two", 3: "three"}[len(sag["phases"])]
    if not sag.get("angle_deg"):
        return phases
    return f"{phases}_turned" if sag["depth"] > 0 else f"{phases}_turned_alone"


def _of_sag(sag: Table) -> dict[str, str]:
    """Values for the sentence of a sag; each sentence takes those that it has places for."""
    phases = sag["phases"]
    return {
        "lost": plain(100 * sag["depth"]),
        "left": plain(100 * (1 - sag["depth"])),
        "phase": phases[0],
        "second": phases[-1],
        "type": sag.get("type") or "",
        "angle_deg": f"{sag.get('angle_deg', 0.0):+.6g}",
    }


def _at(event: Table, texts: Texts, key: str, **values: str) -> str:
    return texts(f"scenario.{key}", t_s=number(event["t_s"], "s"), **values)


def _harmonic(event: Table, texts: Texts) -> str:
    order = event["order"]
    sequence = event.get("sequence") or _NATURAL_SEQUENCE[order % 3]
    values = {"order": str(order), "percent": plain(100 * event["amplitude_pu"])}
    begin_s, length_s = event.get("t_s"), event.get("duration_s")
    if begin_s is not None:
        values["t_s"] = number(begin_s, "s")
    if length_s is not None:
        values["duration_s"] = number(length_s, "s")
    when = {
        (False, False): "throughout",
        (True, False): "from",
        (False, True): "first",
        (True, True): "for",
    }[begin_s is not None, length_s is not None]
    return texts(f"scenario.harmonic.{when}", sequence=texts.named("scenario.sequence", sequence), **values)


def _profile(points: Sequence[Sequence[float]], texts: Texts) -> Iterator[str]:
    """Steps and ramps of a voltage profile, a sentence each; of many, one sentence for all."""
    moves = moves_of(points)
    if len(moves) <= _MOST_LEVELS:
        yield from (move_words(move, texts) for move in moves)
        return
    levels = [level for _, level in points]
    yield texts(
        "scenario.profile.many",
        count=len(moves),
        begin_s=number(points[0][0], "s"),
        end_s=number(points[-1][0], "s"),
        low_pu=number(min(levels), "pu"),
        high_pu=number(max(levels), "pu"),
    )
