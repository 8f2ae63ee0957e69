"""Reactive power during a sag, just inside and just outside of what is demanded."""

import pytest

from pvlvrt_compliance.checks.current.reactive_support import demanded_pu
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.sag import Sag

TWO_PHASE_TO_20 = Sag(depth=0.8, phases="bc", two_phase=True)
PHASE_C_90 = Sag(depth=0.9, phases="c")


@pytest.mark.parametrize(
    ("asked", "demand"),
    [
        (Sag(depth=0.5), (250, 0.5)),  # clipped: eq (9) asks for 375
        (Sag(depth=0.8), (100, 0.2)),  # clipped
        (Sag(depth=0.4), (500 * 15 / 7 * 0.25, 0.6)),  # eq (9), below the 300 of the clip
        (PHASE_C_90, (500 * 15 / 7 * 0.15, 0.7)),
        (TWO_PHASE_TO_20, (100, 0.6)),  # clipped by V-: eq (9) asks for 268
        (Sag(depth=0.151), (500 * 15 / 7 * 0.001, 0.849)),
    ],
)
@pytest.mark.parametrize(("beyond_kvar", "status"), [(0.05, Status.PASS), (-0.05, Status.FAIL)])
def test_reactive_support(bench, asked, demand, beyond_kvar, status):
    """Mean Q must reach the smaller of eq (9) and (V+ - V-) S, less 0.025 V+ S."""
    demand_kvar, v_positive = demand
    tolerance = 0.025 * v_positive * 500
    check = bench(asked=asked, q_sag_kvar=demand_kvar - tolerance + beyond_kvar).check("reactive_support")
    assert check.status is status
    assert check.limit == pytest.approx(demand_kvar, abs=1e-2)
    assert check.margin == pytest.approx(beyond_kvar, abs=2e-2)
    assert check.unit == "kvar"
    assert f"demanded at V+ = {v_positive:.3f} pu; the tolerance is" in check.message


def test_more_support_is_no_failure(bench):
    """More reactive power than demanded passes."""
    assert bench(asked=PHASE_C_90, q_sag_kvar=233).check("reactive_support").status is Status.PASS


@pytest.mark.parametrize(("q_kvar", "status"), [(11.2, Status.PASS), (11.3, Status.FAIL)])
@pytest.mark.parametrize("sign", [-1, 1])
def test_no_support_above_the_threshold(bench, q_kvar, status, sign):
    """At 0.90 pu no reactive power is wanted: |Q| may be 0.025 V+ S = 11.25 kvar, of either sign."""
    check = bench(depth=0.1, p_sag_kw=400, q_sag_kvar=sign * q_kvar).check("reactive_support")
    assert check.status is status
    assert check.limit == pytest.approx(11.25, abs=1e-6)
    assert check.margin == pytest.approx(11.25 - q_kvar, abs=1e-3)


def test_support_without_any_voltage(bench):
    """Where the grid has no voltage nothing is demanded; where the inverter left none, doing nothing is no pass."""
    settings = {"depth": 1, "duration_s": 0.2}
    assert bench(**settings).check("reactive_support").status is Status.NOT_APPLICABLE
    destroyed = bench(duration_s=0.2, sag=Sag(depth=1), no_load_sag=Sag(depth=0.5)).check("reactive_support")
    assert destroyed.status is Status.FAIL
    assert (destroyed.limit, destroyed.bound, destroyed.unit) == (0.01, "at_least", "pu")
    assert "destroyed the voltage" in destroyed.message


def test_demand_meets_capability_where_physics_says(iec):
    """In balanced sags eq (9) asks for all there is at V+ = 12.75/22 and below."""
    demand = iec.requirements.reactive_support
    meeting_pu = 12.75 / 22
    assert demanded_pu(demand, meeting_pu, 0) == pytest.approx(meeting_pu)
    assert demanded_pu(demand, meeting_pu + 0.01, 0) < meeting_pu + 0.01
    assert demanded_pu(demand, meeting_pu - 0.01, 0) == pytest.approx(meeting_pu - 0.01)


@pytest.mark.parametrize(
    "settings", [{"depth": 0.5, "q_sag_kvar": 250}, {"depth": 0.1, "p_sag_kw": 400, "q_sag_kvar": 5}]
)
def test_the_band_is_drawn_where_the_verdict_fails(bench, settings):
    """What a figure draws is as far from the measured Q as the margin says, with support and without."""
    result = bench(**settings).result()
    check = next(check for check in result.checks if check.check == "reactive_support")
    *plain, band = (band for band in result.bands if band.check == "reactive_support")
    assert [other.lower[0] for other in plain] == ([check.limit] if check.bound == "at_least" else [])
    edges = [check.measured - band.lower[0]] + ([band.upper[0] - check.measured] if band.upper else [])
    assert min(edges) == pytest.approx(check.margin, abs=1e-6)
