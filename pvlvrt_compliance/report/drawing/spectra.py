"""Harmonics as bars by order, beside the limits that the verdict held them against."""

from collections.abc import Sequence

from pvlvrt_compliance.report.drawing.colours import BLUE, GREY, VERMILION
from pvlvrt_compliance.report.drawing.model import Axis, Bars, Line, Panel, Run, Spot, Text
from pvlvrt_compliance.report.format import number
from pvlvrt_compliance.results import Spectrum, SpectrumBar, TestResult

_WIDTH, _REACH = 0.38, 0.45  # of a bar, and of a limit to either side of its order
_APART = 2  # orders between the last one and a total
_LOOKS = (("before", BLUE), ("after", GREY))


def panels(result: TestResult) -> tuple[Panel, ...]:
    """A panel for each check that judged a spectrum."""
    checks = dict.fromkeys(spectrum.check for spectrum in result.spectra)
    return tuple(_panel([one for one in result.spectra if one.check == check]) for check in checks)


def _panel(spectra: Sequence[Spectrum]) -> Panel:
    places = _places(spectra)
    limits = {places[_name(bar)]: bar.limit for spectrum in spectra for bar in spectrum.bars}
    runs = tuple(Run((at - _REACH, at + _REACH), (limit, limit)) for at, limit in sorted(limits.items()))
    return Panel(
        title="Harmonics of the current",
        x=Axis("order of the harmonic"),
        y=Axis(spectra[0].unit, from_zero=True),
        lines=(Line("limit", runs, VERMILION, 1.5),),
        height=1.4,
        key="harmonics",
        says=_says(spectra),
        over="other",
        bars=tuple(_bars(spectrum, k, len(spectra), places) for k, spectrum in enumerate(spectra)),
        spots=tuple(_totals(spectra, places)),
    )


def _name(bar: SpectrumBar) -> str:
    return bar.name if bar.order is None else str(bar.order)


def _places(spectra: Sequence[Spectrum]) -> dict[str, float]:
    """Where each component stands: an order at its number, totals beyond the last of them."""
    bars = [bar for spectrum in spectra for bar in spectrum.bars]
    last = max((bar.order for bar in bars if bar.order is not None), default=0)
    totals = dict.fromkeys(bar.name for bar in bars if bar.order is None)
    beyond = {name: float(last + _APART * (k + 1)) for k, name in enumerate(totals)}
    return {_name(bar): beyond[bar.name] if bar.order is None else float(bar.order) for bar in bars}


def _bars(spectrum: Spectrum, number_of: int, count: int, places: dict[str, float]) -> Bars:
    """The components of one window; those of several stand side by side."""
    name, colour = _LOOKS[min(number_of, len(_LOOKS) - 1)]
    width = 2 * _WIDTH / count
    aside = (number_of - (count - 1) / 2) * width
    at = tuple(places[_name(bar)] + aside for bar in spectrum.bars)
    return Bars(name, at, tuple(bar.measured for bar in spectrum.bars), width, colour)


def _totals(spectra: Sequence[Spectrum], places: dict[str, float]) -> list[Spot]:
    """Names of the totals, above bar and limit."""
    tops: dict[str, float] = {}
    for bar in (bar for spectrum in spectra for bar in spectrum.bars if bar.order is None):
        tops[bar.name] = max(tops.get(bar.name, 0.0), bar.measured, bar.limit)
    return [Spot(places[name], top, Text("figure.harmonics.total", {"name": name})) for name, top in tops.items()]


def _says(spectra: Sequence[Spectrum]) -> Text:
    """The component that is nearest to its limit, or the furthest beyond it."""
    spectrum, bar = min(
        ((spectrum, bar) for spectrum in spectra for bar in spectrum.bars),
        key=lambda one: (one[1].limit - one[1].measured) / one[1].limit,
    )
    kept = "kept" if bar.measured <= bar.limit else "failed"
    return Text(
        f"figure.harmonics.{kept}_{'total' if bar.order is None else 'order'}",
        {
            "name": _name(bar),
            "phase": bar.phase,
            "measured": number(bar.measured, spectrum.unit),
            "limit": number(bar.limit, spectrum.unit),
            "begin": f"{spectrum.start_s:.3f}",
            "end": f"{spectrum.end_s:.3f}",
        },
    )
