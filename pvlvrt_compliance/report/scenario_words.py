"""The scenario of a test in words, read from the plain mapping that a result carries."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from pvlvrt_compliance.report.format import label, number


class Interval(NamedTuple):
    """From the start of a sag to its clearing, in seconds from the start of the record."""

    start_s: float
    clear_s: float


class Fact(NamedTuple):
    """One property of a scenario for people."""

    name: str
    text: str


_NAMES_AND_UNITS = {
    "duration_s": ("duration", "s"),
    "point_on_wave_deg": ("point on wave", "°"),
    "frequency_hz": ("grid frequency", "Hz"),
    "irradiance_w_m2": ("irradiance", "W/m²"),
    "cell_temperature_c": ("cell temperature", "°C"),
    "before_s": ("record before the sag", "s"),
    "after_s": ("record after clearing", "s"),
}


def sag_interval(scenario: Mapping[str, Any]) -> Interval | None:
    """When the sag starts and clears; None where the scenario has no sag or does not say."""
    if _sag(scenario).get("depth") == 0 or not {"before_s", "duration_s"} <= scenario.keys():
        return None
    start_s = float(scenario["before_s"])
    return Interval(start_s, start_s + float(scenario["duration_s"]))


def facts(scenario: Mapping[str, Any]) -> list[Fact]:
    """Properties of a scenario in the order given; those that this module does not know are shown as they are."""
    sag = [Fact("sag", describe_sag(_sag(scenario)))] if _sag(scenario) else []
    known = [_fact(name, value) for name, value in scenario.items() if name not in {"sag", "scr", "xr", "events"}]
    return sag + known + _grid(scenario) + [_event(event) for event in scenario.get("events", ())]


def describe_sag(sag: Mapping[str, Any]) -> str:
    """Name depth, phases and kind of a sag, and what is left of the voltage."""
    depth = float(sag.get("depth", 0))
    if depth == 0:
        return "none"
    phases = str(sag.get("phases", "abc"))
    if sag.get("type"):
        return f"type {sag['type']}, {100 * depth:g} %, {100 * (1 - depth):.4g} % left"
    if sag.get("two_phase"):
        return f"{100 * depth:g} % of the line-to-line voltage {phases}, {100 * (1 - depth):.4g} % left"
    which = "all three phases" if phases == "abc" else " and ".join(["phase " + phases[0], *phases[1:]])
    return f"{100 * depth:g} % in {which}, {100 * (1 - depth):.4g} % left"


def _event(event: Mapping[str, Any]) -> Fact:
    """An event besides the sag, its fields as a scenario file spells them; what is left open is left out."""
    said = {name: value for name, value in event.items() if name != "kind" and value is not None}
    text = ", ".join(
        f"{name} {describe_sag(value) if name == 'sag' else value}" for name, value in sorted(said.items())
    )
    return Fact(str(event.get("kind", "event")).replace("_", " "), text)


def _sag(scenario: Mapping[str, Any]) -> Mapping[str, Any]:
    sag = scenario.get("sag")
    return sag if isinstance(sag, Mapping) else {}


def _grid(scenario: Mapping[str, Any]) -> list[Fact]:
    if "scr" not in scenario:
        return []
    if scenario["scr"] is None:
        return [Fact("grid", "stiff: the source at the terminals")]
    return [Fact("grid", f"short-circuit ratio {scenario['scr']:g}, X/R {scenario.get('xr', 0):g}")]


def _fact(name: str, value: object) -> Fact:
    words, unit = _NAMES_AND_UNITS.get(name, (label(name), ""))
    if isinstance(value, int | float) and not isinstance(value, bool):
        return Fact(words, f"{value:.6g} {unit}".rstrip() if unit != "s" else number(value, unit))
    return Fact(words, str(value))
