"""Quantity of every signal and command, for its units and for what a description may say of it."""

from collections.abc import Mapping
from typing import NamedTuple

PHASES = "abc"

QUANTITIES: Mapping[str, str] = {
    "time_s": "time",
    **dict.fromkeys(("u_a_v", "u_b_v", "u_c_v", "u_a_ref_v", "u_b_ref_v", "u_c_ref_v", "voltage_nominal_v"), "voltage"),
    **dict.fromkeys(("u_d_ref_v", "u_q_ref_v"), "voltage"),
    "angle_rad": "angle",
    **dict.fromkeys(("i_a_a", "i_b_a", "i_c_a"), "current"),
    "v_dc_v": "dc_voltage",
    **dict.fromkeys(("i_dc_a", "i_pv_a"), "dc_current"),
    **dict.fromkeys(("m_a", "m_b", "m_c"), "modulation"),
    **dict.fromkeys(("p_set_w", "p_available_w"), "active_power"),
    "v_dc_nominal_v": "dc_voltage",
    "filter_inductance_h": "inductance",
    "filter_resistance_ohm": "resistance",
    "dc_link_capacitance_f": "capacitance",
    "q_set_var": "reactive_power",
    "frequency_nominal_hz": "frequency",
    "apparent_power_nominal_va": "apparent_power",
    "irradiance_w_m2": "irradiance",
}
"""Quantity of a signal or command, for its units; of those not named, a number without unit."""


class Other(NamedTuple):
    """What a port may mean that is no signal and no command here."""

    words: str
    quantity: str  # one of `QUANTITIES`, or temperature
    role: str = ""  # see `described.ROLES`
    place: str = ""  # words of a description (a pattern) that speak of it in particular
    elsewhere: str = ""  # words that speak of what it is not


Meaning = str | Other
"""A signal or command by its name, or what is none."""


def quantity_of(meaning: Meaning) -> str:
    """Quantity of a signal, a command, or what is neither."""
    return meaning.quantity if isinstance(meaning, Other) else QUANTITIES.get(meaning, "number")


def phase_of(name: str) -> str:
    """Phase of a signal or command; of one that has none, nothing."""
    parts = name.split("_")
    return parts[1] if parts[0] in ("u", "i", "m") and len(parts) > 1 and parts[1] in tuple(PHASES) else ""


def in_phase(name: str, phase: str) -> str:
    """The same of another phase."""
    return name.replace(f"_{phase_of(name)}", f"_{phase}", 1)
