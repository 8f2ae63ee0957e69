"""The drawing of a test: the evidence that was judged, and the limits that it was held against."""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.report.drawing import characteristics, spectra
from pvlvrt_compliance.report.drawing.curves import Group, Shown, groups_of, known
from pvlvrt_compliance.report.drawing.instants import marks_of, shades_of, steps_of, zooms_of
from pvlvrt_compliance.report.drawing.limits import limits_of
from pvlvrt_compliance.report.drawing.model import Area, Axis, Drawing, Line, Panel, Point
from pvlvrt_compliance.report.drawing.moments import instants_of, with_times
from pvlvrt_compliance.report.drawing.orbits import array_path, hodograph
from pvlvrt_compliance.report.drawing.parts import BUCKETS, Part, grids_of, parts_of
from pvlvrt_compliance.report.drawing.sentences import says_of
from pvlvrt_compliance.report.drawing.thinning import Series, Sketch, sketches
from pvlvrt_compliance.report.drawing.worst import worst_of
from pvlvrt_compliance.results import Band, TestResult
from pvlvrt_compliance.waveforms.breaker import opened_at_s
from pvlvrt_compliance.waveforms.container import Samples

_AFTER = {"hodograph": "currents", "droop": "active_power"}
"""What a panel belongs to, by their keys."""

TIME = "time from the start of the record (s)"

_PART_OF_THE_HEIGHT = 1e-3  # of a panel: less than what is seen
_IN_PHASES = frozenset({"voltage", "angle", "harmonics", "strength", "recording"})
"""What of a disturbance is seen in instantaneous values of the phases."""
_STILL = 0.005  # of the scale of a series: what it may move by without anything to be seen
_STILL_OFF_NOMINAL = 0.03  # what a step of the frequency alone does to means over a cycle
_WIDTH, _FAINT_WIDTH, _FAINT = 1.3, 0.9, 0.7
_BAND, _FAINT_BAND = 0.07, 0.05


def drawing(evidence: Evidence, result: TestResult, *, buckets: int = BUCKETS) -> Drawing:
    """Draw voltages, sequence voltages, currents, powers and DC voltage over one common axis of time, a panel each.

    Parameters
    ----------
    evidence : Evidence
        What the test was judged by; series that it cannot give leave their panel out.
    result : TestResult
        Gives the steps of the disturbance, the measurement window and the bands of its verdicts.
    buckets : int
        Of a curve, see `parts_of`.
    """
    waveforms = evidence.waveforms
    span, opened_s = (waveforms.t0_s, waveforms.end_s), opened_at_s(waveforms)
    instants_s = [step.at_s for step in steps_of(result)] + ([] if opened_s is None else [opened_s])
    parts = parts_of(grids_of(waveforms), instants_s, cycle_of(evidence), buckets)
    over_time = _over_time(evidence, result, parts)
    return Drawing(
        panels=_in_order(panel for panel in (*over_time, *_over_others(evidence, result)) if panel is not None),
        span=span,
        marks=marks_of(result, span, opened_s),
        shades=shades_of(result, span),
        zooms=zooms_of(result, span),
    )


def _over_others(evidence: Evidence, result: TestResult) -> Iterator[Panel | None]:
    """Panels with a horizontal axis of their own."""
    yield hodograph(evidence, result)
    yield from characteristics.panels(evidence, result)
    yield array_path(evidence, result)
    yield from spectra.panels(result)


def _in_order(panels: Iterable[Panel]) -> tuple[Panel, ...]:
    """Each panel over another quantity after the one over time that it belongs to, or else at the end."""
    found: list[Panel] = []
    for panel in panels:
        after = _AFTER.get(panel.key)
        at = next((k + 1 for k, other in enumerate(found) if other.key == after), len(found))
        found.insert(at, panel)
    return tuple(found)


def cycle_of(evidence: Evidence) -> float:
    """A cycle of the record (s)."""
    try:
        return 1 / evidence.frequency_hz
    except MeasurementError:  # no voltages to measure a frequency of
        return 1 / evidence.nominal.frequency_hz


class _Plan(NamedTuple):
    """A panel before its curves are sketched."""

    group: Group
    limits: Sequence[Band]
    lines: tuple[Line, ...]  # of limits
    areas: tuple[Area, ...]
    instants: tuple[Line, ...]
    found: Sequence[tuple[Shown, Samples]]
    finest: float

    @property
    def series(self) -> list[tuple[Shown, Series]]:
        """The curves from the back to the front, each with what may be left out of it."""
        by_depth = sorted(self.found, key=lambda one: not one[0].is_faint)
        return [(shown, Series(samples, min(shown.fine, self.finest))) for shown, samples in by_depth]


def _over_time(evidence: Evidence, result: TestResult, parts: Sequence[Part]) -> Iterator[Panel | None]:
    """Panels over time; the curves of all of them are sketched at once."""
    plans = [plan for group in groups_of(evidence, result.bands) if (plan := _plan(group, evidence, result))]
    series = [plan.series for plan in plans]
    sketched = iter(sketches([one for of_plan in series for _, one in of_plan], parts))
    for plan, of_plan in zip(plans, series, strict=True):
        curves = [(shown, sketch) for (shown, _), sketch in zip(of_plan, sketched, strict=False)]
        yield _panel(plan, curves, evidence, result)


def _plan(group: Group, evidence: Evidence, result: TestResult) -> _Plan | None:
    """What a panel is made of; none where there is no curve to hold against its limits, or nothing to be seen."""
    found = [(shown, samples) for shown in group.shown if (samples := known(shown)) is not None]
    if not found:
        return None
    limits = result.bands if group.bands is None else group.bands
    lines, areas = limits_of(limits, group.quantities)
    instants = instants_of(result, group.quantities, [samples for _, samples in found])
    reaches = [reach_of(samples) for _, samples in found]
    happens = _happens(group, found, reaches, evidence)
    if not (lines or areas or instants or happens) or (_is_calm(group, evidence) and not happens):
        return None
    finest = _PART_OF_THE_HEIGHT * height_of(group, reaches)
    return _Plan(group, limits, lines, areas, instants, found, finest)


def _panel(plan: _Plan, curves: Sequence[tuple[Shown, Sketch]], evidence: Evidence, result: TestResult) -> Panel | None:
    """A panel with its limits."""
    group = plan.group
    made = [drawn(shown, sketch, cycle_of(evidence)) for shown, sketch in curves]
    lines = [line for line, _ in made if line]
    bands = [band for _, band in made if band]
    if not lines and not bands:
        return None
    return Panel(
        title=group.title,
        x=Axis(TIME, (evidence.waveforms.t0_s, evidence.waveforms.end_s)),
        y=Axis(group.unit, from_zero=group.from_zero),
        lines=(*lines, *plan.lines, *plan.instants),
        areas=(*plan.areas, *bands),
        height=group.height,
        key=group.key,
        says=with_times(says_of(group, result), result, group.quantities),
        spots=worst_of(group, plan.limits, plan.found, evidence, result),
    )


def _is_calm(group: Group, evidence: Evidence) -> bool:
    """Whether limits of a voltage are of no interest: nothing that was stepped moves one."""
    steps = evidence.disturbance.steps
    return group.key == "sequences" and bool(steps) and not any(_IN_PHASES.intersection(step.moved) for step in steps)


def _happens(
    group: Group, found: Sequence[tuple[Shown, Samples]], reaches: Sequence[Point], evidence: Evidence
) -> bool:
    """Whether something is to be seen of series that nothing limits.

    Instantaneous values of the phases are where what is stepped is seen in them; else one must move that is no wave.
    """
    steps = evidence.disturbance.steps
    if group.of_phases and any(_IN_PHASES.intersection(step.moved) for step in steps):
        return True
    still = _STILL_OFF_NOMINAL if group.unit == "pu" and evidence.disturbance.frequency_moves else _STILL
    nominal = evidence.nominal
    scales = {"pu": 1.0, "kW": nominal.apparent_power_kva, "kvar": nominal.apparent_power_kva}
    return any(
        high - low > still * scales.get(group.unit, max(abs(low), abs(high)))
        for (shown, _), (low, high) in zip(found, reaches, strict=True)
        if not shown.is_wave
    )


def reach_of(samples: Samples) -> Point:
    """The least and the largest of some samples that are not all gaps."""
    low, high = float(samples.min()), float(samples.max())
    return (low, high) if math.isfinite(high - low) else (float(np.nanmin(samples)), float(np.nanmax(samples)))


def height_of(group: Group, reaches: Sequence[Point]) -> float:
    """What the axis of series that reach so far reaches over, limits left out."""
    if not reaches:
        return 0.0
    lowest, highest = min(low for low, _ in reaches), max(high for _, high in reaches)
    return highest - (min(lowest, 0.0) if group.from_zero else lowest)


def drawn(shown: Shown, sketch: Sketch, cycle_s: float) -> tuple[Line | None, Area | None]:
    """A series as curve, as band, or as both; the curve stands in the legend if there is one."""
    runs, strips = sketch
    line = Line(
        name=shown.name,
        runs=runs,
        colour=shown.colour,
        width=_FAINT_WIDTH if shown.is_faint else _WIDTH,
        opacity=_FAINT if shown.is_faint else 1.0,
        group=shown.name,
        told=True,
        swings_s=round(cycle_s, 5) if shown.is_wave else 0.0,
    )
    opacity = _FAINT_BAND if shown.is_faint else _BAND
    area = Area(shown.name, strips, shown.colour, opacity, group=shown.name, in_legend=not runs)
    return line if runs else None, area if strips else None
