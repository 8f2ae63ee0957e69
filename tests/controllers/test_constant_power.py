"""Tests at partial power are judged of a controller of the user's own that feeds what it is asked for."""

from pathlib import Path

import pytest

from pvlvrt_compliance import Status, check

FILE = Path(__file__).parent / "constant_power.py"
NTS = "es-nts-631-lt110kv"
RATED_KW = 500.0

BANDS = {"max": (0.9, 1.0), "med": (0.15, 0.50), "min": (0.0, 0.15)}
"""Power before the fault (of the rated one) in Tables 48 to 50 of NTS 631 v2.0, by how the id of a row ends."""

pytestmark = pytest.mark.slow


def found_of(controller, rows, **settings):
    """Results of the first run of rows, by their names."""
    own = {f"controller.{name}": value for name, value in settings.items()}
    results = check(NTS, controller=f"{FILE}:{controller}", tests=[f"{row}-1" for row in rows], settings=own)
    return {test.id.removesuffix("-1"): test for test in results.tests}


def statuses(test):
    """Statuses of the checks by their names."""
    return {verdict.check: verdict.status for verdict in test.checks}


@pytest.mark.parametrize("kind", ["U75TP", "U40BP"])
def test_every_power_of_the_code_is_judged(kind):
    """Measured before the fault the power lies in the code's band, and no check says that the test was another."""
    rows = [f"{kind}{end}" for end in BANDS if (kind, end) != ("U40BP", "min")]  # which the code has not
    found = found_of("ConstantPower", rows)
    assert sorted(found) == sorted(rows)
    for row, test in found.items():
        low, high = BANDS[row[-3:]]
        assert low * RATED_KW < test.measurements.before.active_power_kw < high * RATED_KW, row
        assert Status.NOT_EVALUATED not in statuses(test).values(), row
        assert statuses(test)["ride_through"] == Status.PASS
        assert statuses(test)["active_power_recovery"] == Status.PASS
        assert statuses(test)["reactive_current"] == Status.FAIL  # of which it gives none


def test_one_that_goes_by_its_rating_alone_is_not_judged():
    """At 300 W/m2 it drags the array below its best point: the power is not the one that the test means."""
    (test,) = found_of("ConstantPower", ["U75TPmed"], asked_w=500e3).values()
    assert test.status == Status.NOT_EVALUATED
    assert "not within 10 % of the" in test.checks[0].message


def test_its_own_protection_is_judged_at_partial_power():
    """A trip 1.0 s into 1.34 s that are to be ridden through is its own, and a failure; one that comes later is not."""
    early, late = (found_of("Hasty", ["U75TPmed"], trip_after_s=after)["U75TPmed"].checks[0] for after in (1.0, 1.4))
    assert (early.check, early.status, late.status) == ("ride_through", Status.FAIL, Status.PASS)
    assert "by the controller" in early.message
