"""A user's own protection is what is judged: how early it trips, and where it lets the current pause."""

from pathlib import Path

import pytest

from pvlvrt_compliance import Status, check

CONTROLLER = str(Path(__file__).parent / "protected.py:Protected")
FAST = {"simulation.synchronising_s": 0, "simulation.settling_s": 0.5}  # it begins in the steady state

pytestmark = pytest.mark.slow


def ride_through(profile, sag, duration, settings=None, **given):
    """Status and message of riding through, with this protection."""
    own = {f"controller.{name}": value for name, value in given.items()}
    found = check(
        profile,
        controller=CONTROLLER,
        sag=sag,
        duration=duration,
        settings=FAST | own | (settings or {}),
        checks="ride_through",
    )
    (verdict,) = found.tests[0].checks
    return verdict.status, verdict.message


def test_a_protection_that_trips_40_ms_too_early_fails_with_the_controller_named():
    """It trips 0.46 s after the start of a sag of 0.5 s, which the envelope demands to be ridden through."""
    status, said = ride_through("iec61400-21", "50%", "0.5s", trip_after_s=0.46)
    assert status == Status.FAIL
    assert "by the controller" in said
    assert "demands 0.500 s" in said


def test_one_that_waits_passes():
    """The same with its time beyond the sag's."""
    assert ride_through("iec61400-21", "50%", "0.5s", trip_after_s=0.54)[0] == Status.PASS


def test_one_that_trips_after_what_is_demanded_passes():
    """Of a sag of 1.2 s at 0.5 pu the envelope demands 0.944 s."""
    status, said = ride_through("iec61400-21", "50%", "1.2s", trip_after_s=1.0)
    assert status == Status.PASS
    assert "by the controller" in said


@pytest.mark.parametrize(
    ("profile", "sag", "block_below_pu", "status"),
    [
        ("ieee1547-cat-iii", "70%", 0.5, Status.PASS),  # momentary cessation below 0.50 pu
        ("ieee1547-cat-iii", "40%", 0.7, Status.FAIL),  # mandatory operation above
        ("iec61400-21", "70%", 0.5, Status.FAIL),  # no code of support lets the current pause
    ],
)
def test_cessation_by_a_block_is_judged_by_the_region(profile, sag, block_below_pu, status):
    """A blocked bridge feeds nothing: right where the code has it cease, wrong where it must operate."""
    assert ride_through(profile, sag, "0.5s", block_below_pu=block_below_pu)[0] == status


@pytest.mark.parametrize(
    ("settings", "tripped"),
    [
        ({}, False),
        ({"protection.undervoltage_delay_s": 0.05}, True),
        ({"protection.undervoltage_relay": True}, True),
        ({"protection.undervoltage_delay_s": 0.05, "protection.undervoltage_relay": False}, False),
    ],
)
def test_the_plants_relay_does_not_decide_unless_it_is_spoken_of(settings, tripped):
    """A sag of 2 s at 0.5 pu, beyond the relay's curve: beside a user's controller it trips only where it is set."""
    _, said = ride_through("iec61400-21", "50%", "2s", settings)
    assert ("under-voltage relay of the plant" in said) is tripped


def test_with_the_bundled_controller_it_does():
    """The paper's flowchart disconnects at the end of the envelope."""
    found = check("iec61400-21", sag="50%", duration="2s", checks="ride_through")
    assert "under-voltage relay of the plant" in found.tests[0].checks[0].message
