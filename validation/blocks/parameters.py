"""Tables of parameters: names, defaults and meaning from their models, symbols and sources from here."""

import re
from collections.abc import Iterable, Iterator
from typing import Any, Literal, NamedTuple, get_args, get_origin

from pvlvrt_compliance.parameter_group import ranges_of
from pvlvrt_compliance.simulation.parameters import Parameters


class Known(NamedTuple):
    """What the models do not say."""

    symbol: str  # in code and equations
    source: str  # of the default
    unit: str = ""  # where the name does not end with it


_OWN = "chosen, not in the paper"
_CHOICE = "the paper's own"
_IDEAL = "ideal"

KNOWN = {
    "simulation.fidelity": Known("", "chosen"),
    "simulation.plant_step_us": Known("T_S", "Table 3"),
    "simulation.control_ratio": Known("T_reg/T_S", "Table 3"),
    "simulation.settling_s": Known("", _OWN),
    "simulation.record_settling": Known("", _OWN),
    "simulation.synchronising_s": Known("", _OWN),
    "simulation.time_limit_s": Known("", _OWN),
    "simulation.opening_limit_s": Known("", _OWN),
    "simulation.memory_limit_mb": Known("", _OWN),
    "simulation.output_limit_mb": Known("", _OWN),
    "simulation.files_limit_mb": Known("", _OWN),
    "simulation.files_limit": Known("", _OWN, "-"),
    "simulation.processes_limit": Known("", _OWN, "-"),
    "plant.apparent_power_kva": Known("S_nom", "below eq (8)"),
    "plant.phase_voltage_v": Known("u_gnom", "Table 2"),
    "plant.dc_link_capacitance_f": Known("C", "Table 2"),
    "plant.filter_inductance_h": Known("L", "Table 2"),
    "plant.filter_resistance_ohm": Known("R", _OWN),
    "plant.dead_time_us": Known("t_dead", _OWN),
    "plant.device_drop_v": Known("v_drop", _OWN),
    "plant.device_resistance_ohm": Known("R_on", _OWN),
    "plant.switching_energy_mj": Known("E_on + E_off", _OWN),
    "plant.modules_in_series": Known("n_series", "Table 1", "-"),
    "plant.strings_in_parallel": Known("n_parallel", "Table 1", "-"),
    "plant.breaker_opening_s": Known("t_breaker", _OWN),
    "protection.overcurrent_pu": Known("i_max", _OWN),
    "protection.dc_overvoltage_v": Known("v_dc_max", _OWN),
    "protection.undervoltage_curve": Known("u(t)", "inferred from NTS 631, Fig. 27", "s, pu"),
    "protection.undervoltage_delay_s": Known("curve_delay", _OWN),
    "protection.frequency_min_hz": Known("w_min/2π", _OWN),
    "protection.frequency_max_hz": Known("w_max/2π", _OWN),
    "protection.frequency_delay_s": Known("t_frequency", _OWN),
    "protection.undervoltage_relay": Known("", _OWN),
    "protection.frequency_relay": Known("", _OWN),
    "sensors.adc_bits": Known("", _IDEAL, "bit"),
    "sensors.voltage_range_v": Known("low, high", _OWN),
    "sensors.current_range_a": Known("low, high", _OWN),
    "sensors.dc_voltage_range_v": Known("high", _OWN),
    "sensors.pv_current_range_a": Known("high", _OWN),
    "sensors.voltage_gain": Known("gain", _IDEAL, "-"),
    "sensors.current_gain": Known("gain", _IDEAL, "-"),
    "sensors.dc_voltage_gain": Known("gain", _IDEAL, "-"),
    "sensors.pv_current_gain": Known("gain", _IDEAL, "-"),
    "sensors.voltage_offset_v": Known("offset", _IDEAL),
    "sensors.current_offset_a": Known("offset", _IDEAL),
    "sensors.dc_voltage_offset_v": Known("offset", _IDEAL),
    "sensors.pv_current_offset_a": Known("offset", _IDEAL),
    "sensors.voltage_noise_v": Known("noise", _IDEAL),
    "sensors.current_noise_a": Known("noise", _IDEAL),
    "sensors.dc_voltage_noise_v": Known("noise", _IDEAL),
    "sensors.pv_current_noise_a": Known("noise", _IDEAL),
    "sensors.noise_seed": Known("", _OWN, "-"),
    "sensors.measurement_delay_samples": Known("measurement", _IDEAL),
    "controller.synchronisation": Known("algorithm", _CHOICE),
    "controller.sogi_gain": Known("K", "Table 3", "-"),
    "controller.fll_gain": Known("Γ", "Table 3", "1/s"),
    "controller.fll_frequency_min_hz": Known("w_min/2π", _OWN),
    "controller.fll_frequency_max_hz": Known("w_max/2π", _OWN),
    "controller.pll_bandwidth_hz": Known("w_n/2π", _OWN),
    "controller.pll_damping": Known("ζ", _OWN, "-"),
    "controller.pnsd_notch_damping": Known("ζ of the notch, K/2", _OWN, "-"),
    "controller.ddsrf_filter_ratio": Known("w_f/w", _OWN, "-"),
    "controller.fault_threshold_pu": Known("V_detect", "below eq (7)"),
    "controller.reactive_plateau_voltage_pu": Known("V_full", "eq (9)"),
    "controller.reactive_plateau_pu": Known("Q_full", "eq (9)"),
    "controller.power_strategy": Known("strategy", _CHOICE),
    "controller.sequence_difference_min_pu": Known("u_pos_less_neg_min", _OWN),
    "controller.dc_proportional_gain_w_per_v": Known("K_P", "Table 3"),
    "controller.dc_integral_gain_w_per_vs": Known("K_I", "Table 3"),
    "controller.pr_proportional_gain": Known("K_P", "Table 3", "1/A"),
    "controller.pr_integral_gain": Known("K_I", "Table 3", "1/A"),
    "controller.pr_cutoff_rad_s": Known("w_c", "Table 3"),
    "controller.hc5_integral_gain": Known("K_I5", _OWN, "1/A"),
    "controller.hc7_integral_gain": Known("K_I7", _OWN, "1/A"),
    "controller.hc11_integral_gain": Known("K_I11", _OWN, "1/A"),
    "controller.hc13_integral_gain": Known("K_I13", _OWN, "1/A"),
    "controller.resonator_lead_samples": Known("lead", _OWN),
    "controller.mppt_period_s": Known("period · T", _OWN),
    "controller.mppt_step_v": Known("dv", _OWN),
    "controller.mppt_voltage_min_v": Known("v_min", _OWN),
    "controller.mppt_voltage_max_v": Known("v_max", _OWN),
    "controller.precision": Known("", _OWN),
    "controller.hold": Known("", _OWN),
    "controller.computation_delay_samples": Known("computation", "section 6"),
    "controller.grid_voltage_feedforward": Known("feedforward", "the paper names none"),
}
_UNITS = {
    "us": "µs", "s": "s", "kva": "kVA", "v": "V", "a": "A", "f": "F", "h": "H", "ohm": "Ω", "mj": "mJ", "mb": "MB",
    "pu": "pu", "hz": "Hz", "samples": "samples", "rad_s": "rad/s", "w_per_v": "W/V", "w_per_vs": "W/(V s)",
}  # fmt: skip


def field_of(name: str) -> Any:
    """Field of the models behind ``group.name``."""
    group, _, key = name.partition(".")
    return type(getattr(Parameters(), group)).model_fields[key]


def unit_of(name: str) -> str:
    """Unit by the end of a parameter's name; a word or a switch has none."""
    stated = KNOWN[name].unit
    endings = [unit for end, unit in _UNITS.items() if name.endswith(f"_{end}")]
    return stated or (endings[-1] if endings else "")


def said(value: Any) -> str:
    """Default as it stands in a table."""
    if value is None:
        return "none"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, tuple):
        return ", ".join(f"({said(x)})" if isinstance(x, tuple) else said(x) for x in value)
    return str(value)


def meaning_of(name: str) -> str:
    """What a model says of a parameter, but for where its number comes from, and the words to choose from."""
    field = field_of(name)
    if get_origin(field.annotation) is Literal:
        choices = f"one of {', '.join(get_args(field.annotation))}"
        return f"{field.description}; {choices}" if field.description else choices
    return re.sub(r"[;,] not in the paper", "", field.description or "")


def allowed_of(name: str) -> str:
    """Range of a number, of a list that of each of its places; a word or a switch has none."""
    return "; ".join(f"{low:g} to {high:g}" for low, high in ranges_of(field_of(name)))


def row(name: str) -> str:
    """Line of a table."""
    known = KNOWN[name]
    default, allowed = said(field_of(name).default), allowed_of(name)
    cells = (f"`{name}`", known.symbol, default, unit_of(name), allowed, meaning_of(name), known.source)
    return f"| {' | '.join(cells)} |"


def table(names: Iterable[str]) -> Iterator[str]:
    """Lines of a table; names are those of ``--set``."""
    yield "| `--set` | symbol | default | unit | allowed | what it is | default from |"
    yield "|---|---|---|---|---|---|---|"
    yield from map(row, names)
