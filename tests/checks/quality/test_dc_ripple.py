"""Ripple of the DC voltage, just inside and just outside of its limit."""

import pytest

from pvlvrt_compliance.results import Status


@pytest.mark.parametrize(("percent", "status"), [(0.1495, Status.PASS), (0.1505, Status.FAIL)])
def test_dc_ripple(bench, percent, status):
    """The double-frequency amplitude of v_DC may be 0.15 % of its mean; a drift does not count."""
    check = bench(q_sag_kvar=250, dc_ripple_percent=percent).check("dc_ripple")
    assert check.status is status
    assert check.measured == pytest.approx(percent, abs=3e-4)
    assert check.margin == pytest.approx(0.15 - check.measured)
    assert check.unit == "%"
