"""An output that speaks of a switch under a name that is not known is not recorded in silence."""

import pytest

from ports import port
from pvlvrt_compliance.controllers.mapping.file import MappingFile
from pvlvrt_compliance.controllers.mapping.sides import map_outputs
from pvlvrt_compliance.controllers.mapping.telling import told_of
from pvlvrt_compliance.units import Nominal

PHASES = [port("m_a"), port("m_b"), port("m_c")]


def mapped(*ports, **outputs):
    """Outputs beside modulating signals, tied by name or by the entries given."""
    return map_outputs([*PHASES, *ports], MappingFile.model_validate({"outputs": outputs}), Nominal())


@pytest.mark.parametrize(
    ("name", "unit", "description", "switch"),
    [
        *((name, "", "", "trip") for name in ("CB_open_cmd", "Trip_out", "OVtrip", "open_breaker", "protection.Trip1")),
        *((name, "", "", "trip") for name in ("CB_close", "shutdown", "TripLatched")),
        *((name, "", "", "block") for name in ("Block_cmd", "BLK_IGBT", "pulses_off")),
        ("auto_restart", "", "", "restart"),
        ("K1", "", "Opens the main breaker", "trip"),
        ("K1", "", "Trip command, latched until reset", "trip"),
        ("Q7", "", "Blocks all gate pulses", "block"),
    ],
)
def test_what_may_be_a_switch_is_tied_to_nothing_and_every_run_says_so(name, unit, description, switch):
    """Neither is it recorded, which would hide that a protection does nothing."""
    found = mapped(port(name, unit, description=description))
    assert found.ports[-1].mapped_to is None
    assert found.recorded == ()
    (said,) = told_of((), found.ports)
    assert said.startswith(f"output {name}: a switch, or what is only told? It could be {switch}; ")


@pytest.mark.parametrize(
    ("name", "unit", "description"),
    [
        *((name, "", "") for name in ("trip_reason", "TripTime", "trip_count", "block_state", "triplen", "strip")),
        ("uv_trip", "pu", "Voltage below which it trips"),
        ("trips", "", "Number of trips"),
        ("n", "", "Trip counter"),
        ("breaker_closed", "", ""),
        ("p_out", "MW", "Power into the open grid"),
    ],
)
def test_what_is_known_of_a_switch_is_recorded(name, unit, description):
    """A time, a count, a reason, a state, and whatever has a unit."""
    assert mapped(port(name, unit, description=description)).recorded == (name,)


@pytest.mark.parametrize("beside", [(port("trip"), {}), (port("CB_open_cmd"), {"CB_open_cmd": "trip"})])
def test_beside_the_switch_itself_its_parts_are_recorded(beside):
    """Where one output trips, by its name or by the file, the others only tell of it."""
    other, entries = beside
    found = mapped(other, port("OV_trip_active"), **entries)
    assert found.ports[-2].mapped_to == "trip"
    assert found.recorded == ("OV_trip_active",)


def test_a_file_may_say_that_it_is_only_recorded():
    """Then nothing is asked."""
    found = mapped(port("CB_open_cmd"), CB_open_cmd={"record": "cb_open_cmd"})
    assert found.recorded == ("cb_open_cmd",)
    assert list(told_of((), found.ports)) == []


def test_long_names_and_descriptions_cost_nothing():
    """They are looked at as far as others are; what is beyond says nothing."""
    found = mapped(port("cb" * 100_000), port("k1", description=f"{'x ' * 250_000}opens the breaker"))
    assert [output.note for output in found.ports[-2:]] == ["", ""]
