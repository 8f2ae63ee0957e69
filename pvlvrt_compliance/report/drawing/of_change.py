"""The drawing of a change: the record of a new run over that of an old one, where one of them is worst."""

from collections.abc import Iterator, Sequence
from typing import Literal, NamedTuple

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.report.drawing.clipping import Frame, lines_within
from pvlvrt_compliance.report.drawing.colours import BLACK, GREY
from pvlvrt_compliance.report.drawing.curves import Group, Shown, groups_of, known
from pvlvrt_compliance.report.drawing.instants import lines_at_steps
from pvlvrt_compliance.report.drawing.limits import limits_of
from pvlvrt_compliance.report.drawing.model import Axis, Drawing, Line, Mark, Panel, Point, Spot, Text
from pvlvrt_compliance.report.drawing.of_test import TIME, cycle_of, drawn, height_of, reach_of
from pvlvrt_compliance.report.drawing.parts import BUCKETS, Part, grids_of
from pvlvrt_compliance.report.drawing.thinning import Series, sketches
from pvlvrt_compliance.report.drawing.worst import worst_of
from pvlvrt_compliance.results import Band, TestResult, Verdict
from pvlvrt_compliance.waveforms.container import Samples, Waveforms

CYCLES_BEFORE, CYCLES_AFTER = 3.0, 5.0
"""What is shown around the worst instant (chosen): waves can still be followed, a cycle's mean has come and gone."""


_Name = Literal["old", "new"]
_NAMES: tuple[_Name, _Name] = ("old", "new")
"""Of the runs; they follow the name of a curve, and `names` has the words for them."""

_PANELS = 3
_CONTEXT = ("currents", "sequences", "active_power", "reactive_power")
"""What else is shown besides what was judged, in this order."""

_PART_OF_THE_HEIGHT = 1e-3  # of a panel: less than what is seen
_EVERYWHERE = (float("-inf"), float("inf"))


class Recorded(NamedTuple):
    """A test of one run, and what it was judged by."""

    evidence: Evidence
    result: TestResult


class _Shown(NamedTuple):
    """A run as it is drawn: its group of curves, its verdict, and the samples that are shown."""

    run: Recorded
    group: Group
    verdict: Verdict
    parts: Sequence[Part]
    name: _Name

    @property
    def found(self) -> list[tuple[Shown, Samples]]:
        """Curves that the record has, but for what is instantaneous behind its own mean, and the source's voltage."""
        wanted = [one for one in self.group.shown if not one.is_faint and one.colour != GREY]
        return [(one, samples) for one in wanted if (samples := known(one)) is not None]


def drawing(
    verdicts: tuple[Verdict, Verdict],
    old: tuple[Evidence, TestResult],
    new: tuple[Evidence, TestResult],
    *,
    around: _Name = "new",
) -> Drawing:
    """Lay the record of a new run over that of an old one around the worst instant of one of them.

    Parameters
    ----------
    verdicts : tuple of Verdict
        The old and the new one that are compared.
    old, new : tuple
        Evidence and result of their test in both runs.
    around : str
        The run whose worst instant it is; the other one's where it has none.
    """
    runs = (Recorded(*old), Recorded(*new))
    window = _window(runs[1], verdicts if around == "new" else verdicts[::-1])
    groups = [_groups(run, verdict) for run, verdict in zip(runs, verdicts, strict=True)]
    parts = [_parts(run.evidence.waveforms, window) for run in runs]
    panels = []
    for key in _keys(groups, verdicts[1], runs[1].result):
        before, after = (_Shown(runs[k], groups[k][key], verdicts[k], parts[k], name) for k, name in enumerate(_NAMES))
        panels += [panel] if (panel := _panel(before, after, window)) else []
    return Drawing(panels=tuple(panels), span=window, marks=tuple(_marks(runs[1].result, verdicts, window)))


def _window(new: Recorded, verdicts: tuple[Verdict, Verdict]) -> Point:
    """Some cycles around the worst instant, of the second verdict if it has one; all of the record if neither has."""
    begin_s, end_s = new.evidence.waveforms.t0_s, new.evidence.waveforms.end_s
    at_s = verdicts[1].at_s if verdicts[1].at_s is not None else verdicts[0].at_s
    if at_s is None:
        return begin_s, end_s
    cycle_s = cycle_of(new.evidence)
    first_s = min(max(at_s - CYCLES_BEFORE * cycle_s, begin_s), end_s - (CYCLES_BEFORE + CYCLES_AFTER) * cycle_s)
    return max(first_s, begin_s), min(first_s + (CYCLES_BEFORE + CYCLES_AFTER) * cycle_s, end_s)


def _groups(run: Recorded, verdict: Verdict) -> dict[str, Group]:
    """Panels of a run by their keys, with the limits of this check alone."""
    return {group.key: group for group in groups_of(run.evidence, _bands(run.result, verdict))}


def _bands(result: TestResult, verdict: Verdict) -> list[Band]:
    return [band for band in result.bands if band.check == verdict.check]


def _keys(groups: Sequence[dict[str, Group]], verdict: Verdict, result: TestResult) -> list[str]:
    """Panels that both runs have: what was judged first, then what stands beside it."""
    limited = {band.quantity for band in _bands(result, verdict)}
    judged = [key for key, group in groups[1].items() if limited.intersection(group.quantities)]
    return [key for key in dict.fromkeys([*judged, *_CONTEXT]) if all(key in of for of in groups)][:_PANELS]


def _parts(waveforms: Waveforms, window: Point) -> list[Part]:
    """The samples within a window, all as curves."""
    found, offset = [], 0
    for grid in grids_of(waveforms):
        first, end = grid.first_from(window[0]), grid.first_from(window[1])
        if end > first:
            found.append(Part(grid, first, end, BUCKETS, is_band=False, offset=offset, goes_on=end < grid.samples))
        offset += grid.samples
    return found


def _panel(old: _Shown, new: _Shown, window: Point) -> Panel | None:
    """Both runs in one panel; none where either has nothing to show."""
    if not (old.found and new.found and old.parts and new.parts):
        return None
    group = new.group
    bands = _bands(new.run.result, new.verdict) if group.bands is None else group.bands
    lines, areas = limits_of([part for band in bands if (part := _within(band, window))], group.quantities)
    return Panel(
        title=group.title,
        x=Axis(TIME, window),
        y=Axis(group.unit, from_zero=group.from_zero),
        lines=(*_curves(old), *_curves(new), *map(_undotted, lines)),
        areas=areas,
        height=group.height,
        key=group.key,
        says=Text("comparison.overlay.limits" if lines else "comparison.overlay.curves", {}),
        spots=tuple(spot for one in (old, new) for spot in _spots(one, window)),
    )


def _curves(one: _Shown) -> Iterator[Line]:
    """Curves of a run, with its name; those of the old one are dotted, and grey where those of the new are black."""
    finest = _PART_OF_THE_HEIGHT * height_of(one.group, [reach_of(samples) for _, samples in one.found])
    series = [Series(samples, min(shown.fine, finest)) for shown, samples in one.found]
    for (shown, _), sketch in zip(one.found, sketches(series, one.parts), strict=True):
        line, _ = drawn(shown, sketch, cycle_of(one.run.evidence))
        if line is None:
            continue
        name = f"{shown.name} ({one.name})"
        line = line._replace(name=name, group=name)
        if one.name == "old":
            line = line._replace(dash="dot", colour=GREY if shown.colour == BLACK else shown.colour)
        yield line


def _undotted(limit: Line) -> Line:
    """A limit that does not look like the curves of the old run."""
    return limit._replace(dash="longdash") if limit.dash == "dot" else limit


def _within(band: Band, window: Point) -> Band | None:
    """The part of a limit within a window of time; None where there is none."""
    edges = {name: edge for name in ("lower", "upper") if (edge := getattr(band, name)) is not None}
    cut: dict[str, tuple[float, ...]] = {}
    for name, edge in edges.items():
        parts = lines_within(Frame(window, _EVERYWHERE), list(zip(band.t_s, edge, strict=True)))
        if not parts or len(parts[0]) < 2:
            return None
        cut["t_s"], cut[name] = zip(*parts[0], strict=True)
    return band.model_copy(update=cut) if cut else None


def _spots(one: _Shown, window: Point) -> Iterator[Spot]:
    """The worst instant of a run on its curve."""
    result = one.run.result.model_copy(update={"checks": (one.verdict,)})
    bands = _bands(one.run.result, one.verdict) if one.group.bands is None else one.group.bands
    words = Text(f"comparison.overlay.{one.name}", {})
    for spot in worst_of(one.group, bands, one.found, one.run.evidence, result):
        if window[0] <= spot.x <= window[1]:
            yield spot._replace(words=words)


def _marks(result: TestResult, verdicts: tuple[Verdict, Verdict], window: Point) -> Iterator[Mark]:
    """Steps of the disturbance without words, and the worst instants with them."""
    yield from lines_at_steps(result, window)
    for row, (name, verdict, colour) in enumerate(
        zip(("new", "old"), reversed(verdicts), (BLACK, GREY), strict=True), start=1
    ):
        if verdict.at_s is not None and window[0] <= verdict.at_s <= window[1]:
            words = Text(f"comparison.overlay.worst_{name}", {"at": f"{verdict.at_s:.3f}"})
            right = verdict.at_s > (window[0] + window[1]) / 2
            yield Mark(verdict.at_s, colour, "dashdot", words, row, "right" if right else "left", colour)
