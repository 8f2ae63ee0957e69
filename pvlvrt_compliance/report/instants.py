"""What a figure says of instants: steps of the disturbance, what is no normal voltage, the window, the breaker."""

from collections.abc import Callable, Iterator
from typing import Any

from pvlvrt_compliance.disturbance.model import Step
from pvlvrt_compliance.report.panels import BLACK, BLUE, GREY, VERMILION
from pvlvrt_compliance.results import TestResult
from pvlvrt_compliance.waveforms.breaker import opened_at_s
from pvlvrt_compliance.waveforms.container import Waveforms

Figure = dict[str, Any]

ROW_PX = 15
"""Height of a row of labels above the figure."""

ROWS = 4
"""Rows of labels."""

_NEAR_AN_END = 0.25  # of the record: words as long as they are here would leave the figure


def shapes(waveforms: Waveforms, test: TestResult) -> list[Figure]:
    """Areas and lines across all panels."""
    return [*_areas_and_lines(test, waveforms), *_opening_line(waveforms)]


def labels(waveforms: Waveforms, test: TestResult) -> list[Figure]:
    """Words above the first panel, none of which leaves it."""
    start_s, span_s = waveforms.t0_s, waveforms.end_s - waveforms.t0_s

    def place(at_s: float, usual: str) -> str:
        share = (at_s - start_s) / span_s if span_s > 0 else 0.0
        return "left" if share < _NEAR_AN_END else "right" if share > 1 - _NEAR_AN_END else usual

    return [*_instants(test, place), *_opening_label(waveforms, test, place)]


def _area(start_s: float, end_s: float, colour: str) -> Figure:
    return {
        "type": "rect",
        "layer": "below",
        "xref": "x",
        "yref": "paper",
        "x0": start_s,
        "x1": end_s,
        "y0": 0,
        "y1": 1,
        "line": {"width": 0},
        "fillcolor": colour,
    }


def _vertical(at_s: float, colour: str, dash: str) -> Figure:
    return {
        "type": "line",
        "xref": "x",
        "yref": "paper",
        "x0": at_s,
        "x1": at_s,
        "y0": 0,
        "y1": 1,
        "line": {"color": colour, "width": 1, "dash": dash},
    }


def steps_of(test: TestResult) -> tuple[Step, ...]:
    """Steps of the disturbance, none where a result of an earlier version does not say what the grid did."""
    return test.disturbance.steps if test.disturbance else ()


def _areas_and_lines(test: TestResult, waveforms: Waveforms) -> Iterator[Figure]:
    """Shade what is no normal voltage and the measurement window; a line at each step."""
    during = test.measurements.during
    for part in _abnormal(test, waveforms):
        yield _area(*part, "rgba(0,0,0,0.045)")
    if during:
        yield _area(during.start_s, during.end_s, "rgba(0,114,178,0.10)")
    yield from (_vertical(step.at_s, GREY, "dash") for step in steps_of(test))


def _abnormal(test: TestResult, waveforms: Waveforms) -> list[tuple[float, float]]:
    """Where the voltage asked for is not normal (s); what follows on without a gap is one."""
    found: list[tuple[float, float]] = []
    for part in test.disturbance.stretches if test.disturbance else ():
        if part.kind != "normal" and part.begin_s < waveforms.end_s:
            joined = bool(found) and found[-1][1] == part.begin_s
            begin_s = found.pop()[0] if joined else part.begin_s
            found.append((begin_s, min(part.end_s, waveforms.end_s)))
    return found


def _opening_line(waveforms: Waveforms) -> Iterator[Figure]:
    at_s = opened_at_s(waveforms)
    if at_s is not None:
        yield _vertical(at_s, VERMILION, "solid")


def _instants(test: TestResult, place: Callable[[float, str], str]) -> Iterator[Figure]:
    """Name the first and the last step, and the window between them; steps between stand without words."""
    steps, during = steps_of(test), test.measurements.during
    if steps:
        yield _label(steps[0].at_s, _step_in_words(steps[0], "start"), place(steps[0].at_s, "right"), row=1)
    if len(steps) > 1:
        apart = place(steps[0].at_s, "right") == "right" and place(steps[-1].at_s, "left") == "left"
        row = 1 if apart else 2
        yield _label(steps[-1].at_s, _step_in_words(steps[-1], "end"), place(steps[-1].at_s, "left"), row=row)
    if during:
        middle_s = (during.start_s + during.end_s) / 2
        yield _label(middle_s, "window “during”", place(middle_s, "center"), row=3, colour=BLUE)


def _step_in_words(step: Step, name: str) -> str:
    return f"{name} {step.at_s:.3f} s ({', '.join(step.moved)})"


def _opening_label(waveforms: Waveforms, test: TestResult, place: Callable[[float, str], str]) -> Iterator[Figure]:
    at_s = opened_at_s(waveforms)
    if at_s is not None:
        by = f": {test.trip_cause}" if test.trip_cause else ""
        yield _label(at_s, f"breaker opens {at_s:.3f} s{by}", place(at_s, "left"), row=4, colour=VERMILION)


def _label(at_s: float, text: str, anchor: str, row: int, colour: str = BLACK) -> Figure:
    return {
        "text": text,
        "x": at_s,
        "xref": "x",
        "xanchor": anchor,
        "y": 1,
        "yref": "paper",
        "yanchor": "bottom",
        "yshift": 5 + ROW_PX * row,
        "showarrow": False,
        "font": {"size": 11, "color": colour},
    }
