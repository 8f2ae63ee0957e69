"""What the figure of a test shows: panels of signals, each with its limits."""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import cycle
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.fourier import ComplexSamples
from pvlvrt_compliance.measure.phase_quantities import VOLTAGES, voltage_amplitude
from pvlvrt_compliance.measure.power import instantaneous_power
from pvlvrt_compliance.measure.sequences import sequence_phasors
from pvlvrt_compliance.report.decimation import BUCKETS, Samples, Trace, decimate
from pvlvrt_compliance.results import Band, TestResult
from pvlvrt_compliance.results.band import (
    ACTIVE_POWER,
    CURRENT,
    DC_VOLTAGE,
    REACTIVE_POWER,
    VOLTAGE_NEGATIVE,
    VOLTAGE_POSITIVE,
    voltage_band,
    voltage_in,
)
from pvlvrt_compliance.space_vectors import phases
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Segment, Waveforms
from pvlvrt_compliance.waveforms.joining import one_cycle_series

# Tol's high-contrast colours for the phases: told apart with every common colour blindness and in grey on paper.
_PHASE_COLOURS = {"a": "#004488", "b": "#DDAA33", "c": "#BB5566"}
BLUE, VERMILION, PURPLE, GREY, BLACK = "#0072B2", "#C44E00", "#9A3D8F", "#767676", "#222222"
_JUDGED_COLOURS = ("#117733", "#0072B2", "#882255")
_VOLTAGES = (VOLTAGE_POSITIVE, VOLTAGE_NEGATIVE)
_LIMIT_COLOURS = {CURRENT: BLACK, ACTIVE_POWER: BLUE}
_NO_LOAD, _SAME_PU = "V<sup>+</sup> without the inverter's current", 0.005
_DASHES = ("dash", "dot", "dashdot", "longdash")


class Curve(NamedTuple):
    """A signal, one trace a segment of the record."""

    name: str
    colour: str
    traces: Sequence[Trace]


class Line(NamedTuple):
    """A limit: straight lines through points (s, unit of the panel); ``area`` shades what lies below.

    Of a ``group`` one stands in the legend for all, and shows and hides them together.
    """

    name: str
    x: Sequence[float]
    y: Sequence[float]
    dash: str = "dash"
    colour: str = BLACK
    area: bool = False
    group: str = ""
    in_legend: bool = True


class Panel(NamedTuple):
    """One set of axes, ``height`` relative to the others."""

    title: str
    unit: str
    height: float
    curves: Sequence[Curve]
    lines: Sequence[Line] = ()
    from_zero: bool = False


Signals = Mapping[str, tuple[str, Samples]]
"""Colour and samples of the signals of a panel, by name, for one segment."""


def panels(waveforms: Waveforms, test: TestResult, nominal: Nominal, buckets: int = BUCKETS) -> list[Panel]:
    """Panels of a test; one whose channels the record does not hold is left out."""
    before = test.measurements.before
    frequency_hz = (before.frequency_hz if before else None) or nominal.frequency_hz
    curves = partial(_curves, waveforms, _shares(waveforms, buckets))
    voltage = curves(_each(waveforms, lambda s: _three_phase(s, "u", nominal.phase_voltage_peak_v)))
    judged = sorted({voltage_in(band.quantity) for band in test.bands} & set(VOLTAGES))
    sequences = curves(_voltages(waveforms, frequency_hz, nominal, judged))
    current = curves(_each(waveforms, lambda s: _three_phase(s, "i", nominal.phase_current_peak_a)))
    power = curves(_each(waveforms, _power))
    dc_voltage = curves(_each(waveforms, lambda s: {"v<sub>DC</sub>": (BLACK, s["v_dc_v"])}))
    limits = partial(_limits, test.bands)
    found = [
        Panel("Phase-to-neutral voltages", "pu", 1.0, voltage),
        Panel(_title(judged), "pu", 1.0, sequences, limits(*_VOLTAGES, *map(voltage_band, judged)), True),
        Panel("Phase currents", "pu", 1.2, current, limits(CURRENT)),
        Panel("Active and reactive power", "kW, kvar", 1.2, power, limits(ACTIVE_POWER, REACTIVE_POWER)),
        Panel("DC voltage", "V", 0.8, dc_voltage, limits(DC_VOLTAGE)),
    ]
    return [panel for panel in found if panel.curves]


def _title(judged: Sequence[str]) -> str:
    return "One-cycle voltages" if judged else "Sequence voltages, one cycle"


def _limits(bands: Sequence[Band], *quantities: str) -> list[Line]:
    """Bands of what a panel shows, one for each stretch perhaps; what is named alike looks alike, the rest differs."""
    here = [band for quantity in quantities for band in bands if band.quantity == quantity]
    groups = list(dict.fromkeys(map(_group, here)))
    seen: set[str] = set()
    lines: list[Line] = []
    for band in here:
        group = _group(band)
        dash = _DASHES[groups.index(group) % len(_DASHES)]
        lines.append(_line(band, dash)._replace(group=group, in_legend=group not in seen))
        seen.add(group)
    return lines


def _group(band: Band) -> str:
    return f"{band.check} {band.quantity} {band.name}"


def _line(band: Band, dash: str) -> Line:
    """A band as one line there and back, so that the legend shows its edges once; below a floor alone it is shaded."""
    colour = _LIMIT_COLOURS.get(band.quantity, VERMILION)
    edges = [edge for edge in (band.upper, band.lower) if edge is not None]
    if len(edges) == 1:
        area = band.quantity.startswith("voltage_") and band.upper is None
        return Line(band.name, band.t_s, edges[0], dash, colour, area=area)
    x = [*band.t_s, band.t_s[-1], *reversed(band.t_s)]
    return Line(band.name, x, [*edges[0], np.nan, *reversed(edges[1])], dash, colour)


def _curves(waveforms: Waveforms, shares: Sequence[int], signals: Sequence[Signals]) -> list[Curve]:
    """Curves by name, from the signals that could be had of each segment."""
    colours: dict[str, str] = {}
    traces: dict[str, list[Trace]] = {}
    for segment, share, found in zip(waveforms, shares, signals, strict=True):
        for name, (colour, samples) in found.items():
            colours[name] = colour
            traces.setdefault(name, []).append(_without_leading_gap(segment, samples, share))
    return [Curve(name, colours[name], traces[name]) for name in traces]


def _shares(waveforms: Waveforms, buckets: int) -> list[int]:
    """Buckets of each segment: the finer it is recorded, the more happens there, so its samples count for more."""
    finest = min(segment.dt_s for segment in waveforms)
    weights = [len(segment) * math.sqrt(finest / segment.dt_s) for segment in waveforms]
    return [max(int(buckets * weight / sum(weights)), 1) for weight in weights]


def _each(waveforms: Waveforms, signals_of: Callable[[Segment], Signals]) -> list[Signals]:
    """Signals of each segment; none where a recording is without their channels."""

    def found(segment: Segment) -> Signals:
        try:
            return signals_of(segment)
        except MeasurementError:
            return {}

    return [found(segment) for segment in waveforms]


def _without_leading_gap(segment: Segment, samples: Samples, buckets: int) -> Trace:
    valid = np.flatnonzero(np.isfinite(samples))
    first = int(valid[0]) if len(valid) else 0
    return decimate(segment.t0_s + first * segment.dt_s, segment.dt_s, samples[first:], buckets)


def _three_phase(segment: Segment, kind: str, base: float) -> Signals:
    found = segment.three_phase(kind)._asdict()
    return {f"{kind}<sub>{name}</sub>": (_PHASE_COLOURS[name], x / base) for name, x in found.items()}


def _voltages(waveforms: Waveforms, frequency_hz: float, nominal: Nominal, judged: Sequence[str]) -> list[Signals]:
    """One-cycle V+ and V- of each segment and the voltages that limits are of; none where they cannot be measured.

    Limits let an inverter go by the voltage without its current: those are of the source, where the record has it, and
    V+ of the source is drawn where it is not that at the terminals.
    """
    source = "u0" if "u0_a_v" in waveforms.names else "u"

    def series(segment: Segment) -> Samples:
        try:
            at_terminals, of_source = (sequence_phasors(segment, kind, frequency_hz) for kind in ("u", source))
        except MeasurementError:  # without these channels, or sampled too thinly
            return np.full((3 + len(judged), len(segment)), np.nan)
        of_phases: ComplexSamples = np.asarray(phases(*of_source), dtype=np.complex128) / nominal.phase_voltage_peak_v
        sequences = np.abs([at_terminals.positive, at_terminals.negative, of_source.positive])
        limited = (voltage_amplitude(of_phases, quantity) for quantity in judged)
        return np.stack([*(sequences / nominal.phase_voltage_peak_v), *limited])

    named = [("V<sup>+</sup>", BLACK), ("V<sup>−</sup>", PURPLE), (_NO_LOAD, GREY)]
    named += [(name.replace("_", " "), colour) for name, colour in zip(judged, cycle(_JUDGED_COLOURS), strict=False)]
    found = one_cycle_series(waveforms, series, frequency_hz)
    known = np.abs(np.concatenate([x[2] - x[0] for x in found]))
    hidden = set() if (known[np.isfinite(known)] > _SAME_PU).any() else {_NO_LOAD}
    return [
        {name: (colour, x) for (name, colour), x in zip(named, part, strict=True) if name not in hidden}
        if np.isfinite(part[0]).any()
        else {}
        for part in found
    ]


def _power(segment: Segment) -> Signals:
    power = instantaneous_power(segment)
    return {"P": (BLACK, power.p / 1e3), "Q": (PURPLE, power.q / 1e3)}
