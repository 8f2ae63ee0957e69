"""A stretch between two steps of the grid in words: what begins with it, or else what holds in it."""

from collections.abc import Iterator, Mapping
from typing import Any

from pvlvrt_compliance.disturbance.model import Disturbance, Stretch
from pvlvrt_compliance.report.document.happenings import event_words, is_something, later, move_words, moves_of, plain
from pvlvrt_compliance.report.format import number
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import TestResult

_SAME_INSTANT_S = 1e-6


def stretch_words(test: TestResult, begin_s: float, end_s: float, texts: Texts) -> str:
    """What grid and sun do between two instants, in whole sentences whose times count from the start of the record.

    Parameters
    ----------
    test : TestResult
    begin_s, end_s : float
        From the start of the record (s).
    texts : Texts

    Returns
    -------
    str
        Empty where it is not known what the grid did.
    """
    grid = test.disturbance
    if grid is None:
        return ""
    events = _events(test.scenario, grid.start_s) if grid.origin == "asked" and test.scenario else []
    begun = [event for event in events if _same(_begins_s(event), begin_s)]
    happens = [sentence for event in begun for sentence in event_words(event, texts)]
    moves = [
        move_words(move, texts)
        for event in events
        for move in moves_of(event.get("points") or ())
        if _same(move[1] if move[0] is None else move[0], begin_s)
    ]
    stretch = grid.stretch_at(begin_s).cut(begin_s, end_s)
    voltage_told = bool(moves) or any(event["kind"] == "sag" for event in begun)
    told = happens or moves
    holds = _state(grid, stretch, texts) if not (voltage_told or (told and stretch.kind == "normal")) else ()
    return " ".join((*happens, *moves, *holds))


def _events(scenario: Mapping[str, Any], start_s: float) -> list[dict[str, Any]]:
    """The sag that a test begins with and all that happens besides, on the clock of the record."""
    first = {"kind": "sag", "t_s": 0.0, "duration_s": scenario["duration_s"], "sag": scenario["sag"]}
    events = [*([first] if is_something(scenario["sag"]) else []), *scenario.get("events", ())]
    return [later(event, start_s) for event in events]


def _begins_s(event: Mapping[str, Any]) -> float | None:
    """When an event begins that is told as a whole; a voltage profile is told move by move."""
    return None if event["kind"] == "voltage_profile" else event.get("t_s")


def _same(at_s: float | None, begin_s: float) -> bool:
    return at_s is not None and abs(at_s - begin_s) < _SAME_INSTANT_S


def _state(grid: Disturbance, stretch: Stretch, texts: Texts) -> Iterator[str]:
    """The voltage that holds, and the frequency where it is not the same all along; nothing of a recorded voltage."""
    if "recording" in stretch.ramps:
        return
    first, last = stretch.voltage, stretch.voltage_at_end
    if stretch.kind == "normal":
        yield texts("cursor.state.normal")
    elif last is None:
        values = {"positive_pu": number(first.positive_pu, "pu"), "negative_pu": number(first.negative_pu, "pu")}
        yield texts(f"cursor.state.{stretch.kind}", **values)
    else:
        yield texts(
            f"cursor.state.{stretch.kind}_moves",
            positive_pu=number(first.positive_pu, "pu"),
            negative_pu=number(first.negative_pu, "pu"),
            last_positive_pu=number(last.positive_pu, "pu"),
            last_negative_pu=number(last.negative_pu, "pu"),
        )
    if grid.frequency_moves and stretch.frequency_hz is not None and not stretch.rocof_hz_s:
        yield texts("cursor.state.frequency", hz=plain(round(stretch.frequency_hz, 3)))
