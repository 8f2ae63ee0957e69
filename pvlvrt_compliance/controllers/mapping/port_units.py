"""Units of ports: how many units of a port one SI unit of a signal is."""

from collections.abc import Mapping
from typing import Literal, NamedTuple

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.units import Nominal

TWO_PI = 6.283185307179586
PER_UNIT = "pu"

_VOLTAGES = {"V": 1.0, "kV": 1e-3}
_CURRENTS = {"A": 1.0, "kA": 1e-3}
_FREQUENCIES = {"Hz": 1.0, "kHz": 1e-3, "rad/s": TWO_PI}
_TIMES = {"s": 1.0, "ms": 1e3, "us": 1e6}
_NUMBERS = {"1": 1.0}

UNITS: Mapping[str, Mapping[str, float]] = {
    "voltage": _VOLTAGES,
    "current": _CURRENTS,
    "dc_voltage": _VOLTAGES,
    "dc_current": _CURRENTS,
    "active_power": {"W": 1.0, "kW": 1e-3, "MW": 1e-6},
    "reactive_power": {"var": 1.0, "kvar": 1e-3, "Mvar": 1e-6},
    "apparent_power": {"VA": 1.0, "kVA": 1e-3, "MVA": 1e-6},
    "frequency": _FREQUENCIES,
    "time": _TIMES,
    "angle": {"rad": 1.0, "deg": 360 / TWO_PI},
    "inductance": {"H": 1.0, "mH": 1e3, "uH": 1e6},
    "resistance": {"ohm": 1.0, "mohm": 1e3},
    "capacitance": {"F": 1.0, "mF": 1e3, "uF": 1e6},
    "irradiance": {"W/m2": 1.0, "kW/m2": 1e-3},
    "modulation": {"1": 1.0, "%": 100.0, "duty": 0.5},
    "share": {"1": 1.0, "%": 100.0},
    "temperature": {"C": 1.0, "K": 1.0},
    "number": _NUMBERS,
}
"""Units by quantity, and how many of them make one of the signal's; besides, every quantity with a base takes pu."""

_DUTY_OFFSET = 0.5  # a leg's share of the link, 0 to 1: (1 + m) / 2

_SPELLINGS = {
    **dict.fromkeys(("volt", "volts", "vrms", "vpk"), "V"),
    **dict.fromkeys(("amp", "amps", "ampere", "amperes"), "A"),
    **dict.fromkeys(("sec", "second", "seconds"), "s"),
    **dict.fromkeys(("p.u.", "p.u", "per unit", "perunit", "[pu]"), PER_UNIT),
    **dict.fromkeys(("hertz", "1/s"), "Hz"),
    **dict.fromkeys(("degree", "degrees", "°"), "deg"),
    **dict.fromkeys(("radian", "radians"), "rad"),
    **dict.fromkeys(("rad/sec", "rads", "rad s-1", "radians/s"), "rad/s"),
    **dict.fromkeys(("-", "n/a", "none", "bool", "boolean", "logical", "unitless", "[-]"), "1"),
    **dict.fromkeys(("°c", "degc", "celsius"), "C"),
    **dict.fromkeys(("kelvin",), "K"),
    **dict.fromkeys(("w/m^2", "w/m²"), "W/m2"),
    **dict.fromkeys(("µs", "usec", "microseconds"), "us"),
    **dict.fromkeys(("msec", "milliseconds"), "ms"),
}


class Bases(BaseModel):
    """What 1 pu of a port is, where the port's unit is pu; the numbers win over the words."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    voltage: Literal["phase_peak", "phase_rms", "line_rms", "line_peak"] = "phase_peak"
    current: Literal["phase_peak", "phase_rms"] = "phase_peak"
    voltage_v: FiniteFloat | None = Field(default=None, gt=0)
    current_a: FiniteFloat | None = Field(default=None, gt=0)
    power_va: FiniteFloat | None = Field(default=None, gt=0, description="none: S_nom")
    dc_voltage_v: FiniteFloat | None = Field(default=None, gt=0)
    dc_current_a: FiniteFloat | None = Field(default=None, gt=0, description="none: power by dc_voltage_v")
    frequency_hz: FiniteFloat | None = Field(default=None, gt=0, description="none: nominal")


class Scale(NamedTuple):
    """number = gain * signal + offset."""

    gain: float
    offset: float = 0.0


def spelled(unit: str) -> str:
    """Unit as it is written here; of an unknown one the text itself, of none the empty one.

    The prefixes that are known are none that capitals tell apart, so that MVAR is Mvar.
    """
    text = unit.strip()
    known = {name.casefold(): name for units in UNITS.values() for name in units} | {PER_UNIT: PER_UNIT}
    folded = text.casefold()
    return _SPELLINGS.get(folded) or known.get(folded) or text


def scale_of(quantity: str, unit: str, bases: Bases, nominal: Nominal, base: float | None = None) -> Scale:
    """How a signal of a quantity (SI) becomes a number of a port in a unit; no unit is the signal's own.

    Parameters
    ----------
    base : float or None
        What 1 pu is (the signal's unit), where the port has a base of its own.

    Raises
    ------
    DoorError
        When the unit is not one of the quantity, or 1 pu of it is not known.
    """
    name = spelled(unit)
    if base is not None and name not in ("", PER_UNIT):
        raise DoorError(f"a base is for ports in pu, not in {name}")
    if name == PER_UNIT or base is not None:
        return Scale(1 / (base or _base(quantity, bases, nominal)))
    if not name:
        return Scale(1.0)
    units = UNITS[quantity]
    if name not in units:
        raise DoorError(misfit(quantity, unit))
    return Scale(units[name], _DUTY_OFFSET if name == "duty" else 0.0)


def misfit(quantity: str, unit: str) -> str:
    """Why a unit is none of a quantity, and what is allowed; empty where it is one, or there is no unit."""
    name = spelled(unit)
    if name in ("", *UNITS[quantity]) or (name == PER_UNIT and quantity not in _WITHOUT_BASE):
        return ""
    allowed = [*(name for name in UNITS[quantity] if name != "1"), *([PER_UNIT] if quantity not in _NEVER_PU else [])]
    words = quantity.replace("_", " ").replace("dc ", "DC ")
    article = "an" if words[0] in "aei" else "a"
    return f"the unit {unit!r} does not fit {article} {words}; allowed: {', '.join(allowed) or 'none'}"


def _base(quantity: str, bases: Bases, nominal: Nominal) -> float:
    """What 1 pu of a quantity is (SI)."""
    power = bases.power_va or nominal.apparent_power_va
    phase_a = nominal.apparent_power_va / (3 * nominal.phase_voltage_v)
    dc_voltage = bases.dc_voltage_v
    found = {
        "voltage": bases.voltage_v or _BY_PHASE_RMS[bases.voltage] * nominal.phase_voltage_v,
        "current": bases.current_a or _BY_PHASE_RMS[bases.current] * phase_a,
        "dc_voltage": dc_voltage,
        "dc_current": bases.dc_current_a or (power / dc_voltage if dc_voltage else None),
        **dict.fromkeys(("active_power", "reactive_power", "apparent_power"), power),
        "frequency": bases.frequency_hz or nominal.frequency_hz,
        "irradiance": _STANDARD_IRRADIANCE_W_M2,
        "modulation": 1.0,
        "number": 1.0,
    }.get(quantity)
    if found is None:
        need = "" if quantity in _WITHOUT_BASE else "; write dc_voltage_v under [bases] of a mapping file"
        raise DoorError(f"1 pu of a {quantity.replace('_', ' ').replace('dc ', 'DC ')} is not known{need}")
    return found


_WITHOUT_BASE = ("time", "angle", "inductance", "resistance", "capacitance", "temperature")
_NEVER_PU = ("number", *_WITHOUT_BASE)
_BY_PHASE_RMS = {"phase_peak": 2**0.5, "phase_rms": 1.0, "line_rms": 3**0.5, "line_peak": 6**0.5}
_STANDARD_IRRADIANCE_W_M2 = 1000.0
