"""Ports tied to the plant: by name, by mapping file, in the port's own unit."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ports import port
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.mapping.commands import check_commands, missing_commands
from pvlvrt_compliance.controllers.mapping.constants import set_constants
from pvlvrt_compliance.controllers.mapping.file import MappingFile
from pvlvrt_compliance.controllers.mapping.sides import map_inputs, map_outputs
from pvlvrt_compliance.controllers.mapping.telling import told_of
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, SIGNALS
from pvlvrt_compliance.simulation.door.ports import INT16, REAL32
from pvlvrt_compliance.units import Nominal

NOMINAL = Nominal()


def one_input(name, port_unit="", /, **entry):
    """The only element of an input, from its entry in a mapping file or from its name."""
    mapping = MappingFile.model_validate({"inputs": {name: entry}} if entry else {})
    (element,) = map_inputs([port(name, port_unit)], mapping, NOMINAL).elements
    return element


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
    for kind in ("modulating", "voltage", "dq"):
        mapped = map_outputs(ports, MappingFile(output_kind=kind), NOMINAL)
        assert (mapped.in_volts, mapped.in_a_frame) == (kind != "modulating", kind == "dq")


def test_voltages_in_a_frame():
    """Direct, quadrature and angle, in units of theirs; the angle by a mapping or by its name."""
    ports = [port("Vd_ref", "kV"), port("Vq_ref", "kV", byte=8), port("theta_ref", "deg", byte=16)]
    mapped = map_outputs(ports, None, NOMINAL)
    assert [COMMANDS[e.signal] for e in mapped.elements] == ["u_d_ref_v", "u_q_ref_v", "angle_rad"]
    assert [e.gain for e in mapped.elements] == pytest.approx([1e-3, 1e-3, 180 / math.pi])
    assert (mapped.in_a_frame, mapped.missing) == (True, ())
    assert map_outputs([port("Vd_ref")], None, NOMINAL).missing == ("u_q_ref_v", "angle_rad")


def test_a_switch_that_says_the_opposite():
    """An enable of 1 is a block of 0, by its name or as a file says; the port is shown as not the command."""
    for mapping in (None, MappingFile.model_validate({"outputs": {"ena": {"command": "block", "inverted": True}}})):
        name = "pwm_enable" if mapping is None else "ena"
        mapped = map_outputs([port(name)], mapping, NOMINAL)
        (element,) = mapped.elements
        assert (COMMANDS[element.signal], element.gain, element.offset) == ("block", -1.0, 1.0)
        assert mapped.ports[0].mapped_to == "not block"


@pytest.mark.parametrize("entry", [{"command": "m_a", "inverted": True}, {"record": "x", "inverted": True}])
def test_only_switches_have_an_opposite(entry):
    """A voltage, or a number that is recorded, cannot be inverted: the message says what can."""
    with pytest.raises(DoorError, match=r"inverted is for switches \(trip, block, restart\)"):
        map_outputs([port("y")], MappingFile.model_validate({"outputs": {"y": entry}}), NOMINAL)


def test_two_outputs_of_one_switch():
    """A block and an enable are the same command, and cannot both give it."""
    with pytest.raises(DoorError, match="gate_block and enable both give block"):
        map_outputs([port("gate_block"), port("enable")], None, NOMINAL)


@pytest.mark.parametrize("index", ["9" * 9, "9" * 10, "9" * 5000])
def test_an_element_of_any_number(index):
    """One that the port does not have is refused, whatever its number, though Python makes none of so many digits."""
    mapping = MappingFile.model_validate({"inputs": {f"u[{index}]": {"signal": "u_a_v"}}})
    with pytest.raises(DoorError, match=r"u has 3 elements, counted from 0|the controller has no such input"):
        map_inputs([port("u", width=3)], mapping, NOMINAL)


@pytest.mark.parametrize("name", ["I_größe", "P out", "2nd"])
def test_an_output_whose_name_is_no_channel_is_told(name):
    """It is not recorded, and every run says why; with a name from a file it is."""
    ports = map_outputs([port(name), port(f"{name}.")], None, NOMINAL).ports
    assert [(output.mapped_to, output.note.partition(";")[0]) for output in ports] == 2 * [
        (None, "not recorded: its name cannot be that of a channel")
    ]
    (told,) = told_of((), ports)
    assert told.startswith(f"not recorded, as a channel cannot be called so: outputs {name} and {name}.; ")
    named = MappingFile.model_validate({"outputs": {name: {"record": "p_out_w"}}})
    assert map_outputs([port(name)], named, NOMINAL).recorded == ("p_out_w",)


def test_an_output_of_several_numbers_is_told():
    """It is not recorded, and every run says why; with a name for each from a file it is."""
    wide = port("p_steps", width=2)
    (output,) = ports = map_outputs([wide], None, NOMINAL).ports
    assert output.mapped_to is None
    assert list(told_of((), ports)) == [f"output p_steps: {output.note}"]
    assert output.note.startswith("not recorded: it is 2 numbers; a mapping file names them, {record = [")
    named = MappingFile.model_validate({"outputs": {"p_steps": {"record": ["p_now", "p_next"]}}})
    assert map_outputs([wide], named, NOMINAL).recorded == ("p_now", "p_next")
