import pytest

from validation.simulator import findings

FINDINGS = {
    "blind spot": findings.BLIND_SPOT,
    "small sag": findings.SMALL_SAG,
    "toggling": findings.TOGGLING,
    "excursion": findings.EXCURSION,
}


@pytest.mark.parametrize("name", FINDINGS)
def test_the_tool_reports_the_finding(name):
    """The command of the page gives the verdict that the page says, for the same current."""
    finding = FINDINGS[name]
    check = findings.checks_of(finding)["current_limit"]
    assert check["status"] == finding.current_limit
    if name != "toggling":  # there the current goes to and fro within the one-cycle window
        assert check["measured"] == pytest.approx(findings.largest_current_pu(finding), rel=0.01)


def test_the_blind_spot_flags_no_fault(assert_within):
    """45 % of one phase at SCR 30 is no fault to the detector, and the current is P / (V+ - V-)."""
    assert findings.mode_changes(findings.BLIND_SPOT) == 0
    assert findings.settled(findings.BLIND_SPOT)["fault_signal"].max() == 0
    assert_within(findings.blind_spot().rows)
    assert_within(findings.small_sag().rows)


def test_a_weak_grid_toggles():
    """At SCR 7 a sag of 15 % changes the mode again and again."""
    assert findings.mode_changes(findings.TOGGLING) >= 10


def test_the_frequency_estimate_leaves_the_grid():
    """At a three-phase 90 % sag it falls to about 42 Hz."""
    assert findings.lowest_frequency_hz(findings.EXCURSION) == pytest.approx(42.2, abs=0.5)
