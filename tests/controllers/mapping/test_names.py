"""What a port's name alone means."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ports import port
from pvlvrt_compliance.controllers.mapping.names import guess_input, guess_output
from pvlvrt_compliance.controllers.mapping.sides import map_inputs
from pvlvrt_compliance.simulation.door.exchange import SIGNALS
from pvlvrt_compliance.units import Nominal

NOMINAL = Nominal()


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


@pytest.mark.parametrize(
    ("name", "command", "inverted"),
    [
        *((name, "trip", False) for name in ("trip", "Trip_cmd", "CB_open")),
        *((name, "block", False) for name in ("block", "gate_block", "Blocked")),
        *((name, "block", True) for name in ("pwm_enable", "enable", "gate_enable", "deblock")),
        ("restart", "restart", False),
    ],
)
def test_switches_by_the_names_that_makers_use(name, command, inverted):
    """A trip, a block and its opposite, a restart."""
    found = guess_output(name, 1)
    assert (found.names, found.inverted) == ((command,), inverted)


def test_an_input_that_enables_stays_an_input():
    """What a controller is told by `enabled` is no switch."""
    assert guess_input("enable", 1).names == ("enabled",)
    assert not guess_input("enable", 1).inverted


@pytest.mark.parametrize("third", ["Output current phase B", "Current of phase b, B of RYB"])
def test_phase_b_beside_r_and_y_is_the_third(third):
    """The letters of a description are those of the ports: B is phase c here, and phase b beside A and C."""
    ryb = [port(f"Iout_{x}", description=f"Output current phase {x}") for x in "RY"]
    found = map_inputs([*ryb, port("Iout_B", description=third)], None, NOMINAL)
    assert [p.mapped_to for p in found.ports] == ["i_a_a", "i_b_a", "i_c_a"]
    abc = [port(f"Iout_{x}", description=f"Output current phase {x}") for x in "AC"]
    found = map_inputs([*abc, port("Iout_B", description=third)], None, NOMINAL)
    assert found.ports[2].mapped_to == "i_b_a"
    crossed = map_inputs([*ryb, port("Iout_B", description="Output current phase A")], None, NOMINAL)
    assert crossed.ports[2].mapped_to is None
