"""Outputs that speak of a switch and are not called as one: recorded alone, a protection would do nothing."""

import re
from collections.abc import Collection, Mapping

from pvlvrt_compliance.controllers.mapping.port_units import PER_UNIT, UNITS, spelled
from pvlvrt_compliance.controllers.mapping.words import OUTPUT_NAMES

_OF_NO_SWITCH = {PER_UNIT, *(unit for units in UNITS.values() for unit in units)} - {*UNITS["number"]}
_BREAKER = r"(?:cb|brk|breaker|contactor)"
_IN_A_NAME: Mapping[str, str] = {  # a name without capitals and separators
    "trip": rf"(?<!s)trip(?!le)|{_BREAKER}\w*(?:opn|open(?!ed)|close(?!d))|(?:opn|open|close){_BREAKER}|shutdown",
    "block": r"block|blk|inhibit|(?:gate|pulse|pwm)s?(?:off|stop)",
    "restart": r"restart",
}
_OF_IT = r"(?:s|ing)?(?: (?:the|all|main|ac|grid|line|circuit|network|gate|gating|firing))*"
_BRIDGE = r"(?:bridge|gates?|pulses?|igbts?|pwm|inverter|converter)"
_IN_WORDS: Mapping[str, str] = {
    "trip": rf"(?:open|trip){_OF_IT} (?:breakers?|contactors?|cb)|trip(?:ping)? (?:command|signal|order|request)",
    "block": rf"(?:block|inhibit|turn off){_OF_IT} {_BRIDGE}",
}
_TOLD = (  # what is known of a switch, and is none
    r"(?:time[rs]?|count(?:s|er)?|thresholds?|levels?|lvl|limits?|delay|dly|settings?|reason|cause|codes?"
    r"|stat(?:us|e)|history|log|number|reset)"
)
_LONGEST = 500  # letters of a description that are read (chosen)
_ABOUT_IT = rf"^{_TOLD}\b|\b(?:trip|block|restart|breaker)\w* {_TOLD}\b"


def may_be_switch(name: str, unit: str, description: str, beside: Collection[str]) -> str:
    """The switch that an output may be, which its name and description speak of; empty where they speak of none.

    Parameters
    ----------
    name : str
        Of a port that is called as no command.
    unit : str
        Its unit: a switch has none that is known.
    description : str
        In English; it is read as far as others are.
    beside : collection of str
        Keys of the names of all outputs, and of the commands that a mapping file has: what another output gives is
        not asked of this one.
    """
    key = re.sub(r"[^a-z0-9]", "", name.casefold())
    text = " ".join(re.split(r"[\s_/-]+", description[:_LONGEST].casefold()))
    if spelled(unit) in _OF_NO_SWITCH or re.search(rf"{_TOLD}\d*$", key) or re.search(_ABOUT_IT, text):
        return ""
    given = {OUTPUT_NAMES.get(other) for other in beside}
    spoken = [switch for switch, words in _IN_A_NAME.items() if re.search(words, key)]
    spoken += [switch for switch, words in _IN_WORDS.items() if re.search(rf"\b(?:{words})\b", text)]
    return next((switch for switch in spoken if switch not in given), "")
