"""Ports tied to the plant: by name, by mapping file, in the port's own unit."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.simulation.doors.base import DoorError
from pvlvrt_compliance.simulation.doors.mapping import (
    MappingFile,
    RawPort,
    check_commands,
    load_mapping,
    map_inputs,
    map_outputs,
    missing_commands,
    set_constants,
)
from pvlvrt_compliance.simulation.doors.port_names import guess_input
from pvlvrt_compliance.simulation.exchange import COMMANDS, SIGNALS
from pvlvrt_compliance.simulation.ports import INT16, REAL32, REAL64
from pvlvrt_compliance.units import Nominal

NOMINAL = Nominal()


def port(name, unit="", width=1, byte=0, kind=REAL64):
    """A port."""
    return RawPort(name, unit, width, byte, kind)


def one_input(name, port_unit="", /, **entry):
    """The only element of an input, from its entry in a mapping file or from its name."""
    mapping = MappingFile.model_validate({"inputs": {name: entry}} if entry else {})
    (element,) = map_inputs([port(name, port_unit)], mapping, NOMINAL).elements
    return element


@pytest.mark.parametrize(
    ("names", "signal"),
    [
        ("Va va V_a ua u_a VA_grid vga Vpcc_a u_a_v Va_meas U_A_PU vat", "u_a_v"),
        ("Vb ub u_b Vgb Vb_pcc", "u_b_v"),
        ("Ia ia I_a IaInv i_a_a ILa iga Ia_kA", "i_a_a"),
        ("Ic ic IcInv", "i_c_a"),
        ("Vdc vdc Udc V_DC Vdc_kV v_dc_v Vdc_meas Vdclink", "v_dc_v"),
        ("Idc", "i_dc_a"),
        ("Ipv i_pv I_PV", "i_pv_a"),
        ("Pref P_ref pset p_set_w", "p_set_w"),
        ("Qref q_ref Qset", "q_set_var"),
        ("time t Time currTime", "time_s"),
        ("ma m_a", "m_a"),
        ("enable enabled", "enabled"),
        ("fnom", "frequency_nominal_hz"),
    ],
)
def test_usual_names_are_understood(names, signal):
    """A name that can mean one signal only is tied to it, however it is spelled."""
    for name in names.split():
        assert guess_input(name, 1).names == (signal,), name


@pytest.mark.parametrize("name", ["V", "I", "P", "Q", "Vref", "Vab", "Vnom", "freq", "Ea"])
def test_names_with_two_meanings_are_left_and_said_so(name):
    """Nothing is tied on a guess; the port's note says what is not clear."""
    mapped = map_inputs([port(name)], None, NOMINAL)
    assert mapped.elements == ()
    assert mapped.unmapped == (name,)
    assert mapped.ports[0].note


@given(st.text(max_size=20), st.integers(1, 4))
def test_any_name_is_tied_to_what_there_is_or_to_nothing(name, width):
    """Whatever a controller calls its ports, inspection does not fail, and every element is accounted for."""
    mapped = map_inputs([port(name, width=width)], None, NOMINAL)
    assert len(mapped.elements) + len(mapped.unmapped) == width
    assert all(0 <= element.signal < len(SIGNALS) for element in mapped.elements)


@pytest.mark.parametrize("name", ["V_abc", "Vabc", "u", "Vg", "uabc_pu", "v_grid"])
def test_wide_port_is_tied_phase_by_phase(name):
    """The elements of a port for three phases are phases a, b and c, one number after another."""
    mapped = map_inputs([port(name, width=3, byte=16, kind=REAL32)], None, NOMINAL)
    assert [SIGNALS[e.signal] for e in mapped.elements] == ["u_a_v", "u_b_v", "u_c_v"]
    assert [e.byte for e in mapped.elements] == [16, 20, 24]
    assert mapped.ports[0].mapped_to == "u_a_v, u_b_v, u_c_v"


@pytest.mark.parametrize(
    ("signal", "unit", "expected"),
    [
        ("u_a_v", "V", 1.0),
        ("u_a_v", "kV", 1e-3),
        ("u_a_v", "pu", 1 / (math.sqrt(2) * 230)),
        ("i_a_a", "kA", 1e-3),
        ("i_a_a", "p.u.", 1 / (math.sqrt(2) * 500e3 / 690)),
        ("p_set_w", "MW", 1e-6),
        ("q_set_var", "MVAR", 1e-6),
        ("q_set_var", "kvar", 1e-3),
        ("p_set_w", "pu", 1 / 500e3),
        ("frequency_nominal_hz", "rad/s", 2 * math.pi),
        ("frequency_nominal_hz", "pu", 0.02),
        ("time_s", "ms", 1e3),
        ("apparent_power_nominal_va", "MVA", 1e-6),
        ("m_a", "%", 100.0),
    ],
)
def test_number_is_in_the_unit_of_the_port(signal, unit, expected):
    """Units are converted, per unit by the nominal values."""
    element = one_input("x", unit, signal=signal)
    assert (SIGNALS[element.signal], element.offset) == (signal, 0.0)
    assert element.gain == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(
    ("bases", "signal", "base"),
    [
        ({"voltage": "phase_rms"}, "u_a_v", 230.0),
        ({"voltage": "line_rms"}, "u_a_v", math.sqrt(3) * 230),
        ({"voltage": "line_peak"}, "u_a_v", math.sqrt(6) * 230),
        ({"voltage_v": 400.0}, "u_a_v", 400.0),
        ({"current": "phase_rms"}, "i_a_a", 500e3 / 690),
        ({"current_a": 1000.0}, "i_a_a", 1000.0),
        ({"power_va": 1e6}, "q_set_var", 1e6),
        ({"dc_voltage_v": 800.0}, "v_dc_v", 800.0),
        ({"dc_voltage_v": 800.0}, "i_pv_a", 625.0),
        ({"dc_voltage_v": 800.0, "dc_current_a": 600.0}, "i_dc_a", 600.0),
        ({"frequency_hz": 60.0}, "frequency_nominal_hz", 60.0),
    ],
)
def test_per_unit_bases_can_be_set(bases, signal, base):
    """1 pu is what the mapping file says."""
    mapping = MappingFile.model_validate({"inputs": {"x": signal}, "bases": bases})
    (element,) = map_inputs([port("x", "pu")], mapping, NOMINAL).elements
    assert element.gain == pytest.approx(1 / base, rel=1e-15)


def test_base_of_one_port_and_its_unit_win():
    """What an entry says of its port stands above the bases and above the controller's own unit."""
    assert one_input("x", "pu", signal="v_dc_v", base=750.0).gain == 1 / 750
    assert one_input("x", "V", signal="v_dc_v", unit="kV").gain == 1e-3


def test_signs_and_directions():
    """A sign turns any signal, a direction phase currents, all of them or one."""
    assert one_input("x", "A", signal="i_pv_a", sign=-1).gain == -1.0
    assert one_input("x", "A", signal="i_b_a", direction="into_inverter").gain == -1.0
    table = {"currents": "into_inverter", "inputs": {"Ib": {"signal": "i_b_a", "direction": "out_of_inverter"}}}
    mapped = map_inputs([port("Ia"), port("Ib"), port("Idc")], MappingFile.model_validate(table), NOMINAL)
    assert [element.gain for element in mapped.elements] == [-1.0, 1.0, 1.0]


def test_elements_and_constants_of_a_wide_port():
    """An element by itself wins over its port; constants are in the port's unit and type."""
    table = {"inputs": {"x": ["u_a_v", "u_b_v", "u_c_v"], "x[1]": 7.6, "k": {"constant": 1.5}}}
    ports = [port("x", "kV", 3, 0, INT16), port("k", "Hz", 1, 8)]
    mapped = map_inputs(ports, MappingFile.model_validate(table), NOMINAL)
    assert [(SIGNALS[e.signal], e.byte) for e in mapped.elements] == [("u_a_v", 0), ("u_c_v", 4)]
    memory = np.zeros(16, dtype=np.uint8)
    set_constants(memory, mapped.constants)
    assert memory.view(np.int16)[1] == 8
    assert memory.view(np.float64)[1] == 1.5
    assert [p.mapped_to for p in mapped.ports] == ["u_a_v, 7.6, u_c_v", "1.5"]


@given(st.floats(-1, 1), st.sampled_from(["", "%", "duty", "pu"]))
def test_command_comes_back_from_its_unit(m, unit):
    """A modulating signal written in a unit is read as the same one; a duty cycle of one half is none."""
    mapping = MappingFile.model_validate({"outputs": {"d": {"command": "m_a", "unit": unit}}})
    (element,) = map_outputs([port("d")], mapping, NOMINAL).elements
    number = element.gain * m + element.offset
    assert (number - element.offset) / element.gain == pytest.approx(m, abs=1e-15)
    assert unit != "duty" or number == pytest.approx((1 + m) / 2)


@pytest.mark.parametrize("names", ["ma mb mc", "m_a m_b m_c", "Ma_ref Mb_ref Mc_ref", "mod_a mod_b mod_c"])
def test_modulating_signals_by_name(names):
    """Usual names of modulating signals make a controller that can be run."""
    mapped = map_outputs([port(name) for name in names.split()], None, NOMINAL)
    check_commands(mapped)
    assert not mapped.in_volts


@pytest.mark.parametrize(
    "names", ["Ea Eb Ec", "Uref_a Uref_b Uref_c", "va_ref vb_ref vc_ref", "u_a_ref_v u_b_ref_v u_c_ref_v"]
)
def test_voltage_references_by_name(names):
    """Usual names of voltage references, too, which are taken in volts."""
    mapped = map_outputs([port(name, "kV") for name in names.split()], None, NOMINAL)
    check_commands(mapped)
    assert mapped.in_volts
    assert [element.gain for element in mapped.elements] == [1e-3] * 3


def test_other_outputs_are_recorded_under_their_names():
    """What commands nothing becomes a channel; what would take a channel's name away does not."""
    mapped = map_outputs([port("mabc", width=3), port("p_ref_w"), port("v_dc_v"), port("mode")], None, NOMINAL)
    assert mapped.recorded == ("p_ref_w", "mode")
    assert [element.signal - len(COMMANDS) for element in mapped.elements[3:]] == [0, 1]
    assert mapped.unmapped == ("v_dc_v",)


def test_file_wins_over_names():
    """A command that the file gives to one output is not given to another by its name."""
    table = {"outputs": {"x": "m_a"}}
    mapped = map_outputs([port("ma"), port("mb"), port("mc"), port("x")], MappingFile.model_validate(table), NOMINAL)
    assert [p.mapped_to for p in mapped.ports] == [None, "m_b", "m_c", "m_a"]


def test_missing_commands_are_refused_with_what_is_free():
    """Without commands for all three phases a controller is not run; the error lists what is missing."""
    mapped = map_outputs([port("ma"), port("dc")], None, NOMINAL)
    with pytest.raises(DoorError, match=r"no output gives m_b, m_c; outputs that give nothing yet: dc\."):
        check_commands(mapped)
    assert missing_commands(mapped.ports) == ("m_b", "m_c")
    volts = map_outputs([port("Ea"), port("Eb"), port("ma")], None, NOMINAL)
    assert missing_commands(volts.ports) == volts.missing == ("u_c_ref_v",)


def test_two_complete_kinds_of_commands_ask_which():
    """Neither modulating signals nor voltages are taken by chance."""
    ports = [port(name) for name in COMMANDS]
    with pytest.raises(DoorError, match="output_kind"):
        map_outputs(ports, None, NOMINAL)
    for kind in ("modulating", "voltage"):
        assert map_outputs(ports, MappingFile(output_kind=kind), NOMINAL).in_volts == (kind == "voltage")


def map_both(file, inputs, outputs):
    """Tie both sides as a file says."""
    mapping = load_mapping(file)
    map_inputs(inputs, mapping, NOMINAL)
    map_outputs(outputs, mapping, NOMINAL)


def refused(tmp_path, text, inputs=(), outputs=()):
    """What is said of a mapping file, without the name of its folder."""
    file = tmp_path / "my.mapping.toml"
    file.write_text(text, "utf-8")
    with pytest.raises(DoorError) as found:
        map_both(file, inputs, outputs)
    return str(found.value).replace(f"{tmp_path}/", "")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "[inputs]\nVdcc = 'v_dc_v'",
            'my.mapping.toml:2: inputs.Vdcc: the controller has no such input; did you mean "Vdc"?',
        ),
        ("[inputs]\n\nVdc = 'v_dc'", "my.mapping.toml:3: inputs.Vdc: 'v_dc' is no signal; did you mean \"v_dc_v\""),
        (
            "[inputs]\nVdc = {signal = 'v_dc_v', unit = 'kA'}",
            "the unit 'kA' does not fit a DC voltage; allowed: V, kV, pu",
        ),
        ("[inputs]\nVdc = {signal = 'v_dc_v', unit = 'pu'}", "write dc_voltage_v under [bases]"),
        ("[inputs]\nVdc = {signal = 'v_dc_v', unit = 'V', base = 1.0}", "a base is for ports in pu, not in V"),
        ("[inputs]\nVdc = {signal = 'v_dc_v', direction = 'into_inverter'}", "direction is for phase currents"),
        ("[inputs]\nabc = 'u_a_v'", "1 name for 3 elements"),
        ("[inputs]\nabc = ['u_a_v', 'u_b_v']", "2 names for 3 elements"),
        ("[inputs]\nabc = []", "0 names for 3 elements"),
        ("[inputs]\n'abc[3]' = 'u_a_v'", "abc has 3 elements, counted from 0"),
        ("[inputs]\nVdc = true", "my.mapping.toml:2: inputs.Vdc: must be a table"),
        ("[inputs]\nVdc = {unit = 'V'}", "give a signal or a constant"),
        ("[inputs]\nVdc = {signal = 'v_dc_v', sing = -1}", 'unknown key; did you mean "sign"'),
        ("[input]\nVdc = 'v_dc_v'", 'unknown key; did you mean "inputs"'),
        ("[bases]\nvoltage = 'rms'", "my.mapping.toml:2: bases.voltage:"),
        ("[outputs]\nma = 'm_d'", "'m_d' is no command"),
        ("[outputs]\nma = {record = 'v_dc_v'}", "the record has a channel 'v_dc_v' already"),
        ("[outputs]\nma = {record = 'a b'}", "not a name for a channel"),
        ("[outputs]\nma = 'm_a'\nmb = 'm_a'", "ma and mb both give m_a"),
        ("[outputs\n", "not TOML"),
    ],
)
def test_mistakes_are_told_by_line_and_key(tmp_path, text, words):
    """Every mistake in a mapping file names its place and what is allowed."""
    inputs = [port("Vdc", "V"), port("abc", "V", 3)]
    assert words in refused(tmp_path, text, inputs, [port("ma"), port("mb")])


def test_all_problems_at_once(tmp_path):
    """Two mistakes are told in one go."""
    said = refused(tmp_path, "[inputs]\na = 'x'\nb = {signal = 'u_a_v', unit = 'W'}", [port("a"), port("b")])
    assert said.splitlines()[0].endswith("2 problems")
    assert [line.split(":")[1] for line in said.splitlines()[1:]] == ["2", "3"]


def test_unit_that_does_not_fit_a_name_leaves_the_port_untied():
    """A name alone forces nothing: the port is left, with the reason, so that it can be looked at."""
    mapped = map_inputs([port("Vdc", "pu"), port("Va", "W")], None, NOMINAL)
    assert mapped.unmapped == ("Vdc", "Va")
    assert "dc_voltage_v" in mapped.ports[0].note
    assert "does not fit a voltage" in mapped.ports[1].note


def test_no_mapping_file_is_none():
    """Nothing is read where nothing is named; a file that is not there is an error."""
    assert load_mapping(None) is None
    with pytest.raises(DoorError, match="cannot be read"):
        load_mapping("absent.toml")


def test_example_on_the_page_is_a_mapping_file(tmp_path):
    """The file that the documentation shows is one, for a controller with its ports."""
    page = (Path(__file__).parents[3] / "docs" / "controllers.md").read_text("utf-8")
    file = tmp_path / "page.mapping.toml"
    file.write_text(page.partition("```toml\n")[2].partition("```")[0], "utf-8")
    names = ["Va", "Vdc", "Vdc_pu", "Ia", "Ipv", "Vref"]
    inputs = [*(port(name) for name in names), port("V_abc", width=3), port("y", width=4)]
    mapped = map_inputs(inputs, load_mapping(file), NOMINAL)
    assert mapped.unmapped == ("y[0]", "y[1]", "y[2]")
    assert map_outputs([port("ma"), port("Ea"), port("Pout", "W")], load_mapping(file), NOMINAL).recorded == (
        "p_out_w",
    )
