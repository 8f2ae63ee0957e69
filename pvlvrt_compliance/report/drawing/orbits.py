"""Where two quantities go together: the current as a space vector, and the operating point of the PV array."""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.evidence.outline import bends
from pvlvrt_compliance.report.drawing.colours import BLUE, FURTHER, GREY, VERMILION
from pvlvrt_compliance.report.drawing.limits import limits_of
from pvlvrt_compliance.report.drawing.model import Axis, Dash, Line, Named, Panel, Point, Run, Said, Spot, Text, values
from pvlvrt_compliance.results import TestResult
from pvlvrt_compliance.results.band import CURRENT
from pvlvrt_compliance.waveforms.container import Samples

_FINE = 2e-3  # of the larger side of what is drawn: how far a path may be from its samples
_MOST_POINTS = 250  # of a path
_MOST_SAMPLES = 10_000  # of a path that is looked at
_DIGITS, _ARRAY_DIGITS = 3, 1  # of a current in pu; of volts and kilowatts
_TRANSIENT_CYCLES = 3  # of a current on its way, as long as a hodograph can still be read
_CIRCLE = 72  # points
_BEYOND = 1.06  # of what is drawn: how far the axes of a hodograph go, the same to all sides
_ROOM = 0.03  # of what is drawn, to either side of the path of an array
_CLOSED = 1.02  # cycles, so that a path along a closed curve has no gap

GREEN = FURTHER[0]


class _Time(NamedTuple):
    """A part of a record, and how it is drawn."""

    name: str
    begin_s: float
    end_s: float
    colour: str
    width: float = 1.6
    dash: Dash = "solid"
    opacity: float = 1.0


def hodograph(evidence: Evidence, result: TestResult) -> Panel | None:
    """The current's space vector before, during and after the (first) sag, in the limits of the phases.

    None where neither the voltage nor its angle moves.
    """
    if not evidence.disturbance.steps_of("voltage", "angle"):
        return None
    try:
        vector, times = evidence.current_vector_pu, list(_cycles(evidence))
    except MeasurementError:
        return None
    lines = [line for time in times if (line := _path(evidence, time, vector.real, vector.imag, _DIGITS))]
    if not lines:
        return None
    during = next(time for time in times if time.name == "during")
    span: dict[str, Said] = {"begin": f"{during.begin_s:.3f}", "end": f"{during.end_s:.3f}"}
    drawn, _ = limits_of(result.bands, (CURRENT,))
    circles = [_circle(line) for line in drawn if line.in_legend]
    reach = _BEYOND * max(abs(v) for line in (*lines, *circles) for run in line.runs for v in (*run.x, *run.y))
    return Panel(
        title="Hodograph of the current",
        x=Axis("alpha (pu)", (-reach, reach)),
        y=Axis("beta (pu)", (-reach, reach)),
        lines=(*lines, *circles),
        key="hodograph",
        says=Text(f"figure.hodograph.{'limits' if circles else 'seen'}", span),
        over="other",
        equal=True,
    )


def _cycles(evidence: Evidence) -> Iterator[_Time]:
    """The last cycle of each window, and the first cycles after the start; after a trip there is no current."""
    grid, windows, cycle_s = evidence.disturbance, evidence.measurements, 1 / evidence.frequency_hz
    yield _Time("before", grid.start_s - _CLOSED * cycle_s, grid.start_s, BLUE, 3.0, opacity=0.5)
    opened_s = evidence.known_opening_s
    end_s = windows.during.end_s if windows.during else grid.clear_s
    end_s = end_s if opened_s is None else min(end_s, max(opened_s, grid.start_s))
    settling_s = min(grid.start_s + _TRANSIENT_CYCLES * cycle_s, end_s)
    yield _Time("first cycles", grid.start_s, settling_s, GREY, 1.0, opacity=0.7)
    yield _Time("during", max(end_s - _CLOSED * cycle_s, grid.start_s), end_s, VERMILION, 2.2)
    after = windows.after
    if after is not None and opened_s is None:
        after_cycle_s = _CLOSED / (after.frequency_hz or evidence.frequency_hz)
        yield _Time("after", after.end_s - after_cycle_s, after.end_s, GREEN, 1.6, "dot")


def _circle(line: Line) -> Line:
    """A limit of a phase's amplitude as the circle that a balanced current of that amplitude runs along."""
    radius = max(abs(value) for value in line.runs[0].y if math.isfinite(value))
    angles = [2 * math.pi * k / _CIRCLE for k in range(_CIRCLE + 1)]
    x, y = ([round(radius * part(angle), _DIGITS) for angle in angles] for part in (math.cos, math.sin))
    return line._replace(runs=(Run(tuple(x), tuple(y)),))


def array_path(evidence: Evidence, result: TestResult) -> Panel | None:
    """Power over voltage of the PV array before, during and after the disturbance.

    None in a record without its current, or where its power hardly moves.
    """
    try:
        voltage, power = evidence.dc_voltage_v, evidence.array_power_kw
    except MeasurementError:
        return None
    least_kw = evidence.thresholds.response_least_pu.value * evidence.nominal.apparent_power_kva
    if not np.isfinite(power).all() or np.ptp(power) < least_kw:
        return None
    grid, end_s = result.disturbance or evidence.disturbance, evidence.known_opening_s or evidence.record_end_s
    times = (
        _Time("before", evidence.waveforms.t0_s, grid.start_s, BLUE, 2.2),
        _Time("during", grid.start_s, min(max(grid.end_s, grid.clear_s), end_s), VERMILION, 1.3),
        _Time("after", max(grid.end_s, grid.clear_s), end_s, GREEN, 1.6, "dot"),
    )
    lines = tuple(line for time in times if (line := _path(evidence, time, voltage, power, _ARRAY_DIGITS)))
    ends = (_point(evidence, time, voltage, power) for time in times[:2])
    return Panel(
        title="Operating point of the PV array",
        x=Axis("DC voltage (V)", _with_room(lines)),
        y=Axis("power of the array (kW)"),
        lines=lines,
        height=2.0,
        key="pv_path",
        says=Text("figure.pv_path.seen", {}),
        over="other",
        spots=tuple(spot for spot in ends if spot),
    )


def _with_room(lines: Sequence[Line]) -> Point | None:
    """From where to where lines reach, and a little on: the point of an end is not cut in half."""
    places = [place for line in lines for run in line.runs for place in values(run.x)]
    if not places:
        return None
    room = _ROOM * (max(places) - min(places))
    return round(min(places) - room, _ARRAY_DIGITS), round(max(places) + room, _ARRAY_DIGITS)


def _point(evidence: Evidence, time: _Time, x: Samples, y: Samples) -> Spot | None:
    """Where two series are in the end of a part of the record."""
    inside = np.flatnonzero(evidence.between(time.begin_s, time.end_s))
    if not len(inside):
        return None
    at = inside[-1]
    words = Text("figure.pv_path.point", {"name": Named("curve", time.name)})
    return Spot(round(float(x[at]), _ARRAY_DIGITS), round(float(y[at]), _ARRAY_DIGITS), words, time.colour)


def _path(evidence: Evidence, time: _Time, x: Samples, y: Samples, digits: int) -> Line | None:
    """Where two series go together in a part of the record; none where it holds no sample, or one is not finite."""
    inside = evidence.between(time.begin_s, time.end_s)
    x, y = x[inside], y[inside]
    if not len(x) or not (np.isfinite(x).all() and np.isfinite(y).all()):
        return None
    kept = sketched_path(x, y)
    run = Run(_rounded(x[kept], digits), _rounded(y[kept], digits))
    return Line(time.name, (run,), time.colour, time.width, time.dash, time.opacity, group=time.name)


def sketched_path(x: Samples, y: Samples) -> NDArray[np.int64]:
    """Samples that a path needs: those left out are within `_FINE` of its size of it, or more where they are many."""
    size = max(np.ptp(x), np.ptp(y), 1e-9)
    scaled = (x / max(np.ptp(x), _FINE * size), y / max(np.ptp(y), _FINE * size))
    # Of a long record a few samples a millisecond: nothing that turns a path is faster.
    kept = np.arange(0, len(x), max(len(x) // _MOST_SAMPLES, 1))
    kept = kept if kept[-1] == len(x) - 1 else np.append(kept, len(x) - 1)
    fine = _FINE / 2
    while True:
        kept = kept[bends(fine, kept.astype(np.float64), *(series[kept] for series in scaled))]
        if len(kept) <= _MOST_POINTS:
            return kept
        fine *= 2


def _rounded(x: Samples, digits: int) -> tuple[float, ...]:
    return tuple(np.round(x, digits).tolist())
