"""Outputs of a controller over time, and beside what was expected of them, with the error and what it may be."""

from collections.abc import Iterator, Mapping, Sequence

from pvlvrt_compliance.report.agreement import verdict
from pvlvrt_compliance.report.drawing.colours import BLACK, BLUE, GREY, VERMILION
from pvlvrt_compliance.report.drawing.model import Axis, Line, Panel, Run
from pvlvrt_compliance.report.drawing.parts import Grid, Part, buckets_for
from pvlvrt_compliance.report.drawing.thinning import sketched
from pvlvrt_compliance.texts import shortened
from pvlvrt_compliance.waveforms.agreement import Agreement
from pvlvrt_compliance.waveforms.container import Samples, Segment

_TIME = "time (s)"
_FINE = 1e-3  # of what a curve reaches over: what may be left out of it
_LONGEST_NAME = 60


def panels(outputs: Segment, units: Mapping[str, str], agreements: Sequence[Agreement]) -> list[Panel]:
    """Two panels an output that something was expected of, one of every other.

    Parameters
    ----------
    outputs : Segment
        All of them by their names.
    units : mapping
        Of each.
    agreements : sequence of Agreement
        Of those that were compared.
    """
    compared = {each.name: each for each in agreements}
    buckets = buckets_for(len(outputs.channels) + len(compared))
    found: list[Panel] = []
    for name, samples in outputs.channels.items():
        part = _part(outputs.t0_s, outputs.dt_s, len(outputs), buckets)
        given = _line("given", samples, part, VERMILION)
        if name in compared:
            found += _beside(compared[name], given, buckets)
        else:
            found.append(_panel(f"{_short(name)}: nothing is expected", units[name], [given]))
    return found


def _beside(each: Agreement, given: Line, buckets: int) -> Iterator[Panel]:
    step_s = float(each.t_s[1] - each.t_s[0]) if len(each.t_s) > 1 else 1.0
    part = _part(float(each.t_s[0]), step_s, len(each.t_s), buckets)
    expected = _line("expected", each.expected, part, BLACK)._replace(dash="dash")
    yield _panel(f"{_short(each.name)}: {verdict(each)}", each.unit, [given, expected])
    error = _line("error: given - expected", each.found - each.expected, part, BLUE)
    span = (float(each.t_s[0]), float(each.t_s[-1]))
    bounds = [
        Line("allowed", (Run(span, (level, level)),), GREY, dash="dot", group="allowed", in_legend=level > 0)
        for level in (each.allowed, -each.allowed)
    ]
    yield _panel(f"{_short(each.name)}: error", each.unit, [error, *bounds])


def _panel(title: str, unit: str, lines: Sequence[Line]) -> Panel:
    return Panel(title=title, x=Axis(_TIME), y=Axis(unit), lines=tuple(lines))


def _part(t0_s: float, dt_s: float, count: int, buckets: int) -> Part:
    return Part(Grid(t0_s, dt_s, count), 0, count, buckets, is_band=False, offset=0, goes_on=False)


def _line(name: str, samples: Samples, part: Part, colour: str) -> Line:
    known = samples[abs(samples) < float("inf")]
    fine = _FINE * float(known.max() - known.min()) if len(known) else 0.0
    return Line(name, sketched(samples, [part], fine).runs, colour, told=True)


def _short(name: str) -> str:
    return shortened(name, _LONGEST_NAME)
