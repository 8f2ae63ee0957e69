"""What a port's description says that its name need not, and where the two contradict each other.

A description speaks of a quantity, of a set-point or a measurement, of a phase, of the DC or the AC side. What it
does not say contradicts nothing; nor does one in another language than English.
"""

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from pvlvrt_compliance.controllers.mapping.quantities import PHASES, Meaning, Other, phase_of, quantity_of
from pvlvrt_compliance.simulation.door.exchange import SWITCHES

ROLES: Mapping[str, str] = {
    "set": r"reference(?! (?:to|frame|direction|axis))|ref|set ?points?|commands?|commanded|cmd|demand(?:ed)?"
    r"|(?:power|voltage|current) order|request(?:ed)?|targets?|desired|dispatch",
    "nominal": r"nominal|nom|rated|rating|base (?:value|voltage|power|current|frequency)",
    "measured": r"meas\w*|feedback|actual|sensed",
    "available": r"available|mpp",
    "limit": r"limits?|maximum|minimum|thresholds?",
    "derived": r"errors?|deviation|derivative|rate of change|integral",
}
"""Part that a value plays, and the words that say so."""

_ROLE_WORDS = {
    "set": "a set-point",
    "nominal": "a nominal value",
    "measured": "a measurement",
    "available": "what is available",
    "limit": "a limit",
    "derived": "something derived",
}
_QUANTITY_WORDS = {
    "voltage": r"voltages?|volts?|emf",
    "current": r"currents?|amps?|amperes?",
    "reactive_power": r"reactive power|vars?",
    "active_power": r"(?:active|real) power",
    "apparent_power": r"apparent power",
    "power": r"power",
    "frequency": r"frequency|speed",
    "angle": r"angle|theta",
    "temperature": r"temperatures?",
    "irradiance": r"irradian\w+|irradiation|insolation",
    "modulation": r"modulat\w+",
    "share": r"duty(?: cycle| ratio)?",
    "inductance": r"inductance",
    "resistance": r"resistance",
    "capacitance": r"capacitance",
    "duration": r"time constant|time step|sampl\w+ (?:time|period)|step size|delay|dead ?time|period",
    "time": r"time|clock",
    "energy": r"energy|state of charge",
}
_INNOCENT = (  # what says nothing of the port itself, and what stays of it
    (r"\([^)]*(?:\bpu\b|per unit|=)[^)]*\)", " "),  # what 1 pu or 1 is
    (r"\b(?:pu|p\.u\.|per[- ]unit) (?:of|on|base)\b.*", " "),
    (r"\bmaximum power point\b", "mpp"),
    (r"\bpower[- ](source|supply|plant|converter|inverter|system|electronics|stage|module|unit|factor)", r"\1"),
    (r"\bcurrent (time|value|state|step|mode|sample)", r"\1"),
    (r"\b(?:voltage|current)[- ]sourced? (?:converter|inverter)", "vsc"),
    (r"\b(?:pv|solar|photovoltaic) (?:inverter|converter|plant|system)", "inverter"),
    (r"[-_/]", " "),
)
_DC = r"dc|direct current"
_AC = r"ac|grid|mains|pcc|point of (?:common )?coupling|phase [abc]|[abc] phase|line to line|three phase"
_SOURCE = r"dc dc|pv|photovoltaic|solar|arrays?|panels?|strings?|source|primary|mppt|boost|chopper"
BRIDGE = r"bridge|inverter|converter|vsc|igbts?"
_FORM = (
    r"rms|magnitude|amplitude|peak|sequence|[dq] axis|[dq] component|direct axis|quadrature axis|alpha|beta|average"
    r"|mean|line to line|phase to phase|l l"
)  # what an instantaneous value of one phase is not
LINE_TO_LINE = r"line to line|phase to phase|l l"
TO_NEUTRAL = r"to neutral|l n|phase voltage"
_ELSEWHERE = r"load(?! convention)|rotor|stator|motor|battery|neutral current|capacitor current|fault current"
_FORM_OR_ELSEWHERE = rf"{_FORM}|{_ELSEWHERE}"
_PHASES = r"(?:phase|line|leg) ?(?:l?([123])|([abc]))\b|\b([abc]) phase\b(?! (?:lock|shift|angle))|\bl([123])\b"
_ENDS = 2  # phases that a description of a line-to-line voltage names
_INDUCTOR = r"inductors?|reactor|choke|lcl|filter"  # where L1 is no phase
_COUNTED = r"time|count(?:er)?|thresholds?|levels?|limits?|delay|settings?"
_OPPOSITE = {"enabled": r"disabl\w+|block\w*|inhibit\w*", "connected": r"open\w*|disconnect\w*|trip\w*"}
_SAME = {"enabled": r"enabl\w+|run\w*|releas\w+|on", "connected": r"closed?|connect\w*"}

_PLACES = {"i_pv_a": _SOURCE, "i_dc_a": BRIDGE, "voltage_nominal_v": TO_NEUTRAL}
_INTO = (
    r"into (?:the )?(?:inverter|converter|vsc|bridge)|(?:drawn )?from (?:the )?(?:grid|network|mains|pcc)(?! side)"
    r"|load convention|consumer convention"
)
_NOTHING = r"(?!)"
_POWERS = ("active_power", "reactive_power", "apparent_power")
_OWN_ROLES = {
    **dict.fromkeys(("u", "i", "v", "irradiance"), "measured"),
    **dict.fromkeys(("p_set_w", "q_set_var", "m_a", "m_b", "m_c", "angle_rad"), "set"),
    "p_available_w": "available",
    **dict.fromkeys(("filter", "dc"), "nominal"),
}


class Said(NamedTuple):
    """What a description says: of each, nothing where it says nothing."""

    text: str = ""
    quantities: frozenset[str] = frozenset()
    roles: frozenset[str] = frozenset()
    phases: frozenset[str] = frozenset()


def said_in(description: str) -> Said:
    """What a description says, as far as it is read: to its 500th letter (chosen)."""
    text = description[:500].casefold()
    for pattern, instead in _INNOCENT:
        text = re.sub(pattern, instead, text)
    text = " ".join(text.split())
    quantities = {name for name, words in _QUANTITY_WORDS.items() if _in(words, text)}
    for whole, part in (("duration", "time"), *((power, "power") for power in _POWERS)):
        if whole in quantities:
            quantities.discard(part)
    if "power" in quantities:  # of no kind that is named
        quantities.update(_POWERS)
    roles = {name for name, words in ROLES.items() if _in(words, text)}
    return Said(text, frozenset(quantities - {"power"}), frozenset(roles), frozenset(_phases_in(text)))


def _phases_in(text: str) -> Iterator[str]:
    for match in re.finditer(_PHASES, text):
        *those, inductor = match.groups()
        found = next(filter(None, those), None) or ("" if _in(_INDUCTOR, text) else inductor)
        if found:
            yield PHASES[int(found) - 1] if found.isdigit() else found


def contradiction(meaning: Meaning, said: Said, *, wide: bool = False) -> str:
    """What a description speaks of that a signal or command is not, in words; empty where there is nothing.

    Parameters
    ----------
    wide : bool
        Whether the port has elements for all phases, so that the one that is named is none.
    """
    quantity = quantity_of(meaning).removeprefix("dc_")
    if quantity == "number":
        return _of_a_switch(meaning, said)
    also = {"voltage"} if quantity == "modulation" else set()  # which is one of the bridge, in parts of the link's
    if said.quantities and not said.quantities & {quantity, *also}:
        return _a(min(said.quantities))
    own = role_of(meaning)
    if own and said.roles and own not in said.roles:
        return _ROLE_WORDS[min(said.roles)]
    if isinstance(meaning, Other):
        match = _in(meaning.elsewhere or _NOTHING, said.text)
        return match[0] if match else ""
    return _of_place(meaning, said, wide)


def into_the_inverter(name: str, description: str) -> str:
    """Words that say of a phase current that it is positive into the inverter; empty where none do."""
    match = _in(_INTO, said_in(description).text) if quantity_of(name) == "current" else None
    return match[0] if match else ""


def support(meaning: Meaning, said: Said) -> int:
    """How much of what a description says is said of this signal or command in particular."""
    own = role_of(meaning)
    right_place = meaning.place if isinstance(meaning, Other) else _PLACES.get(meaning, "")
    return sum(
        (
            quantity_of(meaning).removeprefix("dc_") in said.quantities,
            own in said.roles,
            bool(said.phases) and _phase(meaning) in said.phases,
            2 * bool(right_place and _in(right_place, said.text)),
        )
    )


def role_of(meaning: Meaning) -> str:
    """What part a signal or command plays: a key of `ROLES`, or none."""
    if isinstance(meaning, Other):
        return meaning.role
    if "nominal" in meaning:
        return "nominal"
    if "ref" in meaning.split("_"):
        return "set"
    return _OWN_ROLES.get(meaning) or _OWN_ROLES.get(meaning.partition("_")[0], "")


def _of_a_switch(meaning: Meaning, said: Said) -> str:
    if isinstance(meaning, Other):
        return ""
    if meaning in (*SWITCHES, "enabled", "connected") and (match := _in(_COUNTED, said.text)):
        return f"a {match[0]}"
    match = _in(_OPPOSITE.get(meaning, _NOTHING), said.text)
    if match and not _in(_SAME[meaning], said.text):
        return f"the opposite ({match[0]})"
    return ""


def _of_place(name: str, said: Said, wide: bool) -> str:
    """Of phase, form and side."""
    phase, quantity = phase_of(name), quantity_of(name)
    if phase and said.phases and phase not in said.phases and not wide:
        return f"phase {min(said.phases)}"
    if phase and quantity == "voltage" and len(said.phases) == _ENDS and not wide:
        return f"phases {' and '.join(sorted(said.phases))}"
    form = _FORM_OR_ELSEWHERE if phase else LINE_TO_LINE if name == "voltage_nominal_v" else _NOTHING
    match = _in(form, said.text)
    if match:
        return "line to line" if match[0] == "l l" else match[0]
    return _of_side(name, said.text) or _of_dc_current(name, said.text)


def _of_side(name: str, text: str) -> str:
    of_dc = quantity_of(name).startswith("dc_")
    if of_dc and _in(_AC, text) and not _in(_DC, text):
        return "the AC side"
    of_ac = name == "voltage_nominal_v" or (role_of(name) == "measured" and bool(phase_of(name)))
    if of_ac and _in(_DC, text) and not _in(_AC, text):
        return "the DC side"
    return ""


def _of_dc_current(name: str, text: str) -> str:
    source, bridge = _in(_SOURCE, text), _in(BRIDGE, text)
    if name == "i_dc_a" and source:
        return f"where the power comes from ({source[0]})"
    if name == "i_pv_a" and bridge and not source:
        return f"where the power goes ({bridge[0]})"
    return ""


def _phase(meaning: Meaning) -> str:
    return "" if isinstance(meaning, Other) else phase_of(meaning) or "-"


def _in(words: str, text: str) -> re.Match[str] | None:
    return re.search(rf"\b(?:{words})\b", text)


def _a(quantity: str) -> str:
    words = {"share": "duty cycle", "modulation": "modulating signal"}.get(quantity, quantity.replace("_", " "))
    return f"{'an' if words[0] in 'aei' else 'a'} {words}"
