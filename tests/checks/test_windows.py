"""What is measured over a window: in too short a sag, and at another nominal frequency."""

import pytest

from pvlvrt_compliance.results import Status
from pvlvrt_compliance.units import Nominal


@pytest.mark.parametrize("kind", ["reactive_support", "dc_ripple"])
def test_sag_too_short_for_a_window(bench, kind):
    """A sag that leaves less than a cycle to measure lets off what is measured over a window."""
    result = bench(duration_s=0.11, q_sag_kvar=0.0, p_sag_kw=10).result()
    check = next(check for check in result.checks if check.check == kind)
    assert check.status is Status.NOT_APPLICABLE
    assert "no whole cycle" in check.message
    assert next(c for c in result.checks if c.check == "ride_through").status is Status.PASS


def test_at_60_hz(bench):
    """The same limits hold at 60 Hz, measured over cycles of 60 Hz."""
    nominal = Nominal(frequency_hz=60)
    made = bench(scenario={"frequency_hz": 60}, nominal=nominal, q_sag_kvar=250, dc_ripple_percent=0.14)
    result = made.result()
    assert result.status is Status.PASS
    assert result.measurements.during.frequency_hz == pytest.approx(60, abs=1e-3)
