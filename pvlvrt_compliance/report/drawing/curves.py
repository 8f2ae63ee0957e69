"""The series of the evidence that the panels of a test show."""

from collections.abc import Callable, Collection, Sequence
from itertools import cycle
from typing import NamedTuple, get_args

import numpy as np

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.evidence.frequency import frequency_hz
from pvlvrt_compliance.evidence.no_load import no_load_series_pu
from pvlvrt_compliance.evidence.voltages import voltage_quantity_pu
from pvlvrt_compliance.profile.curves import VoltageQuantity
from pvlvrt_compliance.report.drawing.colours import BLACK, FURTHER, GREY, PHASES, PURPLE
from pvlvrt_compliance.results import band as of
from pvlvrt_compliance.waveforms.container import Samples

NO_LOAD = "V<sup>+</sup> without the inverter's current"

_SAME_PU = 0.005  # what a V+ of the source may differ by from that at the terminals before it is drawn, too
_FINE_PU, _FINE_POWER, _FINE_V, _FINE_HZ = 2e-4, 2e-4, 0.05, 5e-4  # what nobody sees; of a power a part of the rated


class Shown(NamedTuple):
    """A series as a curve: its name and colour, and what is left out of it; faint behind what was judged."""

    name: str
    colour: str
    series: Callable[[], Samples]  # shape (n,)
    fine: float
    is_faint: bool = False


class Group(NamedTuple):
    """The series of one panel, and the quantities whose limits stand there."""

    title: str
    unit: str
    height: float
    shown: Sequence[Shown]
    quantities: Sequence[str]
    from_zero: bool = False


def groups_of(evidence: Evidence, limited: Collection[str]) -> list[Group]:
    """Everything that a test is drawn by; parts of it only where it is limited (names of `Band`) or moves."""
    groups = [
        Group("Phase-to-neutral voltages", "pu", 1.0, _phases("u", lambda: evidence.voltage_pu), ()),
        _voltages(evidence, limited),
        _currents(evidence),
        _powers(evidence),
        Group("DC voltage", "V", 0.8, [_dc_voltage(evidence)], (of.DC_VOLTAGE,)),
    ]
    if evidence.disturbance.frequency_moves or of.FREQUENCY in limited:
        groups.insert(2, Group("Frequency", "Hz", 0.8, [_frequency(evidence)], (of.FREQUENCY,)))
    if shown := [shown for name, shown in _reactive(evidence).items() if name in limited]:
        quantities = (of.REACTIVE_CURRENT, of.REACTIVE_CURRENT_NEGATIVE)
        groups.insert(-2, Group("Reactive currents of the sequences, one cycle", "pu", 1.0, shown, quantities))
    if of.REACTIVE_SHARE in limited:
        share = Shown("share", BLACK, lambda: evidence.reactive_share, 1e-3)
        groups.insert(-2, Group("Share of the reactive current", "", 0.8, [share], (of.REACTIVE_SHARE,)))
    return groups


def known(shown: Shown) -> Samples | None:
    """The samples of a series; None where a recording is without its channels, or it is known nowhere."""
    try:
        found = shown.series()
    except MeasurementError:
        return None
    return found if np.isfinite(found).any() else None


def _phases(kind: str, series: Callable[[], Samples]) -> list[Shown]:
    return [
        Shown(f"{kind}<sub>{name}</sub>", colour, lambda k=k: series()[k], _FINE_PU)  # type: ignore[misc]
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
    return Group(title, "pu", 1.0, shown, quantities, from_zero=True)


def _judged(evidence: Evidence, quantity: VoltageQuantity, colour: str) -> Shown:
    name = quantity.replace("_", " ")
    return Shown(name, colour, lambda: voltage_quantity_pu(evidence, quantity, "no_load"), _FINE_PU)


def _no_load(evidence: Evidence) -> Samples:
    """V+ of the source, known nowhere where it is all along that of the terminals."""
    source = no_load_series_pu(evidence, 0)
    apart = np.abs(source - evidence.voltage_positive_pu)
    return source if (apart[np.isfinite(apart)] > _SAME_PU).any() else np.full(len(source), np.nan)


def _frequency(evidence: Evidence) -> Shown:
    return Shown("f", BLACK, lambda: frequency_hz(evidence), _FINE_HZ)


def _currents(evidence: Evidence) -> Group:
    """Instantaneous, and the largest of the three fundamental amplitudes, which is what limits are held against."""
    largest = Shown("largest fundamental", BLACK, lambda: np.max(evidence.current_phase_pu, axis=0), _FINE_PU)
    shown = [*_phases("i", lambda: evidence.current_pu), largest]
    return Group("Phase currents", "pu", 1.2, shown, (of.CURRENT,))


def _reactive(evidence: Evidence) -> dict[str, Shown]:
    return {
        of.REACTIVE_CURRENT: Shown("positive", BLACK, lambda: evidence.reactive_current_pu, _FINE_PU),
        of.REACTIVE_CURRENT_NEGATIVE: Shown(
            "negative", PURPLE, lambda: evidence.reactive_current_negative_pu, _FINE_PU
        ),
    }


def _powers(evidence: Evidence) -> Group:
    """Instantaneous, and their means over a cycle, which are judged."""
    fine = _FINE_POWER * evidence.nominal.apparent_power_kva
    shown = [
        Shown("p(t)", BLACK, lambda: evidence.instantaneous_kva.p, fine, is_faint=True),
        Shown("q(t)", PURPLE, lambda: evidence.instantaneous_kva.q, fine, is_faint=True),
        Shown("P", BLACK, lambda: evidence.active_power_kw, fine),
        Shown("Q", PURPLE, lambda: evidence.reactive_power_kvar, fine),
    ]
    return Group("Active and reactive power", "kW, kvar", 1.7, shown, (of.ACTIVE_POWER, of.REACTIVE_POWER))


def _dc_voltage(evidence: Evidence) -> Shown:
    return Shown("v<sub>DC</sub>", BLACK, lambda: evidence.dc_voltage_v, _FINE_V)
