"""The series of the evidence that the panels of a test show."""

from collections.abc import Callable, Collection, Iterator, Sequence
from itertools import cycle
from typing import NamedTuple, get_args

import numpy as np

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.evidence.frequency import frequency_hz
from pvlvrt_compliance.evidence.no_load import no_load_series_pu
from pvlvrt_compliance.evidence.voltages import voltage_quantity_pu
from pvlvrt_compliance.profile.curves import VoltageQuantity
from pvlvrt_compliance.report.drawing.colours import BLACK, BLUE, FURTHER, GREY, PHASES, PURPLE
from pvlvrt_compliance.results import Band
from pvlvrt_compliance.results import band as of
from pvlvrt_compliance.waveforms.container import Samples

NO_LOAD = "V<sup>+</sup> without the inverter's current"

_SAME_PU = 0.005  # what a V+ of the source may differ by from that at the terminals before it is drawn, too
_FINE_PU, _FINE_POWER, _FINE_V, _FINE_HZ = 2e-4, 2e-4, 0.05, 5e-4  # what nobody sees; of a power a part of the rated
_FINE_RIPPLE_V = 1e-3


class Shown(NamedTuple):
    """A series as a curve: its name and colour, and what is left out of it; faint behind what was judged."""

    name: str
    colour: str
    series: Callable[[], Samples]  # shape (n,)
    fine: float
    is_faint: bool = False
    of_a_phase: bool = False

    @property
    def is_wave(self) -> bool:
        """Whether it is instantaneous."""
        return self.is_faint or self.of_a_phase


class Group(NamedTuple):
    """The series of one panel, and the quantities whose limits stand there."""

    key: str
    title: str
    unit: str
    height: float
    shown: Sequence[Shown]
    quantities: Sequence[str]
    from_zero: bool = False
    of_phases: bool = False  # whether it shows instantaneous values of the phases
    bands: Sequence[Band] | None = None  # the limits as this panel shows them; none: those of the quantities


def groups_of(evidence: Evidence, bands: Sequence[Band]) -> list[Group]:
    """Everything that a test is drawn by; parts of it only where it is limited, by one of the bands, or moves."""
    limited = {band.quantity for band in bands}
    groups = [
        Group(
            "voltages",
            "Phase-to-neutral voltages",
            "pu",
            1.0,
            _phases("u", lambda: evidence.voltage_pu),
            (),
            of_phases=True,
        ),
        _voltages(evidence, limited),
        _currents(evidence),
    ]
    if evidence.disturbance.frequency_moves or of.FREQUENCY in limited:
        groups.insert(2, Group("frequency", "Frequency", "Hz", 0.8, [_frequency(evidence)], (of.FREQUENCY,)))
    if shown := [shown for name, shown in _reactive(evidence).items() if name in limited]:
        quantities = (of.REACTIVE_CURRENT, of.REACTIVE_CURRENT_NEGATIVE)
        title = "Reactive currents of the sequences, one cycle"
        groups.append(Group("reactive_current", title, "pu", 1.0, shown, quantities))
    if of.REACTIVE_SHARE in limited:
        share = Shown("share", BLACK, lambda: evidence.reactive_share, 1e-3)
        groups.append(Group("share", "Share of the reactive current", "", 0.8, [share], (of.REACTIVE_SHARE,)))
    return [*groups, *_powers(evidence, bands), *_dc_voltage(evidence, bands)]


def known(shown: Shown) -> Samples | None:
    """The samples of a series; None where a recording is without its channels, or it is known nowhere."""
    try:
        found = shown.series()
    except MeasurementError:
        return None
    return found if np.isfinite(found[:1]).all() or np.isfinite(found).any() else None


def _phases(kind: str, series: Callable[[], Samples]) -> list[Shown]:
    return [
        Shown(f"{kind}<sub>{name}</sub>", colour, lambda k=k: series()[k], _FINE_PU, of_a_phase=True)  # type: ignore[misc]
        for k, (name, colour) in enumerate(PHASES.items())
    ]


def _voltages(evidence: Evidence, limited: Collection[str]) -> Group:
    """One-cycle V+ and V-, and the voltages that limits are of: without the inverter's current where that is known."""
    limits = {of.voltage_in(name) for name in limited}
    judged = [name for name in get_args(VoltageQuantity) if name != "positive_sequence" and name in limits]
    shown = [
        Shown("V<sup>+</sup>", BLACK, lambda: evidence.voltage_positive_pu, _FINE_PU),
        Shown("V<sup>−</sup>", PURPLE, lambda: evidence.voltage_negative_pu, _FINE_PU),
        Shown(NO_LOAD, GREY, lambda: _no_load(evidence), _FINE_PU),
        *(_judged(evidence, name, colour) for name, colour in zip(judged, cycle(FURTHER), strict=False)),
    ]
    title = "One-cycle voltages" if judged else "Sequence voltages, one cycle"
    quantities = (of.VOLTAGE_POSITIVE, of.VOLTAGE_NEGATIVE, *map(of.voltage_band, judged))
    return Group("sequences", title, "pu", 1.0, shown, quantities, from_zero=True)


def _judged(evidence: Evidence, quantity: VoltageQuantity, colour: str) -> Shown:
    name = quantity.replace("_", " ")
    return Shown(name, colour, lambda: voltage_quantity_pu(evidence, quantity, "no_load"), _FINE_PU)


def _no_load(evidence: Evidence) -> Samples:
    """V+ of the source, known nowhere where it is all along that of the terminals."""
    source = no_load_series_pu(evidence, 0)
    apart = np.abs(source - evidence.voltage_positive_pu)
    return source if ((apart > _SAME_PU) & (apart < np.inf)).any() else np.full(len(source), np.nan)


def _frequency(evidence: Evidence) -> Shown:
    return Shown("f", BLACK, lambda: frequency_hz(evidence), _FINE_HZ)


def _currents(evidence: Evidence) -> Group:
    """Instantaneous, and the largest of the three fundamental amplitudes, which is what limits are held against."""
    largest = Shown("largest fundamental", BLACK, lambda: np.max(evidence.current_phase_pu, axis=0), _FINE_PU)
    shown = [*_phases("i", lambda: evidence.current_pu), largest]
    return Group("currents", "Phase currents", "pu", 1.2, shown, (of.CURRENT,), of_phases=True)


def _reactive(evidence: Evidence) -> dict[str, Shown]:
    return {
        of.REACTIVE_CURRENT: Shown("positive", BLACK, lambda: evidence.reactive_current_pu, _FINE_PU),
        of.REACTIVE_CURRENT_NEGATIVE: Shown(
            "negative", PURPLE, lambda: evidence.reactive_current_negative_pu, _FINE_PU
        ),
    }


def _powers(evidence: Evidence, bands: Sequence[Band]) -> Iterator[Group]:
    """P and Q: instantaneous, and their means over a cycle and, where those are judged, over half a cycle."""
    fine = _FINE_POWER * evidence.nominal.apparent_power_kva
    halves = {band.quantity for band in bands if band.half_cycle}
    instantaneous = (lambda: evidence.instantaneous_kva.p, lambda: evidence.instantaneous_kva.q)
    half_cycle = (lambda: evidence.half_cycle_kva.p, lambda: evidence.half_cycle_kva.q)
    means = (lambda: evidence.active_power_kw, lambda: evidence.reactive_power_kvar)
    for k, (key, title, unit, name, quantity) in enumerate(_POWERS):
        shown = [
            Shown(f"{name.lower()}(t)", GREY, instantaneous[k], fine, is_faint=True),
            *([Shown(f"{name}, half cycle", BLUE, half_cycle[k], fine)] if quantity in halves else []),
            Shown(name, BLACK, means[k], fine),
        ]
        yield Group(key, title, unit, 1.2, shown, (quantity,))


_POWERS = (
    ("active_power", "Active power", "kW", "P", of.ACTIVE_POWER),
    ("reactive_power", "Reactive power", "kvar", "Q", of.REACTIVE_POWER),
)


def _dc_voltage(evidence: Evidence, bands: Sequence[Band]) -> Iterator[Group]:
    """The DC voltage, and, where its ripple is judged, what is left of it about the lines that the limits lie about."""
    shown = Shown("v<sub>DC</sub>", BLACK, lambda: evidence.dc_voltage_v, _FINE_V)
    limits = [band for band in bands if band.quantity == of.DC_VOLTAGE]
    ripple = [band for band in limits if band.about_its_line]
    yield Group(
        "dc_voltage",
        "DC voltage",
        "V",
        0.8,
        [shown],
        (of.DC_VOLTAGE,) if len(ripple) < len(limits) else (),
        bands=[band for band in limits if not band.about_its_line],
    )
    if ripple:
        rest = Shown("v<sub>DC</sub> less its line", BLACK, lambda: _about_lines(evidence, ripple), _FINE_RIPPLE_V)
        bare = [_without_line(band) for band in ripple]
        yield Group("dc_ripple", "Ripple of the DC voltage", "V", 0.8, [rest], (of.DC_VOLTAGE,), bands=bare)


def _about_lines(evidence: Evidence, bands: Sequence[Band]) -> Samples:
    """The DC voltage less the line midway between the limits of each band, known nowhere else, shape (n,)."""
    rest = np.full(len(evidence.t_s), np.nan)
    for band in bands:
        inside = evidence.between(band.t_s[0], band.t_s[-1])
        rest[inside] = evidence.dc_voltage_v[inside] - np.interp(evidence.t_s[inside], band.t_s, _middle(band))
    return rest


def _middle(band: Band) -> Samples:
    middle: Samples = (np.asarray(band.lower) + np.asarray(band.upper)) / 2
    return middle


def _without_line(band: Band) -> Band:
    middle = _middle(band)
    lower, upper = (tuple((np.asarray(edge) - middle).tolist()) for edge in (band.lower, band.upper))
    return band.model_copy(update={"lower": lower, "upper": upper})
