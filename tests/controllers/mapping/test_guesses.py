"""What an input means by its name, its unit, its description and the inputs beside it; and what it could mean."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ports import hints, port
from pvlvrt_compliance.controllers.mapping.file import MappingFile
from pvlvrt_compliance.controllers.mapping.names import guess_input, guess_output
from pvlvrt_compliance.controllers.mapping.sides import map_inputs, map_outputs
from pvlvrt_compliance.controllers.mapping.telling import told_of
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, SIGNALS
from pvlvrt_compliance.units import Nominal

NOMINAL = Nominal()


@pytest.mark.parametrize(
    ("name", "unit", "description", "signal"),
    [
        ("Van", "V", "", "u_a_v"),
        ("V_bn", "", "", "u_b_v"),
        ("UL1", "V", "", "u_a_v"),
        ("U_L3", "kV", "", "u_c_v"),
        ("Vta", "kV", "A phase terminal voltage", "u_a_v"),
        ("Va", "kV", "A phase point of control voltage", "u_a_v"),
        ("I1a", "kA", "A phase VSC current", "i_a_a"),
        ("I2b", "kA", "B phase current after capacitor", "i_b_a"),
        ("IcL1", "kA", "C phase current in inductor L1", "i_c_a"),
        ("IL1b", "A", "", "i_b_a"),
        ("P_request", "kW", "", "p_set_w"),
        ("Qdemand", "", "", "q_set_var"),
        ("P*", "W", "", "p_set_w"),
        ("Vdc_meas", "kV", "Measured DC voltage", "v_dc_v"),
        ("Vpv", "V", "PV array voltage", "v_dc_v"),
        ("Idc", "A", "DC link current", "i_dc_a"),
        ("currTime", "s", "Current Time", "time_s"),
        ("T", "s", "", "time_s"),
        ("T", "", "Simulation time", "time_s"),
        ("G", "W/m2", "", "irradiance_w_m2"),
        ("L", "mH", "", "filter_inductance_h"),
        ("setpoint", "Mvar", "", "q_set_var"),
        ("setpoint", "MW", "", "p_set_w"),
        ("nominal", "Hz", "", "frequency_nominal_hz"),
        ("P", "W", "Active power set-point", "p_set_w"),
        ("P", "W", "Available active power", "p_available_w"),
        ("Q", "var", "Requested reactive power", "q_set_var"),
        ("V", "V", "Voltage of phase b", "u_b_v"),
        ("freq", "Hz", "Nominal frequency", "frequency_nominal_hz"),
        ("Vnom", "V", "Rated voltage, phase to neutral, rms", "voltage_nominal_v"),
        ("grid.Va", "V", "", "u_a_v"),
        ("Snom", "kVA", "Rated power", "apparent_power_nominal_va"),
        ("VCa", "kV", "filter capacitor, phase to neutral", "u_a_v"),
        ("VCb", "kV", "filter capacitor, phase to neutral", "u_b_v"),
        ("VCc", "kV", "filter capacitor, phase to neutral", "u_c_v"),
        ("UCa", "V", "Capacitor voltage, phase a", "u_a_v"),
    ],
)
def test_inputs_that_are_clear(name, unit, description, signal):
    """Names of makers; of several meanings the unit or the description leaves one."""
    assert guess_input(name, 1, hints(unit, description)).names == (signal,)


@pytest.mark.parametrize(
    ("name", "description"),
    [
        ("Va", "Measured grid voltage, phase A [V]"),
        ("Va", "Instantaneous phase-A-to-neutral voltage at the PCC"),
        ("Va", "Voltage of phase a (1 pu = peak phase voltage)"),
        ("Va", "Phase A voltage, per unit of the nominal peak"),
        ("Vb", "Grid voltage for a phase-locked loop"),
        ("Ia", "Converter-side current of the LCL filter, phase A"),
        ("Ia", "Inductor current L1, phase a, positive out of the inverter"),
        ("Ia", "Current from the inverter into the grid"),
        ("Ia", "Strom der Phase a"),
        ("Vdc", "DC-link capacitor voltage"),
        ("Vdc", "Voltage of the PV array, used for MPPT"),
        ("Idc", "DC input current of the inverter"),
        ("Idc", "DC current into the voltage source converter"),
        ("Ipv", "DC/DC converter input current"),
        ("Pref", "Active power setpoint from the plant controller"),
        ("Pref", "Active power reference, per unit of rated power"),
        ("Qref", "Reactive power order (or a voltage order)"),
        ("Pavail", "Maximum available power of the array"),
        ("Snom", "MVA base"),
        ("fnom", "Base frequency"),
        ("t", "Time since the start of the simulation"),
        ("irradiance", "Solar irradiance on the panels"),
        ("enable", "Enable current control (1 = enabled, 0 = blocked)"),
        ("enable", "1 enabled, 0 blocked"),
        ("connected", "Breaker: 1 closed, 0 open"),
    ],
)
def test_descriptions_that_contradict_nothing(name, description):
    """What a description says beside the point, or in another language, unties no name."""
    assert guess_input(name, 1, hints("", description)).names == guess_input(name, 1).names != ()


@pytest.mark.parametrize(
    ("name", "unit", "description", "candidates"),
    [
        ("Idc", "kA", "Current from Primary Power Source", "i_dc_a i_pv_a"),
        ("pv.Idc", "A", "", "i_dc_a i_pv_a"),
        ("Ipv", "A", "DC current into the bridge", "i_pv_a i_dc_a"),
        ("T", "", "", "time_s"),
        ("T", "C", "Panel temperature", "time_s"),
        ("T", "s", "Panel temperature", "time_s"),
        ("T_s", "", "", "time_s"),
        ("t", "C", "", "time_s"),
        ("Va", "", "Voltage of phase B", "u_a_v u_b_v"),
        ("Va", "V", "Line-to-line voltage", "u_a_v"),
        ("Va", "kVA", "", "u_a_v apparent_power_nominal_va"),
        ("VA", "", "", "u_a_v"),
        ("Ia", "A", "RMS current of phase a", "i_a_a"),
        ("Ia", "A", "Load current, phase a", "i_a_a"),
        ("Vdc", "V", "DC voltage reference", "v_dc_v"),
        ("Vdc", "V", "Nominal DC voltage", "v_dc_v v_dc_nominal_v"),
        ("Vdc", "A", "", "v_dc_v"),
        ("Vdc_kV", "V", "", "v_dc_v"),
        ("Vdc*", "V", "", "v_dc_nominal_v"),
        ("Pref", "W", "Measured active power", "p_set_w"),
        ("Qref", "", "Active power set-point", "q_set_var p_set_w"),
        ("Pmax", "W", "", "p_available_w"),
        ("P", "MW", "", "p_set_w p_available_w"),
        ("fnom", "Hz", "Measured grid frequency", "frequency_nominal_hz"),
        ("Vnom", "V", "RMS L-L base voltage", "voltage_nominal_v"),
        ("VdcMPPT", "kV", "Maximum power point voltage", "v_dc_nominal_v"),
        ("VCa", "V", "", "u_a_v"),
        ("VCa", "V", "phase to neutral", "u_a_v"),
        ("VCa", "V", "Converter voltage, phase a", "u_a_v"),
        ("VCA", "V", "Voltage between phase C and phase A", "u_a_v"),
        ("Va", "V", "from phase a to phase b", "u_a_v voltage_nominal_v"),
        ("Vcc", "V", "Supply of the electronics", "u_c_v"),
        ("Isc", "A", "", "i_c_a"),
        ("IL1", "A", "", "i_a_a"),
        ("breaker", "", "", "connected"),
        ("enable", "", "Disables the gates", "enabled"),
        ("Δt", "", "", "time_s"),
        ("ΔVdc", "V", "", "v_dc_v"),
        ("Vαb", "V", "", "u_b_v"),
        ("-Ia", "A", "", "i_a_a"),
        ("|Vdc|", "V", "", "v_dc_v"),
        ("Vγ", "V", "", "u_a_v u_b_v u_c_v"),
    ],
)
def test_inputs_that_are_left_with_their_candidates(name, unit, description, candidates):
    """What unit, description or letters contradict is no guess: the note names what it could be."""
    found = guess_input(name, 1, hints(unit, description))
    assert (found.names, found.candidates) == ((), tuple(candidates.split()))
    assert all(name in found.note for name in found.candidates)


@pytest.mark.parametrize(
    ("name", "description", "beside", "of_two_phases"),
    [
        ("VCA", "", "VAB VBC VCA", True),
        ("VCa", "", "VCa VCb VCc", True),
        ("VCa", "phase to neutral", "VCa VCb VCc", False),
        ("VCb", "phase to neutral", "VCa VCb VCc", False),
    ],
)
def test_what_is_said_of_a_voltage_of_two_meanings(name, description, beside, of_two_phases):
    """From phase c to a, or of a capacitor's phase: what the description denies is not said."""
    found = guess_input(name, 1, hints("V", description, beside))
    assert found.names == ()
    could = found.note.partition("It could be ")[2] or found.note
    assert ("from phase c" in could or "line-to-line" in could) == of_two_phases


@pytest.mark.parametrize("name", ["i_dc_a", "v_dc_v", "u_b_v", "p_set_w"])
def test_a_name_spelled_as_here_is_meant_so(name):
    """Whatever words stand beside it; its unit counts all the same."""
    words = "Error of the current from the primary source, phase A, line to line"
    assert guess_input(name, 1, hints("", words)).names == (name,)
    assert guess_input(name, 1, hints("degC", words)).names == ()


@pytest.mark.parametrize("name", ["main", "tin", "vmin", "Vain", "enin", "Vdc-Vpv", "Ångström", "draw"])
def test_no_other_name_comes_out_of_one(name):
    """Neither letters nor the end of a word are dropped where they are no word like measured."""
    assert guess_input(name, 1) == guess_output(name, 1) == type(guess_input(name, 1))()


@pytest.mark.parametrize(
    ("names", "signals"),
    [
        ("U1 U2 U3", "u_a_v u_b_v u_c_v"),
        ("VR VS VT", "u_a_v u_b_v u_c_v"),
        ("VR VY VB", "u_a_v u_b_v u_c_v"),
        ("Iu Iv Iw", "i_a_a i_b_a i_c_a"),
        ("IL1 IL2 IL3", "i_a_a i_b_a i_c_a"),
        ("Isa Isb Isc", "i_a_a i_b_a i_c_a"),
        ("Vabc[1] Vabc[2] Vabc[3]", "u_a_v u_b_v u_c_v"),
        ("Vabc[0] Vabc[1] Vabc[2]", "u_a_v u_b_v u_c_v"),
        ("VA VB VC", "u_a_v u_b_v u_c_v"),
    ],
)
def test_phases_by_the_ports_beside(names, signals):
    """Three names that differ in a mark of their phase are phases; alone, none of these is."""
    found = [guess_input(name, 1, hints(beside=names)) for name in names.split()]
    assert [guess.names for guess in found] == [(signal,) for signal in signals.split()]
    if names.split()[0] not in ("Isa",):
        assert guess_input(names.split()[0], 1).names == ()


@pytest.mark.parametrize("names", ["V1 V2", "V0 V1 V2", "V1 V2 V3 V4", "Va1 Va2 Va3", "S1 S2 S3"])
def test_marks_that_are_no_phases(names):
    """Sequences, four of something, three places of one phase."""
    assert not any(guess_input(name, 1, hints(beside=names)).names for name in names.split())


@pytest.mark.parametrize("name", ["I1", "I2_abc", "i_abc_grid", "IL1", "I_L123"])
def test_a_wide_port_of_either_side_of_the_filter(name):
    """Three elements are phases a, b and c."""
    assert guess_input(name, 3).names == ("i_a_a", "i_b_a", "i_c_a")


PUBLIC = [
    *(port(f"Vt{p}", "kV", description=f"{p.upper()} phase terminal voltage") for p in "abc"),
    *(port(f"I1{p}", "kA", description=f"{p.upper()} phase VSC current") for p in "abc"),
    *(port(f"I2{p}", "kA", description=f"{p.upper()} phase current after capacitor") for p in "abc"),
    port("Idc", "kA", description="Current from Primary Power Source"),
    port("VdcMPPT", "kV", description="Maximum power point voltage"),
    port("Pref", "MW", description="Active power reference "),
    port("Qref", "Mvar", description="Reactive power reference"),
    port("Vdc_meas", "kV", description="Measured DC Voltage"),
    port("currTime", "s", description="Current Time"),
]
"""Inputs of a public model of an inverter by the IEEE/CIGRE interface, as it announces them."""


def test_ports_of_a_public_model():
    """All are tied but the current that was tied to the wrong side of the link, and a voltage that is not offered."""
    mapped = map_inputs(PUBLIC, None, NOMINAL)
    assert mapped.unmapped == ("Idc", "VdcMPPT")
    assert [SIGNALS[element.signal] for element in mapped.elements] == [
        *("u_a_v", "u_b_v", "u_c_v", "i_a_a", "i_b_a", "i_c_a", "i_a_a", "i_b_a", "i_c_a"),
        *("p_set_w", "q_set_var", "v_dc_v", "time_s"),
    ]
    words = {"m_a": "Phase A modulating signal", "m_b": "Phase B modulating signal", "m_c": "Phase C modulating signal"}
    outputs = [port(name, "N/A", description=text) for name, text in words.items()]
    outputs += [port("FreqPLL", "Hz", description="PLL frequency"), port("Output_1", "N/A", description="current flag")]
    mapped = map_outputs(outputs, None, NOMINAL)
    assert (mapped.missing, mapped.recorded) == ((), ("FreqPLL", "Output_1"))


def test_two_ports_on_one_quantity_are_told():
    """By both ports, and once for a run; ports that are given different signals are not."""
    names = ["I1a", "I1b", "I1c", "I2a", "I2b", "I2c", "Vdc", "Va"]
    ports = map_inputs([port(name) for name in names], None, NOMINAL).ports
    words = "I1a and I2a are the same current here: the filter has one"
    assert [p.note for p in ports if p.name in ("I1a", "I2a")] == [words, words]
    assert [p.note for p in ports[-2:]] == ["", ""]
    assert list(told_of(ports)) == [
        "I1a and I2a, I1b and I2b, I1c and I2c are each the same current here: the filter has one"
    ]
    two = map_inputs([port("Vdc"), port("Vpv")], None, NOMINAL).ports
    assert list(told_of(two)) == ["Vdc and Vpv are the same DC voltage here: the array lies on the link"]


@pytest.mark.parametrize("words", ["Current from the grid, phase a", "Phase A current into the converter"])
def test_a_current_of_the_other_direction_is_left(words):
    """A sign is no guess; a file that says the direction of all currents decides."""
    ports = [port("Ia", "A", description=words)]
    (left,) = map_inputs(ports, None, NOMINAL).ports
    assert left.mapped_to is None
    assert 'direction = "into_inverter"' in left.note
    mapping = MappingFile.model_validate({"currents": "into_inverter"})
    assert [element.gain for element in map_inputs(ports, mapping, NOMINAL).elements] == [-1.0]


@given(st.text(max_size=30), st.sampled_from(["", "V", "kA", "C", "pu", "W", "??"]), st.text(max_size=60))
def test_a_tie_never_contradicts_its_unit(name, unit, description):
    """Whatever stands there: what is tied takes the unit; what could be is a name that there is."""
    for guess, names in ((guess_input, SIGNALS), (guess_output, COMMANDS)):
        found = guess(name, 1, hints(unit, description))
        assert {*found.names, *found.candidates} <= set(names)
        assert not (found.names and found.candidates)
        assert not (unit in ("C", "??") and found.names)


@pytest.mark.parametrize("name", ["meas" * 50_000, "1" * 200_000, "V" + "." * 100_000, "_in" * 50_000])
def test_a_name_of_any_length(name):
    """What no maker writes means nothing."""
    assert not guess_input(name, 1, hints(description=name)).names
