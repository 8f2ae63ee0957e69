"""Bases and ratings that a controller has of its own, beside those of the plant: by the names that they go by.

A controller that was made for 600 V and 200 kVA works on other per-unit values than the plant of 398 V and 500 kVA that
it is put to. Nothing is changed: what differs is told.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from pvlvrt_compliance.controllers.description import Description, Value
from pvlvrt_compliance.controllers.mapping.port_units import UNITS, Bases, spelled
from pvlvrt_compliance.units import Nominal

_SAME = 0.005
"""Relative: numbers that differ by less are one, as 398 V and sqrt(3) 230 V (chosen)."""


class Measure(NamedTuple):
    """A base of the plant, in one of the ways that it is stated."""

    words: str  # which way; empty: there is one only
    value: float  # SI


class Base(NamedTuple):
    """A base or rating of a controller that is not the plant's.

    Parameters
    ----------
    where : str
        ``parameter``, ``input`` (a constant that the mapping gives to it) or ``mapping`` (under ``[bases]``).
    name : str
        Of the parameter, input or key.
    value : float
        In the unit.
    unit : str
        As the controller has it, else that of its name, else SI.
    plant : tuple of Measure
        The same of the plant, in every way that the name may mean, in the unit.
    """

    where: str
    name: str
    value: float
    unit: str
    plant: tuple[Measure, ...]

    def in_words(self) -> str:
        """What the plant has; of a port or parameter amplitudes only where its name means nothing else."""
        plain = [one for one in self.plant if one.words not in (_LINE_PEAK, _PHASE_PEAK)]
        told = self.plant if self.where == "mapping" else plain or self.plant
        return " or ".join(f"{one.value:.5g} {self.unit}{f' {one.words}' if one.words else ''}" for one in told)


_LINE, _PHASE, _LINE_PEAK, _PHASE_PEAK = (
    "line to line (rms)",
    "phase to neutral (rms)",
    "line to line (peak)",
    "phase to neutral (peak)",
)
_BASE = "base|nominal|nom|rated|rating"
_KNOWN_AS: Mapping[str, tuple[str, tuple[str, ...]]] = {
    "voltage": (
        r"(v|u|voltage)(ac|g|grid|pcc|t|term|inv|conv|out)?(rms)?|(ac|grid)voltage",
        (_LINE, _PHASE, _PHASE_PEAK, _LINE_PEAK),
    ),
    "line_voltage": (
        r"(v|u)(l|ll|ltl|line|linetoline)(rms)?|(v|u)rmsll|(line|linetoline|ll)voltage(rms)?",
        (_LINE, _LINE_PEAK),
    ),
    "phase_voltage": (r"(v|u)(ln|ltn|ph|phase)(rms)?|(phase|ln)voltage(rms)?", (_PHASE, _PHASE_PEAK)),
    "peak_voltage": (r"(v|u)(ph|phase|ln)?(pk|peak|max)|peak(phase)?voltage", (_PHASE_PEAK,)),
    "dc_voltage": (r"(v|u|voltage)dc(link|bus)?|dc(link|bus)?(v|voltage)|(v|u)link", ()),
    "current": (r"(i|current)(ac|g|grid|inv|ph|phase|l|out)?(rms|pk|peak)?|phasecurrent", ("(rms)", "(peak)")),
    "apparent_power": (r"s|p|mva|kva|va|mw|kw|m|(apparent|active|ac)?power|(apparent|active)", ()),
    "frequency": (r"f|fr|freq|frequency|fgrid|gridfrequency", ()),
    "angular_frequency": (r"w|om|omega|angularfrequency", ()),
}
"""Names without the word for a base (``VLL`` of ``VLLbase``), by what they are bases of, and how that is stated."""

_SHORT = {
    **dict.fromkeys(("vn", "un"), "voltage"),
    **dict.fromkeys(("vlln", "ulln", "vbll", "ubll"), "line_voltage"),
    **dict.fromkeys(("vdcn", "udcn"), "dc_voltage"),
    **dict.fromkeys(("sn", "sb", "pn"), "apparent_power"),
    **dict.fromkeys(("fn", "f0"), "frequency"),
    **dict.fromkeys(("w0", "wb", "omega0", "omegab", "omegan"), "angular_frequency"),
}
"""Names that have one letter for that word; not those that may be a phase, an initial value or a natural frequency."""

_UNITS_OF = {
    **dict.fromkeys(("line_voltage", "phase_voltage", "peak_voltage"), "voltage"),
    "angular_frequency": "frequency",
}
_WHERE = dict.fromkeys(("frequency", "angular_frequency"), "unless the profile says otherwise")
_WITH_UNIT = re.compile(r"(?P<name>.+?)(?P<unit>_(?i:kv|v|ka|a|mva|kva|va|mw|kw|w|hz)|kV|V|kA|MVA|kVA|VA|MW|kW|Hz)")
"""A name that ends in its unit: ``Sbase_MVA``, ``VLLbase_kv``, ``fnomHz``."""

_IN_NAMES = {"mva": "MVA", "mw": "MW", "kva": "kVA", "kw": "kW", "m": "MVA"}


def differing(
    description: Description,
    values: Mapping[str, Value],
    bases: Bases | None,
    nominal: Nominal,
    dc_voltage_v: float,
) -> tuple[Base, ...]:
    """Bases of a controller that are not the plant's.

    Parameters
    ----------
    description : Description
    values : mapping
        Its parameters, by name, as they are run.
    bases : Bases or None
        Of its mapping file.
    nominal : Nominal
        Of the plant.
    dc_voltage_v : float
        Nominal voltage of the plant's DC link (V).
    """
    plant = _of_the_plant(nominal, dc_voltage_v)
    candidates = [
        *(("parameter", p.name, values[p.name], p.unit) for p in description.parameters),
        *(("input", p.name, _constant(p.mapped_to), p.unit) for p in description.inputs if p.width == 1),
    ]
    found = [base for candidate in candidates for base in _named(*candidate, plant)]
    return tuple(base for base in [*found, *_of_mapping(bases, plant)] if not _is_of_the_plant(base))


def _of_the_plant(nominal: Nominal, dc_voltage_v: float) -> Mapping[str, Sequence[Measure]]:
    """Its bases, by what they are bases of."""
    rms, current = nominal.phase_voltage_v, nominal.phase_current_peak_a / 2**0.5
    voltages = {_LINE: 3**0.5 * rms, _PHASE: rms, _LINE_PEAK: 6**0.5 * rms, _PHASE_PEAK: 2**0.5 * rms}
    currents = {"(rms)": current, "(peak)": 2**0.5 * current}
    single = {
        "dc_voltage": dc_voltage_v,
        "apparent_power": nominal.apparent_power_va,
        "frequency": nominal.frequency_hz,
        "angular_frequency": nominal.frequency_hz,  # the unit makes rad/s of it
    }
    return {
        what: [Measure(way, (voltages | currents)[way]) for way in ways]
        or [Measure(_WHERE.get(what, ""), single[what])]
        for what, (_, ways) in _KNOWN_AS.items()
    }


def _named(
    where: str, name: str, value: Value | None, unit: str, plant: Mapping[str, Sequence[Measure]]
) -> Iterator[Base]:
    """The base that a name means, if it means one."""
    what, in_name = _meaning(name)
    if what is None or isinstance(value, (bool, str)) or value is None or value <= 0:
        return
    units = _units_of(what)
    said = _unit_in(unit, units) or (in_name if in_name in units else "")
    if spelled(unit) == "pu" or (unit and not said):
        return
    said = said or ("rad/s" if what == "angular_frequency" else _si(units))
    measures = tuple(Measure(words, units[said] * number) for words, number in plant[what])
    yield Base(where, name, float(value), unit or said, measures)


def _units_of(what: str) -> Mapping[str, float]:
    """Units of a base; that of power may be stated as one of active power."""
    more = UNITS["active_power"] if what == "apparent_power" else {}
    return {**UNITS[_UNITS_OF.get(what, what)], **more}


def _meaning(name: str) -> tuple[str | None, str]:
    """What a name is a base of, and the unit that it names."""
    what, unit = _meant(name)
    if what is None and (match := _WITH_UNIT.fullmatch(name)):
        what, unit = _meant(match["name"])[0], spelled(match["unit"].lstrip("_"))
        if what is not None and unit not in _units_of(what):
            return None, ""
    return what, unit


def _meant(name: str) -> tuple[str | None, str]:
    """The same of a name that no unit stands behind."""
    key = re.sub(r"[^a-z0-9]", "", name.casefold())
    if key in _SHORT:
        return _SHORT[key], ""
    for pattern in (rf"(?P<stem>.+?)({_BASE})", rf"({_BASE})(?P<stem>.+)"):
        if match := re.fullmatch(pattern, key):
            stem = match["stem"]
            what = next((what for what, (stems, _) in _KNOWN_AS.items() if re.fullmatch(stems, stem)), None)
            if what is not None:
                return what, _IN_NAMES.get(stem, "")
    return None, ""


def _unit_in(unit: str, units: Mapping[str, float]) -> str:
    """The unit that a text begins with: ``V (rms)`` is in V."""
    words = re.split(r"[\s,;()\[\]]+", unit.strip(" ()[]"))
    return next((spelled(text) for text in (unit, *words[:1]) if spelled(text) in units), "")


def _constant(mapped_to: str | None) -> float | None:
    """Number that an input is given always, if it is given one."""
    try:
        return float(mapped_to or "")
    except ValueError:
        return None


def _of_mapping(bases: Bases | None, plant: Mapping[str, Sequence[Measure]]) -> Iterator[Base]:
    """What the mapping file has as 1 pu, in numbers."""
    keys = {
        "voltage_v": "voltage",
        "current_a": "current",
        "power_va": "apparent_power",
        "dc_voltage_v": "dc_voltage",
        "frequency_hz": "frequency",
    }
    for key, what in keys.items():
        value = getattr(bases, key, None)
        if value is not None:
            yield Base("mapping", key, value, _si(UNITS[what]), tuple(plant[what]))


def _si(units: Mapping[str, float]) -> str:
    return next(unit for unit, factor in units.items() if factor == 1.0)


def _is_of_the_plant(base: Base) -> bool:
    return any(abs(base.value - one.value) <= _SAME * one.value for one in base.plant)


def beside(bases: Iterable[Base], where: str) -> dict[str, str]:
    """What the plant has, by the names of one place."""
    return {base.name: base.in_words() for base in bases if base.where == where}
