"""What an output means by its name, its unit, its description and the outputs beside it; and what it could mean."""

import pytest

from ports import hints, port
from pvlvrt_compliance.controllers.mapping.names import guess_output
from pvlvrt_compliance.controllers.mapping.sides import map_outputs
from pvlvrt_compliance.controllers.mapping.telling import reasons
from pvlvrt_compliance.units import Nominal

NOMINAL = Nominal()


@pytest.mark.parametrize(
    ("name", "width", "unit", "description", "found"),
    [
        ("v_bridge", 3, "V", "", "u_a_ref_v u_b_ref_v u_c_ref_v"),
        ("v_bridge_a", 1, "V", "", "u_a_ref_v"),
        ("Ea", 1, "kV", "A phase inverter voltage", "u_a_ref_v"),
        ("m_a", 1, "", "modulating signal, of half the DC link's voltage", "m_a"),
        ("ma", 1, "", "Normalised voltage reference of phase a", "m_a"),
        ("da", 1, "duty", "Duty cycle of phase a", "m_a"),
        ("d_abc", 3, "duty", "", "m_a m_b m_c"),
        ("Va", 1, "V", "Voltage reference, phase a", "u_a_ref_v"),
        ("trip", 1, "", "Trips on over-voltage", "trip"),
    ],
)
def test_outputs_that_are_clear(name, width, unit, description, found):
    """Commands by the names, units and descriptions of makers."""
    assert guess_output(name, width, hints(unit, description)).names == tuple(found.split())


@pytest.mark.parametrize(
    ("name", "width", "unit", "description", "candidates"),
    [
        ("da", 1, "", "", "m_a"),
        ("da", 1, "%", "", "m_a"),
        ("da", 1, "", "Duty cycle of phase a", "m_a"),
        ("d_abc", 3, "", "", "m_a m_b m_c"),
        ("Va", 1, "V", "", "u_a_ref_v"),
        ("Va", 1, "V", "Measured voltage of phase a", "u_a_ref_v"),
        ("Ea", 1, "", "Phase A modulating signal", "u_a_ref_v m_a"),
        ("trip", 1, "", "Trip counter", "trip"),
        ("ma", 1, "V", "Phase a voltage reference", "m_a u_a_ref_v"),
    ],
)
def test_outputs_that_are_left_with_their_candidates(name, width, unit, description, candidates):
    """Neither commanded nor recorded: it is told what they could be."""
    found = guess_output(name, width, hints(unit, description))
    assert (found.names, found.candidates) == ((), tuple(candidates.split()))
    mapped = map_outputs([port(name, unit, width, description=description)], None, NOMINAL)
    assert (mapped.elements, mapped.recorded) == ((), ())
    assert reasons(mapped.ports) == (f"{name} ({found.note})",)


def test_voltages_of_the_bridge_beside_modulating_signals():
    """They are told, as they always were, where others command; by name or by a file."""
    outputs = [port(f"v_bridge_{phase}") for phase in "abc"]
    beside = [*(port(f"m_{phase}") for phase in "abc"), *outputs]
    mapped = map_outputs(beside, None, NOMINAL)
    assert (mapped.in_volts, mapped.recorded) == (False, ("v_bridge_a", "v_bridge_b", "v_bridge_c"))
    assert map_outputs(outputs, None, NOMINAL).in_volts


def test_a_measured_output_is_no_command():
    """What an output calls measured is told."""
    assert map_outputs([port("ma_meas")], None, NOMINAL).recorded == ("ma_meas",)
