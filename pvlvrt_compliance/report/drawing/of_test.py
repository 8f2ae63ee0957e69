"""The drawing of a test: the evidence that was judged, and the limits that it was held against."""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.report.drawing import characteristics, spectra
from pvlvrt_compliance.report.drawing.curves import Group, Shown, groups_of, known
from pvlvrt_compliance.report.drawing.instants import marks_of, shades_of, steps_of, zooms_of
from pvlvrt_compliance.report.drawing.limits import limits_of
from pvlvrt_compliance.report.drawing.model import Area, Axis, Drawing, Line, Panel
from pvlvrt_compliance.report.drawing.moments import instants_of, with_times
from pvlvrt_compliance.report.drawing.orbits import array_path, hodograph
from pvlvrt_compliance.report.drawing.parts import BUCKETS, Part, grids_of, parts_of
from pvlvrt_compliance.report.drawing.sentences import says_of
from pvlvrt_compliance.report.drawing.thinning import sketched
from pvlvrt_compliance.report.drawing.worst import worst_of
from pvlvrt_compliance.results import TestResult
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
    over_time = (_panel(group, evidence, result, parts) for group in groups_of(evidence, result.bands))
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


def _panel(group: Group, evidence: Evidence, result: TestResult, parts: Sequence[Part]) -> Panel | None:
    """A panel with its limits; none where there is no curve to hold against them, or nothing to be seen."""
    curves: list[Line] = []
    bands: list[Area] = []
    found = [(shown, samples) for shown in group.shown if (samples := known(shown)) is not None]
    if not found:
        return None
    limits = result.bands if group.bands is None else group.bands
    lines, areas = limits_of(limits, group.quantities)
    instants = instants_of(result, group.quantities, [samples for _, samples in found])
    happens = _happens(group, found, evidence)
    if not (lines or areas or instants or happens) or (_is_calm(group, evidence) and not happens):
        return None
    finest = _PART_OF_THE_HEIGHT * height_of(group, [samples for _, samples in found])
    for shown, samples in sorted(found, key=lambda one: not one[0].is_faint):
        line, area = drawn(shown, samples, parts, min(shown.fine, finest), cycle_of(evidence))
        curves += [line] if line else []
        bands += [area] if area else []
    if not curves and not bands:
        return None
    return Panel(
        title=group.title,
        x=Axis(TIME, (evidence.waveforms.t0_s, evidence.waveforms.end_s)),
        y=Axis(group.unit, from_zero=group.from_zero),
        lines=(*curves, *lines, *instants),
        areas=(*areas, *bands),
        height=group.height,
        key=group.key,
        says=with_times(says_of(group, result), result, group.quantities),
        spots=worst_of(group, limits, found, evidence, result),
    )


def _is_calm(group: Group, evidence: Evidence) -> bool:
    """Whether limits of a voltage are of no interest: nothing that was stepped moves one."""
    steps = evidence.disturbance.steps
    return group.key == "sequences" and bool(steps) and not any(_IN_PHASES.intersection(step.moved) for step in steps)


def _happens(group: Group, found: Sequence[tuple[Shown, Samples]], evidence: Evidence) -> bool:
    """Whether something is to be seen of series that nothing limits.

    Instantaneous values of the phases are where what is stepped is seen in them; else one must move that is no wave.
    """
    steps = evidence.disturbance.steps
    if group.of_phases and any(_IN_PHASES.intersection(step.moved) for step in steps):
        return True
    still = _STILL_OFF_NOMINAL if group.unit == "pu" and evidence.disturbance.frequency_moves else _STILL
    nominal = evidence.nominal
    scales = {"pu": 1.0, "kW": nominal.apparent_power_kva, "kvar": nominal.apparent_power_kva}
    for shown, samples in found:
        scale = scales.get(group.unit, float(np.nanmax(np.abs(samples))))
        if not shown.is_wave and np.nanmax(samples) - np.nanmin(samples) > still * scale:
            return True
    return False


def height_of(group: Group, found: Sequence[Samples]) -> float:
    """What the axis of some series reaches over, limits left out."""
    if not found:
        return 0.0
    lowest, highest = min(float(np.nanmin(x)) for x in found), max(float(np.nanmax(x)) for x in found)
    return highest - (min(lowest, 0.0) if group.from_zero else lowest)


def drawn(
    shown: Shown, samples: Samples, parts: Sequence[Part], fine: float, cycle_s: float
) -> tuple[Line | None, Area | None]:
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
        swings_s=round(cycle_s, 5) if shown.is_wave else 0.0,
    )
    opacity = _FAINT_BAND if shown.is_faint else _BAND
    area = Area(shown.name, strips, shown.colour, opacity, group=shown.name, in_legend=not runs)
    return line if runs else None, area if strips else None
