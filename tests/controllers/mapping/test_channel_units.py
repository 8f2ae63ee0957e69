"""Outputs that are recorded in another unit than their own: what a channel holds of a port's number."""

import pytest

from ports import port
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.mapping.channel_units import unit_of_channel
from pvlvrt_compliance.controllers.mapping.file import MappingFile
from pvlvrt_compliance.controllers.mapping.sides import map_outputs
from pvlvrt_compliance.units import Nominal

NOMINAL = Nominal()
S = NOMINAL.apparent_power_va


def recorded(entry, number, unit="", **bases):
    """What the channel of an entry holds where the port's number is this."""
    file = MappingFile.model_validate({"outputs": {"y": entry}, "bases": bases})
    (element,) = map_outputs([port("y", unit)], file, NOMINAL).elements
    return (number - element.offset) / element.gain


@pytest.mark.parametrize(
    ("entry", "unit", "number", "found"),
    [
        ({"record": "p_ref_w", "unit": "MW"}, "MW", 0.5, 5e5),
        ({"record": "p_ref_w", "unit": "MW"}, "", 0.5, 5e5),
        ({"record": "p_ref_w", "unit": "MW", "sign": -1}, "MW", 0.5, -5e5),
        ({"record": "p_ref_kw", "unit": "MW"}, "MW", 0.5, 500),
        ({"record": "q_ref_var", "unit": "kvar"}, "pu", 20, 2e4),
        ({"record": "w_rad_s", "unit": "Hz"}, "", 50, 100 * 3.141592653589793),
        ({"record": "f_hz", "unit": "rad/s"}, "", 100 * 3.141592653589793, 50),
        ({"record": "angle_deg", "unit": "rad"}, "", 3.141592653589793, 180),
        ({"record": "p_ref_w", "unit": "pu"}, "", 0.5, S / 2),
        ({"record": "p_ref_kw", "unit": "pu"}, "", 0.5, S / 2000),
        ({"record": "p_ref_w", "base": 2e5}, "pu", 0.5, 1e5),
        ({"record": "p_ref_kw", "base": 200}, "pu", 0.5, 100),
        ({"record": "u_dc_v", "unit": "pu", "base": 800}, "", 0.5, 400),
        ({"record": "v_fault_pu", "unit": "pu"}, "pu", 0.9, 0.9),
        ({"record": "anything", "unit": "MW"}, "MW", 0.5, 0.5),
        ({"record": "anything", "base": 3}, "pu", 0.5, 1.5),
        ({"record": "p_ref_w"}, "MW", 0.5, 0.5),
        ({"record": "p_ref_w"}, "pu", 0.5, 0.5),
    ],
)
def test_what_a_channel_holds(entry, unit, number, found):
    """The number in the unit of the channel's name, where the file says that of the port; else as the port gives it."""
    assert recorded(entry, number, unit) == pytest.approx(found, rel=1e-12)


def test_bases_of_the_file_count():
    """1 pu of power is what the file says."""
    assert recorded({"record": "p_ref_w", "unit": "pu"}, 0.5, power_va=1e6) == pytest.approx(5e5)


@pytest.mark.parametrize(
    ("entry", "unit", "words"),
    [
        ({"record": "p_ref_var", "unit": "MW"}, "", "p_ref_var is in var: the unit 'MW' does not fit a reactive power"),
        ({"record": "p_ref_w", "unit": "horses"}, "", "'horses' does not fit an active power; allowed: W, kW, MW, pu"),
        ({"record": "u_v", "unit": "pu"}, "", "u_v may be a voltage or a DC voltage; write base = what 1 pu is in V"),
        ({"record": "p_ref_w", "base": 1e6}, "MW", "a base is for ports in pu, not in MW"),
        ({"record": "v_pu", "unit": "kV"}, "", "the channel v_pu is in pu; the unit 'kV' does not fit it"),
    ],
)
def test_what_cannot_be_converted_is_refused(entry, unit, words):
    """The message says the channel's unit, and what is allowed."""
    with pytest.raises(DoorError, match=words.replace("(", r"\(")):
        recorded(entry, 1.0, unit)


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        *(("p_ref_w", "W"), ("q_mvar", "Mvar"), ("s_va", "VA"), ("w_rad_s", "rad/s"), ("g_w_m2", "W/m2"), ("t_s", "s")),
        *(("v_pu", "pu"), ("mode", ""), ("w", ""), ("temperature_c", "")),
    ],
)
def test_unit_that_a_name_ends_in(name, unit):
    """The longest that stands there; of a name alone, none."""
    assert unit_of_channel(name) == unit
