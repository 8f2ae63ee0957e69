"""Per-unit base and the spelling of values that people type (``90%``, ``500ms``, ``50Hz``)."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from pvlvrt_compliance.errors import UsageError

_NUMBER = r"[+-]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][+-]?\d++)?"  # possessive: digits are gone through once
_FRACTION = re.compile(rf"({_NUMBER})\s*(%?)")
_NOMINAL_FREQUENCIES_HZ = (50.0, 60.0)
_DURATION = re.compile(rf"({_NUMBER})\s*(ms|s)")
_QUANTITY = re.compile(rf"({_NUMBER})\s*([^\d\s.,+-].*)?")
_WITH_COMMA = re.compile(r"[+-]?\d+,(\d+)\D*")


@dataclass(frozen=True)
class Nominal:
    """Rating of an inverter: the base of every per-unit value.

    Parameters
    ----------
    apparent_power_va : float
        S_nom (VA).
    phase_voltage_v : float
        u_gnom, rms, phase to neutral (V).
    frequency_hz : float
        Nominal frequency (Hz).
    """

    apparent_power_va: float = 500e3
    phase_voltage_v: float = 230.0
    frequency_hz: float = 50.0

    @property
    def apparent_power_kva(self) -> float:
        """S_nom (kVA); 1 pu of power."""
        return self.apparent_power_va / 1e3

    @property
    def phase_voltage_peak_v(self) -> float:
        """Amplitude of the nominal phase-to-neutral voltage (V); 1 pu of voltage."""
        return math.sqrt(2) * self.phase_voltage_v

    @property
    def phase_current_peak_a(self) -> float:
        """Amplitude of the nominal phase current (A); 1 pu of current."""
        return math.sqrt(2) * self.apparent_power_va / (3 * self.phase_voltage_v)

    @property
    def voltage_ab_v(self) -> float:
        """Length of the nominal voltage space vector, power-invariant Clarke (V): sqrt(3) u_gnom."""
        return math.sqrt(3) * self.phase_voltage_v

    @property
    def current_ab_a(self) -> float:
        """Length of the nominal current space vector, power-invariant Clarke (A)."""
        return self.apparent_power_va / self.voltage_ab_v

    @property
    def impedance_ohm(self) -> float:
        """Base impedance (ohm)."""
        return 3 * self.phase_voltage_v**2 / self.apparent_power_va


def parse_fraction(text: str, what: str) -> float:
    """Read ``90%`` or ``0.9`` as a fraction between 0 and 1.

    Raises
    ------
    UsageError
        When the text is not a number, or outside 0 to 100 %.
    """
    match = _FRACTION.fullmatch(text.strip())
    if match is None:
        raise UsageError(f"{what}: {text!r} is not a fraction{_why_not(text, ('%',))}; write 90% or 0.9")
    value = float(match[1]) / (100 if match[2] else 1)
    if not 0 <= value <= 1:
        hint = f' (for {match[1]} percent write "{match[1]}%")' if not match[2] and 1 < value <= 100 else ""
        raise UsageError(f"{what}: {text!r} is outside 0% to 100%{hint}")
    return value


def parse_duration(text: str, what: str) -> float:
    """Read ``500ms`` or ``0.5s`` as seconds.

    Raises
    ------
    UsageError
        When the text has no unit, is not a number, or is not above zero.
    """
    match = _DURATION.fullmatch(text.strip())
    if match is None:
        raise UsageError(f"{what}: {text!r} is not a duration{_why_not(text, ('ms', 's'))}; write 500ms or 0.5s")
    value = float(match[1]) * (1e-3 if match[2] == "ms" else 1)
    if not (value > 0 and math.isfinite(value)):
        raise UsageError(f"{what}: {text!r} must be longer than zero")
    return value


class Quantity(NamedTuple):
    """A value that may have a unit behind it: what it is called, how it is written, and what a unit is of the first."""

    name: str
    example: str
    units: Mapping[str, float] = {}


FREQUENCY = Quantity("a frequency", "50Hz or 50", {"Hz": 1, "kHz": 1e3})
TEMPERATURE = Quantity("a temperature", "45C or 45", {"C": 1, "degC": 1, "°C": 1})
ANGLE = Quantity("an angle", "90deg or 90", {"deg": 1, "°": 1})
IRRADIANCE = Quantity("an irradiance", "800W/m2 or 800", {"W/m2": 1, "W/m²": 1, "kW/m2": 1e3, "kW/m²": 1e3})
RATIO = Quantity("a ratio", "10 or 2.5")
DATA_SIZE = Quantity(
    "a size",
    "2GB or 500MB",
    {"GB": 1, "MB": 1e-3, "kB": 1e-6, "TB": 1e3, "GiB": 2**30 / 1e9, "MiB": 2**20 / 1e9, "TiB": 2**40 / 1e9},
)


def parse_quantity(text: str, what: str, quantity: Quantity) -> float:
    """Read ``50Hz`` or ``50`` as a number in the first unit of its quantity; upper and lower case of a unit are alike.

    Raises
    ------
    UsageError
        When the text is not one finite number, or its unit is none of the quantity's.
    """
    match = _QUANTITY.fullmatch(text.strip())
    unit = _plain(match[2] or "") if match else ""
    factors = {"": 1.0} | {_plain(name): factor for name, factor in quantity.units.items()}
    if match is None or unit not in factors:
        why = _why_not(text, tuple(quantity.units))
        raise UsageError(f"{what}: {text!r} is not {quantity.name}{why}; write {quantity.example}")
    value = float(match[1]) * factors[unit]
    if not math.isfinite(value):
        raise UsageError(f"{what}: {text!r} is too large")
    return value


def _plain(unit: str) -> str:
    return unit.casefold().replace(" ", "").replace("^", "").replace("²", "2")


def _why_not(text: str, units: tuple[str, ...]) -> str:
    """What is wrong with a number that nearly is one: a comma in it, or the unit behind it."""
    if comma := _WITH_COMMA.fullmatch(text.strip()):
        spelled = [text.strip().replace(",", "."), *([text.strip().replace(",", "")] if len(comma[1]) == 3 else [])]
        return f", for it has a comma: {' or '.join(spelled)}"
    match = _QUANTITY.fullmatch(text.strip())
    if match is None or not match[2]:
        return ""
    allowed = (
        f"is none of {', '.join(units)}" if len(units) > 1 else f"is not {units[0]}" if units else "does not belong"
    )
    return f", for its unit {match[2]!r} {allowed}"


def nearest_nominal_frequency(frequency_hz: float) -> float:
    """Return 50 or 60 Hz, whichever is nearer: the nominal frequency of a grid that runs at ``frequency_hz``."""
    return min(_NOMINAL_FREQUENCIES_HZ, key=lambda nominal: abs(nominal - frequency_hz))
