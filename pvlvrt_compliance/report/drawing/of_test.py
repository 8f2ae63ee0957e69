"""The drawing of a test: the evidence that was judged, and the limits that it was held against."""

from collections.abc import Sequence

import numpy as np

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.report.drawing.curves import Group, Shown, groups_of, known
from pvlvrt_compliance.report.drawing.instants import marks_of, shades_of, steps_of, zooms_of
from pvlvrt_compliance.report.drawing.limits import limits_of
from pvlvrt_compliance.report.drawing.model import Area, Axis, Drawing, Line, Panel
from pvlvrt_compliance.report.drawing.parts import BUCKETS, Part, grids_of, parts_of
from pvlvrt_compliance.report.drawing.thinning import sketched
from pvlvrt_compliance.results import TestResult
from pvlvrt_compliance.waveforms.breaker import opened_at_s
from pvlvrt_compliance.waveforms.container import Samples

TIME = "time from the start of the record (s)"

_PART_OF_THE_HEIGHT = 1e-3  # of a panel: less than what is seen
_WIDTH, _FAINT_WIDTH, _FAINT = 1.3, 0.9, 0.5
_BAND, _FAINT_BAND = 0.38, 0.16


def drawing(evidence: Evidence, result: TestResult, *, buckets: int = BUCKETS) -> Drawing:
    """Draw voltages, sequence voltages, currents, powers and DC voltage over one common axis of time.

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
    parts = parts_of(grids_of(waveforms), instants_s, _cycle_s(evidence), buckets)
    groups = groups_of(evidence, {band.quantity for band in result.bands})
    panels = (_panel(group, result, span, parts) for group in groups)
    return Drawing(
        panels=tuple(panel for panel in panels if panel is not None),
        span=span,
        marks=marks_of(result, span, opened_s),
        shades=shades_of(result, span),
        zooms=zooms_of(result, span),
    )


def _cycle_s(evidence: Evidence) -> float:
    try:
        return 1 / evidence.frequency_hz
    except MeasurementError:  # no voltages to measure a frequency of
        return 1 / evidence.nominal.frequency_hz


def _panel(group: Group, result: TestResult, span: tuple[float, float], parts: Sequence[Part]) -> Panel | None:
    """A panel with its limits; none where there is no curve to hold against them."""
    curves: list[Line] = []
    bands: list[Area] = []
    found = [(shown, samples) for shown in group.shown if (samples := known(shown)) is not None]
    finest = _PART_OF_THE_HEIGHT * _height(group, [samples for _, samples in found])
    for shown, samples in sorted(found, key=lambda one: not one[0].is_faint):
        line, area = _drawn(shown, samples, parts, min(shown.fine, finest))
        curves += [line] if line else []
        bands += [area] if area else []
    if not curves and not bands:
        return None
    lines, areas = limits_of(result.bands, group.quantities)
    y = Axis(group.unit, from_zero=group.from_zero)
    return Panel(group.title, Axis(TIME, span), y, (*curves, *lines), (*areas, *bands), group.height)


def _height(group: Group, found: Sequence[Samples]) -> float:
    """What the axis of some series reaches over, limits left out."""
    if not found:
        return 0.0
    lowest, highest = min(float(np.nanmin(x)) for x in found), max(float(np.nanmax(x)) for x in found)
    return highest - (min(lowest, 0.0) if group.from_zero else lowest)


def _drawn(shown: Shown, samples: Samples, parts: Sequence[Part], fine: float) -> tuple[Line | None, Area | None]:
    """A series as curve, as band, or as both; the curve stands in the legend if there is one."""
    runs, strips = sketched(samples, parts, fine)
    line = Line(
        name=shown.name,
        runs=runs,
        colour=shown.colour,
        width=_FAINT_WIDTH if shown.is_faint else _WIDTH,
        opacity=_FAINT if shown.is_faint else 1.0,
        group=shown.name,
        told=True,
    )
    opacity = _FAINT_BAND if shown.is_faint else _BAND
    area = Area(shown.name, strips, shown.colour, opacity, group=shown.name, in_legend=not runs)
    return line if runs else None, area if strips else None
