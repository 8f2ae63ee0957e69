"""Names that makers give their ports, in small letters without separators, and what each may mean."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from pvlvrt_compliance.controllers.mapping.described import BRIDGE, LINE_TO_LINE, TO_NEUTRAL
from pvlvrt_compliance.controllers.mapping.quantities import PHASES, Meaning, Other
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, SIGNALS


class Unclear(NamedTuple):
    """A name of several meanings, of which the unit or the description may leave one."""

    question: str
    meanings: tuple[Meaning, ...]


Known = Mapping[str, str | Unclear]

_VOLTS, _AMPS, _M = ("u_{}_v", "i_{}_a", "m_{}")
_U_REF = "u_{}_ref_v"

# Stems that a phase's letter follows (Va, V_a_grid, vga), or that stand for all three (Vabc, vgabc).
_GRID = ("", "g", "grid", "pcc", "poc", "poi", "s", "t", "ac", "ph", "phase", "ln", "net", "term", "terminal")
_INVERTER = ("", "g", "grid", "pcc", "inv", "l", "lf", "out", "o", "f", "conv", "vsc", "ac", "ph", "phase", "line", "s")
_SIDES = ("1", "2", "l1", "l2", "t", "term", "bridge", "br", "net", "poc", "poi")  # of the inductors of an LCL filter
_TO_NEUTRAL = (
    *((phase, phase, "n") for phase in PHASES),
    *((phase, f"l{k + 1}", end) for k, phase in enumerate(PHASES) for end in ("", "n")),
)
_INPUT_STEMS = (
    (_VOLTS, ("v", "u"), _GRID),
    (_AMPS, ("i",), (*_INVERTER, *_SIDES)),
    (_M, ("m",), ("", "od")),
)
_OUTPUT_STEMS = (
    (_M, ("m",), ("", "od", "ref", "odulation", "cmd", "star")),
    (_U_REF, ("v", "u", "e"), ("ref", "inv", "conv", "cmd", "vsc", "star", "set")),
    (_U_REF, ("e",), ("",)),
)
_TOLD_STEMS = ((_U_REF, ("v", "u"), ("bridge", "br", "pwm")),)

_SET = ("set", "ref", "reference", "setpoint", "star", "cmd", "command", "order", "sp", "dispatch")
_SET_TOO = ("request", "requested", "req", "demand", "dem", "target", "desired")
_INPUT_WORDS = {
    "time_s": ("time", "t", "simtime", "currtime", "currenttime", "tsim", "simulationtime"),
    "v_dc_v": (
        *("vdc", "udc", "vdclink", "udclink", "vlink", "ulink", "vdcbus", "vbusdc", "edc", "dcvoltage"),
        *("dclinkvoltage", "vdccap", "vpv", "upv", "vpvarray", "pvvoltage"),
    ),
    "i_dc_a": ("idc", "idcinv", "idclink", "dccurrent"),
    "i_pv_a": ("ipv", "ipvarray", "iarray", "pvcurrent"),
    "p_set_w": tuple(f"{p}{word}" for p in ("p", "activepower") for word in (*_SET, *_SET_TOO)),
    "q_set_var": tuple(f"{q}{word}" for q in ("q", "reactivepower") for word in (*_SET, *_SET_TOO)),
    "frequency_nominal_hz": (
        *("fnom", "fn", "fnominal", "freqnom", "frequencynominal", "fbase", "f0", "nominalfrequency"),
        *("frated", "wnom", "omeganom"),
    ),
    "apparent_power_nominal_va": ("snom", "sn", "sbase", "srated", "mvabase", "ratedpower", "nominalpower"),
    "p_available_w": ("pavail", "pavailable", "availablepower", "pmpp", "pprimary", "poweravailable"),
    "v_dc_nominal_v": ("vdcnom", "vdcnominal", "vdcn", "vdcbase", "vdcrated", "udcnom", "udcn"),
    "filter_inductance_h": ("lf", "lfilter", "lfilt", "linv", "lchoke"),
    "filter_resistance_ohm": ("rf", "rfilter", "rfilt", "rinv", "rchoke"),
    "dc_link_capacitance_f": ("cdc", "cdclink", "clink"),
    "irradiance_w_m2": ("irradiance", "ghi", "gpoa", "irr"),
    "enabled": ("enabled", "enable", "en", "deblock", "release", "run"),
    "connected": ("connected", "breakerclosed", "cbclosed", "gridconnected"),
}

_SWITCH_WORDS = {
    "trip": (
        *("tripcmd", "tripcommand", "triporder", "tripsignal", "tripcb", "cbtrip", "cbopen", "opencb", "breakertrip"),
    ),
    "block": (
        *("blocked", "blk", "gateblock", "blockgate", "pulseblock", "blockpulses", "pwmblock", "blockpwm", "inhibit"),
    ),
    "restart": ("restartcmd", "rearm"),
}
WORKING = (
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

_U = tuple(_VOLTS.format(phase) for phase in PHASES)
_I = tuple(_AMPS.format(phase) for phase in PHASES)
_NO_UNIT = Other("a plain number", "number")
_P_MEASURED = Other("a measured power", "active_power", "measured")
_Q_MEASURED = Other("a measured power", "reactive_power", "measured")
_RMS = Other("an rms value or an amplitude", "voltage", "form")
_U_SET = (Other("a voltage's set-point", "voltage", "set"), Other("a DC voltage's set-point", "dc_voltage", "set"))
_SETTING = Unclear("a set-point of what?", ("p_set_w", "q_set_var", *_U_SET))
_NOMINAL = Unclear(
    "a nominal value of what?",
    ("frequency_nominal_hz", "apparent_power_nominal_va", "voltage_nominal_v", "v_dc_nominal_v"),
)
OF_TWO_PHASES = Unclear("it looks like a line-to-line voltage, which is not offered; take the phase voltages", ())
_CONVERTER = Other(
    "that of the converter", "voltage", place=BRIDGE, elsewhere=r"capacitors?|grid|mains|network|pcc|terminals?"
)
_C_TO = {
    phase: Other(f"from phase c to {phase}", "voltage", place=LINE_TO_LINE, elsewhere=TO_NEUTRAL)
    for phase in PHASES[:2]
}
_SUPPLY = Other("of a supply", "voltage", place=r"supply|electronics", elsewhere=TO_NEUTRAL)
_V_SETTING = Unclear("a set-point of the grid's or of the DC link's voltage? Give a constant", _U_SET)
_DC_SETTING = Unclear(
    "a set-point of the DC link's voltage is not offered; give a constant, or v_dc_nominal_v", ("v_dc_nominal_v",)
)
_NOT_OFFERED_RMS = Unclear("an rms value or an amplitude is not offered; take the phases", ())
_AVAILABLE = Unclear("what the array can give, or a mean or a limit?", ("p_available_w", _P_MEASURED))
_AMBIGUOUS_INPUTS = {
    **dict.fromkeys(
        ("v", "u", "vg", "ug", "vgrid", "vac", "e"), Unclear("of which phase, and which voltage?", (*_U, _RMS))
    ),
    **{f"e{phase}": Unclear("of which phase, and which voltage?", (f"u_{phase}_v", _RMS)) for phase in PHASES},
    **dict.fromkeys(("i", "ig", "iac", "iinv", "il"), Unclear("a current: of which phase?", _I)),
    **dict.fromkeys(
        ("p", "ppv", "pmeas", "pe"),
        Unclear("a measured power, or a set-point?", ("p_set_w", "p_available_w", _P_MEASURED)),
    ),
    **dict.fromkeys(("q", "qmeas", "qe"), Unclear("a measured power, or a set-point?", ("q_set_var", _Q_MEASURED))),
    **dict.fromkeys(("pav", "pmax"), _AVAILABLE),
    **dict.fromkeys(("vref", "uref", "vset"), _V_SETTING),
    **dict.fromkeys(
        ("vnom", "unom", "vn", "un", "vbase"),
        Unclear(
            "phase to neutral or line to line?", ("voltage_nominal_v", Other("line to line", "voltage", "nominal"))
        ),
    ),
    **dict.fromkeys(
        ("f", "freq", "frequency", "w", "omega"),
        Unclear("nominal or measured?", ("frequency_nominal_hz", Other("a measured one", "frequency", "measured"))),
    ),
    **dict.fromkeys(
        (f"{u}{pair}" for u in "vu" for pair in ("ab", "bc", "12", "23", "31", "l12", "l23", "l31", "ll")),
        OF_TWO_PHASES,
    ),
    **{
        f"{u}c{phase}": Unclear(
            f"of phase {phase} at a capacitor or a converter, or {other.words} (not offered)?",
            (_VOLTS.format(phase), _CONVERTER, other),
        )
        for u in "vu"
        for phase, other in {**_C_TO, "c": _SUPPLY}.items()
    },
    **dict.fromkeys((f"{u}dc{word}" for u in "vu" for word in _SET), _DC_SETTING),
    **dict.fromkeys((f"{u}{word}" for u in "vui" for word in ("rms", "mag", "peak", "amp")), _NOT_OFFERED_RMS),
    **dict.fromkeys(
        (f"{u}{axis}" for u in "vui" for axis in ("d", "q", "alpha", "beta", "dq", "alphabeta")),
        Unclear("a value in a frame is not offered; take the phases", ()),
    ),
    **dict.fromkeys(("temp", "temperature"), Unclear("a temperature is not offered; give a constant", ())),
    **dict.fromkeys((*_SET, *_SET_TOO), _SETTING),
    **dict.fromkeys(("nom", "nominal", "rated", "base"), _NOMINAL),
    **dict.fromkeys(
        ("vbus", "ubus", "vbridge"),
        Unclear("of the DC link, or of a phase?", ("v_dc_v", Other("a phase's voltage", "voltage"))),
    ),
    **dict.fromkeys(
        ("vdcmppt", "vmpp", "vmppt", "umpp", "vdcmpp", "udcmpp"),
        Unclear(
            "the voltage of most power as it is now is not offered; v_dc_nominal_v is that at 1000 W/m2 and 25 C",
            ("v_dc_nominal_v", Other("that of this instant", "dc_voltage", "available")),
        ),
    ),
    "breaker": Unclear("1 closed, or 1 open?", ("connected",)),
    "g": Unclear("an irradiance, or a gain?", ("irradiance_w_m2", _NO_UNIT)),
    "l": Unclear("an inductance, or a number?", ("filter_inductance_h", _NO_UNIT)),
    "r": Unclear("a resistance, or a number?", ("filter_resistance_ohm", _NO_UNIT)),
    "c": Unclear(
        "of the DC link, or of the filter, which has none?",
        ("dc_link_capacitance_f", Other("the filter's", "capacitance")),
    ),
    "s": Unclear(
        "nominal, or measured?",
        ("apparent_power_nominal_va", Other("a measured power", "apparent_power", "measured")),
    ),
    **{
        f"{letter}{k + 1}": Unclear(f"of phase {phase}, or of a sequence or a side?", (stem.format(phase), other))
        for letter, stem, other in (("v", _VOLTS, _RMS), ("u", _VOLTS, _RMS), ("i", _AMPS, Other("another", "current")))
        for k, phase in enumerate(PHASES)
    },
    **{
        f"il{k + 1}": Unclear(
            f"of phase {phase}, or of an inductor L{k + 1}?",
            (_AMPS.format(phase), Other("that of an inductor", "current")),
        )
        for k, phase in enumerate(PHASES)
    },
}
_DUTY = "a duty cycle (unit duty) or a modulating signal?"
_TOLD = "a reference, or what is only told?"
_AMBIGUOUS_OUTPUTS = {
    **dict.fromkeys(("d", "dabc", "dutyabc"), Unclear(_DUTY, ())),
    **dict.fromkeys(("vabc", "uabc"), Unclear(_TOLD, ())),
    **{
        key: Unclear(_DUTY, (_M.format(phase), Other("a share of the link", "share")))
        for phase in PHASES
        for key in (f"d{phase}", f"duty{phase}", f"duty{'123'[PHASES.index(phase)]}")
    },
    **{
        f"{u}{phase}": Unclear(
            _TOLD,
            (_U_REF.format(phase), Other("what is only told", "voltage", "measured")),
        )
        for u in "vu"
        for phase in PHASES
    },
}

WITH_SIBLINGS: Mapping[str, Unclear] = {
    "isc": Unclear("of phase c, or a short-circuit current?", ("i_c_a", Other("a limit", "current", "limit"))),
    "ioc": Unclear("of phase c, or an over-current?", ("i_c_a", Other("a limit", "current", "limit"))),
    **dict.fromkeys(
        ("vsc", "usc"), Unclear("of phase c, or of the converter?", ("u_c_v", Other("another", "voltage")))
    ),
}
"""Names of phase c that mean something else where phases a and b are not beside them."""

PAIRS: Mapping[str, tuple[str, str]] = {f"{u}ca": (f"{u}ab", f"{u}bc") for u in "vu"}
"""Names that are line-to-line voltages where these are beside them."""

EXACT: Mapping[str, Unclear] = {
    "T": Unclear("a time, or a temperature?", ("time_s", Other("a temperature", "temperature"))),
    "T_s": Unclear("a time, or a sample time?", ("time_s", Other("a sample time", "time"))),
}
"""Names of inputs that capitals change the meaning of."""

APPARENT = Unclear("of phase a, or an apparent power?", ("u_a_v", Other("an apparent power", "apparent_power")))
"""`VA` where `VB` and `VC` are not beside it."""


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


def _by_word(words: Mapping[str, Iterable[str]]) -> dict[str, str]:
    return {word: name for name, those in words.items() for word in those}


INPUT_NAMES: Known = (
    _AMBIGUOUS_INPUTS
    | _phase_names(_INPUT_STEMS)
    | {f"{u}{at}{n}": f"u_{ph}_v" for u in "vu" for ph, at, n in _TO_NEUTRAL}
    | _by_word(_INPUT_WORDS)
    | _plain(SIGNALS)
)
OUTPUT_NAMES: Known = (
    _AMBIGUOUS_OUTPUTS
    | _phase_names(_OUTPUT_STEMS)
    | _by_word(_SWITCH_WORDS | _FRAME_WORDS)
    | dict.fromkeys(WORKING, "block")
    | _plain(COMMANDS)
)
TOLD_NAMES: Known = _phase_names(_TOLD_STEMS)
"""Outputs that command where nothing else does, and are only told beside commands."""
