"""Which plant signal or command a port means by its name alone."""

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from pvlvrt_compliance.simulation.door.exchange import COMMANDS, SIGNALS

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


class Guess(NamedTuple):
    """What a port's name means."""

    names: tuple[str, ...] = ()  # a signal or command for every element; empty: nothing is known
    note: str = ""  # why nothing is
    unit: str = ""  # that the name ends in
    inverted: bool = False  # whether it says the opposite of the command


_VOLTS, _AMPS, _M = ("u_{}_v", "i_{}_a", "m_{}")
_U_REF = "u_{}_ref_v"

# Stems that a phase's letter follows (Va, V_a_grid, vga), or that stand for all three (Vabc, vgabc).
_GRID = ("", "g", "grid", "pcc", "poc", "poi", "s", "t", "ac", "ph", "phase", "ln", "net", "term")
_INVERTER = ("", "g", "grid", "pcc", "inv", "l", "lf", "out", "o", "f", "conv", "vsc", "ac", "ph", "phase", "line", "s")
_INPUT_STEMS = (
    (_VOLTS, ("v", "u"), _GRID),
    (_AMPS, ("i",), _INVERTER),
    (_M, ("m",), ("", "od")),
)
_OUTPUT_STEMS = (
    (_M, ("m",), ("", "od", "ref", "odulation", "cmd")),
    (_U_REF, ("v", "u", "e"), ("ref", "inv", "conv", "cmd", "vsc", "star", "set")),
    (_U_REF, ("e",), ("",)),
)

_INPUT_WORDS = {
    "time_s": ("time", "t", "simtime", "currtime", "currenttime", "tsim"),
    "v_dc_v": ("vdc", "udc", "vdclink", "udclink", "vlink", "ulink", "vdcbus", "vbusdc", "edc", "dcvoltage", "vdcmeas"),
    "i_dc_a": ("idc", "idcinv", "idclink", "dccurrent"),
    "i_pv_a": ("ipv", "ipvarray", "iarray", "pvcurrent"),
    "p_set_w": ("pset", "pref", "psetpoint", "pstar", "pcmd", "porder", "psp", "pdispatch"),
    "q_set_var": ("qset", "qref", "qsetpoint", "qstar", "qcmd", "qorder", "qsp", "qdispatch"),
    "frequency_nominal_hz": (
        "fnom",
        "fn",
        "fnominal",
        "freqnom",
        "frequencynominal",
        "fbase",
        "f0",
        "nominalfrequency",
    ),
    "apparent_power_nominal_va": ("snom", "sn", "sbase", "srated", "mvabase"),
    "p_available_w": ("pavail", "pavailable", "pav", "availablepower", "pmpp", "pmax", "pprimary", "poweravailable"),
    "v_dc_nominal_v": ("vdcnom", "vdcnominal", "vdcn", "vdcbase", "udcnom", "udcn"),
    "filter_inductance_h": ("lf", "lfilter", "lfilt", "linv", "lchoke"),
    "filter_resistance_ohm": ("rf", "rfilter", "rfilt", "rinv", "rchoke"),
    "dc_link_capacitance_f": ("cdc", "cdclink", "clink"),
    "irradiance_w_m2": ("irradiance", "ghi", "gpoa", "irr"),
    "enabled": ("enabled", "enable", "en", "deblock", "release", "run"),
    "connected": ("connected", "breaker", "breakerclosed", "cbclosed", "gridconnected"),
}

_SWITCH_WORDS = {
    "trip": (
        "tripcmd",
        "tripcommand",
        "triporder",
        "tripsignal",
        "tripcb",
        "cbtrip",
        "cbopen",
        "opencb",
        "breakertrip",
    ),
    "block": (
        "blocked",
        "blk",
        "gateblock",
        "blockgate",
        "pulseblock",
        "blockpulses",
        "pwmblock",
        "blockpwm",
        "inhibit",
    ),
    "restart": ("restartcmd", "rearm"),
}
_WORKING = (
    *("enable", "enabled", "en", "pwmenable", "enablepwm", "pwmen", "enpwm", "gateenable", "gateen", "pulseenable"),
    *("deblock", "deblocked", "unblock", "gateson", "pwmon"),
)
"""Outputs that are 1 while the bridge works: the opposite of a block."""

_FRAME_ENDS = ("ref", "cmd", "star", "set", "inv", "conv")
_FRAME_WORDS = {
    **{f"u_{axis}_ref_v": tuple(f"{u}{axis}{end}" for u in "uve" for end in _FRAME_ENDS) for axis in "dq"},
    "angle_rad": ("angleref", "thetaref", "thetacmd", "anglecmd"),
}
"""Voltages in a frame, and its angle; an angle alone (`theta`) may be one that is only told."""

_LINE_TO_LINE = "it looks like a line-to-line voltage, which is not offered; take the phase voltages"
_AMBIGUOUS_INPUTS = {
    **dict.fromkeys(
        ("v", "u", "vg", "ug", "vgrid", "vac", "e", "ea", "eb", "ec"), "of which phase, and which voltage?"
    ),
    **dict.fromkeys(("i", "ig", "iac", "iinv", "il"), "a current: of which phase?"),
    **dict.fromkeys(("p", "ppv", "pmeas", "pe", "q", "qmeas", "qe"), "a measured power, or a set-point?"),
    **dict.fromkeys(("vref", "uref", "vset"), "a set-point of the grid's or of the DC link's voltage? Give a constant"),
    **dict.fromkeys(("vnom", "unom", "vn", "un", "vbase"), "phase to neutral or line to line?"),
    **dict.fromkeys(("f", "freq", "frequency", "w", "omega"), "nominal or measured?"),
    **dict.fromkeys(("vab", "vbc", "vca", "uab", "ubc", "uca"), _LINE_TO_LINE),
}
_DUTY = "a duty cycle (unit duty) or a modulating signal?"
_AMBIGUOUS_OUTPUTS = {
    **dict.fromkeys(("da", "db", "dc", "dabc", "d", "dutya", "dutyb", "dutyc", "dutyabc"), _DUTY),
    **dict.fromkeys(("va", "vb", "vc", "vabc", "ua", "ub", "uc", "uabc"), "a reference, or what is only told?"),
}

_TAIL = re.compile(r"_(v|kv|a|ka|w|kw|mw|var|kvar|mvar|va|kva|mva|hz|pu|s|ms|us)$", re.IGNORECASE)
_MEASURED = re.compile(r"_?(meas|measured|mes|fb|in|feedback)$", re.IGNORECASE)


def guess_input(name: str, width: int) -> Guess:
    """Signals that an input of this name and so many elements means."""
    return _guess(name, width, _INPUT_NAMES, _AMBIGUOUS_INPUTS)


def guess_output(name: str, width: int) -> Guess:
    """Commands that an output means."""
    return _guess(name, width, _OUTPUT_NAMES, _AMBIGUOUS_OUTPUTS)


def _guess(name: str, width: int, known: Mapping[str, str], ambiguous: Mapping[str, str]) -> Guess:
    for text, unit in _readings(name):
        key = re.sub(r"[^a-z0-9]", "", text.casefold())
        if width == len(PHASES) and (pattern := _of_three(key, known)):
            return Guess(tuple(pattern), unit=unit)
        if width == 1 and key in known:
            return Guess((known[key],), unit=unit, inverted=known is _OUTPUT_NAMES and key in _WORKING)
        if key in ambiguous:
            return Guess(note=ambiguous[key])
    return Guess()


def _readings(name: str) -> Iterator[tuple[str, str]]:
    """The name, and what is left of it without a unit or a word like measured at its end."""
    yield name, ""
    if tail := _TAIL.search(name):
        yield name[: tail.start()], tail[1]
    if tail := _MEASURED.search(name):
        yield from _readings(name[: tail.start()])


def _of_three(key: str, known: Mapping[str, str]) -> list[str]:
    """Names for the elements of a port for three phases, from that of its phase a."""
    candidates = [key.replace(word, "a", 1) for word in ("abc", "123") if word in key] or [f"{key}a"]
    first = next((known[c] for c in candidates if c in known and "_a" in known[c]), None)
    return [] if first is None else [first.replace("_a", f"_{phase}", 1) for phase in PHASES]


def _phase_names(stems: Iterable[tuple[str, tuple[str, ...], tuple[str, ...]]]) -> dict[str, str]:
    """Every way to write a quantity of one phase: Va, V_a_grid, vga."""
    return {
        key: pattern.format(phase)
        for pattern, letters, words in stems
        for letter in letters
        for word in words
        for phase in PHASES
        for key in (f"{letter}{word}{phase}", f"{letter}{phase}{word}")
    }


def _plain(names: Iterable[str]) -> dict[str, str]:
    return {name.replace("_", ""): name for name in names}


_INPUT_NAMES = (
    _phase_names(_INPUT_STEMS)
    | {word: signal for signal, words in _INPUT_WORDS.items() for word in words}
    | _plain(SIGNALS)
)
_OUTPUT_NAMES = (
    _phase_names(_OUTPUT_STEMS)
    | {word: command for command, words in (_SWITCH_WORDS | _FRAME_WORDS).items() for word in words}
    | dict.fromkeys(_WORKING, "block")
    | _plain(COMMANDS)
)
