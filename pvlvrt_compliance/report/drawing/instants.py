"""What is said of instants: steps of the disturbance, what is no normal voltage, the window, the breaker."""

import math
from collections.abc import Callable, Iterator
from typing import Literal

from pvlvrt_compliance.disturbance.model import Step
from pvlvrt_compliance.report.drawing.colours import BLACK, BLUE, GREY, SHADE, VERMILION
from pvlvrt_compliance.report.drawing.model import Mark, Named, Point, Shade, Text, Zoom
from pvlvrt_compliance.results import TestResult

_NEAR_AN_END = 0.25  # of the record: words as long as they are here would leave the drawing
_BEFORE_S, _AFTER_S = 0.02, 0.08  # what the zoom on an instant shows

_MOST_LINES = 100  # as long as there are no more, each step has its own
_APART = 1 / 100  # of what is shown: about seven pixels, between which the curves are seen

Anchor = Literal["left", "center", "right"]
Place = Callable[[float, Anchor], Anchor]


def steps_of(result: TestResult) -> tuple[Step, ...]:
    """Steps of the disturbance, none where a result of an earlier version does not say what the grid did."""
    return result.disturbance.steps if result.disturbance else ()


def shades_of(result: TestResult, span: Point) -> tuple[Shade, ...]:
    """What is no normal voltage, in grey, and the measurement windows, in blue."""
    measured = result.measurements
    windows = [window for window in (measured.before, measured.during, measured.after) if window]
    return (
        *(Shade(*part, SHADE, 0.045) for part in _abnormal(result, span[1])),
        *(Shade(window.start_s, window.end_s, BLUE, 0.10) for window in windows),
    )


def marks_of(result: TestResult, span: Point, opened_s: float | None) -> tuple[Mark, ...]:
    """A line at each step and at the opening of the breaker; words above the panels, none of which leaves them."""
    start_s, length_s = span[0], span[1] - span[0]

    def place(at_s: float, usual: Anchor) -> Anchor:
        share = (at_s - start_s) / length_s if length_s > 0 else 0.0
        return "left" if share < _NEAR_AN_END else "right" if share > 1 - _NEAR_AN_END else usual

    return (*lines_at_steps(result, span), *_words(result, place), *_opening(result, opened_s, place))


def lines_at_steps(result: TestResult, span: Point) -> Iterator[Mark]:
    """A line at each step that is shown; of a great many, those that leave the curves to be seen between them."""
    shown_s = [step.at_s for step in steps_of(result) if span[0] <= step.at_s <= span[1]]
    apart_s = (span[1] - span[0]) * _APART if len(shown_s) > _MOST_LINES else 0.0
    drawn_s = -math.inf
    for at_s in shown_s:
        if at_s - drawn_s >= apart_s:
            drawn_s = at_s
            yield Mark(at_s, GREY, "dash")


def zooms_of(result: TestResult, span: Point) -> tuple[Zoom, ...]:
    """The whole record, the disturbance, a few cycles around its first and its last step."""
    zooms = [Zoom("whole record", *span)]
    if steps := steps_of(result):
        first_s, last_s = steps[0].at_s, steps[-1].at_s
        margin_s = 0.1 * (last_s - first_s)
        disturbance = [Zoom("disturbance", first_s - margin_s, last_s + margin_s)]
        end = [Zoom("end", last_s - _BEFORE_S, last_s + _AFTER_S)]
        start = Zoom("start", first_s - _BEFORE_S, first_s + _AFTER_S)
        zooms += [*disturbance, start, *end] if last_s > first_s else [start]
    return tuple(zooms)


def _abnormal(result: TestResult, end_s: float) -> list[Point]:
    """Where the voltage asked for is not normal (s); what follows on without a gap is one."""
    found: list[Point] = []
    for part in result.disturbance.stretches if result.disturbance else ():
        if part.kind != "normal" and part.begin_s < end_s:
            joined = bool(found) and found[-1][1] == part.begin_s
            begin_s = found.pop()[0] if joined else part.begin_s
            found.append((begin_s, min(part.end_s, end_s)))
    return found


def _words(result: TestResult, place: Place) -> Iterator[Mark]:
    """Name the first and the last step, and the window between them; steps between stand without words."""
    steps, during = steps_of(result), result.measurements.during
    if steps:
        yield _named(steps[0].at_s, _step_in_words(steps[0], "start"), place(steps[0].at_s, "right"), row=1)
    if len(steps) > 1:
        apart = place(steps[0].at_s, "right") == "right" and place(steps[-1].at_s, "left") == "left"
        row = 1 if apart else 2
        yield _named(steps[-1].at_s, _step_in_words(steps[-1], "end"), place(steps[-1].at_s, "left"), row=row)
    if during:
        middle_s = (during.start_s + during.end_s) / 2
        yield _named(middle_s, Text("mark.during", {}), place(middle_s, "center"), row=3, colour=BLUE)


def _step_in_words(step: Step, name: str) -> Text:
    moved = tuple(Text(f"mark.moved.{what}", {}) for what in step.moved)
    return Text(f"mark.{name}", {"at": f"{step.at_s:.3f}", "moved": moved})


def _opening(result: TestResult, opened_s: float | None, place: Place) -> Iterator[Mark]:
    if opened_s is not None:
        at = {"at": f"{opened_s:.3f}"}
        cause = result.trip_cause
        words = (
            Text("mark.opening_by", {**at, "cause": Named("mark.cause", cause)})
            if cause
            else Text("mark.opening", {**at})
        )
        named = _named(opened_s, words, place(opened_s, "left"), row=4, colour=VERMILION)
        yield named._replace(colour=VERMILION, dash="solid")


def _named(at_s: float, words: Text, anchor: Anchor, row: int, colour: str = BLACK) -> Mark:
    return Mark(at_s, colour, None, words, row, anchor, colour)
