"""Limits of the verdicts as lines and areas of a panel."""

from collections.abc import Sequence

from pvlvrt_compliance.report.drawing.colours import BLACK, BLUE, PURPLE, VERMILION, of_mode
from pvlvrt_compliance.report.drawing.model import Area, Dash, Line, Run, Strip
from pvlvrt_compliance.results import Band
from pvlvrt_compliance.results.band import ACTIVE_POWER, CURRENT, REACTIVE_CURRENT, REACTIVE_CURRENT_NEGATIVE

_COLOURS = {
    CURRENT: BLACK,
    ACTIVE_POWER: BLUE,
    REACTIVE_CURRENT: BLACK,  # as their curves
    REACTIVE_CURRENT_NEGATIVE: PURPLE,
}
_DASHES: tuple[Dash, ...] = ("dash", "dot", "dashdot", "longdash")
_WIDTH, _WIDENED_WIDTH = 1.5, 0.8
_GAP = float("nan")


def limits_of(bands: Sequence[Band], quantities: Sequence[str]) -> tuple[tuple[Line, ...], tuple[Area, ...]]:
    """Bands of what a panel shows, one for each stretch perhaps: lines, and areas of regions and of what lies below.

    What is named alike looks alike and stands in the legend once; the rest differs.
    """
    here = [band for quantity in quantities for band in bands if band.quantity == quantity]
    groups = list(dict.fromkeys(_group(band) for band in here if band.region is None))
    told: set[str] = set()
    lines: list[Line] = []
    areas: list[Area] = []
    for band in sorted(here, key=lambda band: band.widened):  # the plain limit stands in the legend
        first = _group(band) not in told
        told.add(_group(band))
        if band.region is not None:
            areas.append(_region(band, first))
            continue
        lines.append(_line(band, _DASHES[groups.index(_group(band)) % len(_DASHES)], first))
        if band.quantity.startswith("voltage_") and band.upper is None and not band.widened:
            areas.append(_below(band))
    return tuple(lines), tuple(areas)


def _group(band: Band) -> str:
    return f"{band.check} {band.quantity} {band.name}"


def _line(band: Band, dash: Dash, in_legend: bool) -> Line:
    """A band as one line there and back, so that the legend shows its edges once."""
    edges = [edge for edge in (band.upper, band.lower) if edge is not None]
    run = Run(band.t_s, edges[0])
    if len(edges) == 2:
        run = Run((*band.t_s, band.t_s[-1], *reversed(band.t_s)), (*edges[0], _GAP, *reversed(edges[1])))
    return Line(
        name=band.name,
        runs=(run,),
        colour=_COLOURS.get(band.quantity, VERMILION),
        width=_WIDENED_WIDTH if band.widened else _WIDTH,
        dash=dash,
        group=_group(band),
        in_legend=in_legend,
    )


def _below(band: Band) -> Area:
    """What lies below a floor of the voltage."""
    level = band.lower or ()
    strip = Strip(band.t_s, (0.0,) * len(level), level)
    return Area(band.name, (strip,), VERMILION, opacity=0.10, edged=False, group=_group(band), in_legend=False)


def _region(band: Band, in_legend: bool) -> Area:
    lower, upper = band.lower or (0.0,) * len(band.t_s), band.upper or band.lower or ()
    colour = of_mode(band.region or "")
    return Area(
        band.name, (Strip(band.t_s, lower, upper),), colour, opacity=0.12, group=_group(band), in_legend=in_legend
    )
