"""P and Q at the end of the record, on both sides of their limits."""

import pytest

from pvlvrt_compliance.results import Status

RETURN = {"clause": "5.11", "source": "a test", "active_fraction": 0.05, "reactive_fraction": 0.02}


@pytest.mark.parametrize(
    ("p_kw", "q_kvar", "status"),
    [
        (500 - 24, 0, Status.PASS),
        (500 - 26, 0, Status.FAIL),
        (500 + 26, 0, Status.FAIL),
        (500, 9.9, Status.PASS),
        (500, -10.1, Status.FAIL),
        (500 - 26, -9, Status.FAIL),
    ],
)
def test_return_to_prefault(bench, profile_with, p_kw, q_kvar, status):
    """P and Q must come back within their fractions of rated power; the one with the least margin is told."""
    made = bench(
        profile=profile_with("return_to_prefault", RETURN), p_after_kw=p_kw, q_kvar=lambda t: q_kvar * (t > 0.6)
    )
    check = made.check("return_to_prefault")
    assert check.status is status, check.message
    assert check.message.startswith("Q" if abs(q_kvar) > 5 and abs(p_kw - 500) < 20 else "P")


@pytest.mark.parametrize(
    "event",
    [
        {"kind": "irradiance", "t_s": 0.1, "to_w_m2": 800},
        {"kind": "voltage_profile", "points": [(0.0, 1.0), (0.5, 0.85)]},
        {"kind": "frequency_step", "t_s": 0.5, "to_hz": 50.5},
    ],
)
def test_tests_that_end_elsewhere(bench, profile_with, event):
    """Where the test itself does not come back, the inverter need not."""
    made = bench(
        depth=0, profile=profile_with("return_to_prefault", RETURN), scenario={"events": [event]}, p_sag_kw=500
    )
    assert made.check("return_to_prefault").status is Status.NOT_APPLICABLE


def test_record_without_an_end(bench, profile_with):
    """A record too short for the window after the sag is not evaluated."""
    made = bench(profile=profile_with("return_to_prefault", RETURN), scenario={"after_s": 0.5})
    assert made.check("return_to_prefault").status is Status.NOT_EVALUATED
