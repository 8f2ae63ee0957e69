import pytest

from validation.simulator import distorted_grid, findings
from validation.simulator.distorted_grid import (
    ANTIPHASE,
    GRIDS,
    IN_PHASE,
    NAMES,
    measured,
    on_distorted_grid,
    share_of_ripple,
)
from validation.simulator.sequence_filters import frequency_ripple_hz, passed

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("scr", GRIDS)
@pytest.mark.parametrize("file", [ANTIPHASE, IN_PHASE])
def test_in_closed_loop_too_the_frequency_of_the_msogi_fll_does_not_ripple(scr, file):
    """On a grid with 5th and 7th harmonic it ripples less than a tenth of the DSOGI-FLL's, behind an impedance too."""
    assert share_of_ripple(scr, file) < 0.1
    assert measured(on_distorted_grid("msogi-fll", scr, file)).frequency_hz < 1e-4


def test_ripples_are_those_of_the_transfer_functions(assert_within):
    """Frequency, V_fault and current of every synchronisation are what its filters and its loop predict."""
    assert_within(distorted_grid.rows())


def test_only_the_msogi_fll_leaves_the_current_undistorted():
    """Of all synchronisations its current alone has a THD below 0.3 %."""
    clean = [name for name in NAMES if measured(on_distorted_grid(name, None)).thd_percent < 0.3]
    assert clean == ["msogi-fll"]


def test_the_notch_flags_faults_that_are_none():
    """With the SRF-PLL harmonics in phase are faults to the detector, and the tool refuses to judge the run."""
    finding = on_distorted_grid("srf-pll", None, IN_PHASE)
    assert distorted_grid.flagged_percent(finding) > 10
    assert {check["status"] for check in findings.checks_of(finding).values()} == {"not_evaluated"}


def test_the_command_measures_the_distortion_of_the_page():
    """The report of the command has the THD of the page."""
    finding = on_distorted_grid("dsogi-fll", distorted_grid.WEAK_SCR)
    report = findings.report_of(finding)
    assert report["status"] == finding.current_limit
    shown = report["measurements"]["during"]["current_thd_percent"]
    assert shown == pytest.approx(measured(finding).thd_percent, rel=0.01)


def test_a_wrong_transfer_function_is_not_within():
    """Predicting one synchronisation's ripple by another's filters misses it."""
    harmonics = distorted_grid.harmonics_of(findings.settled(on_distorted_grid("dsogi-fll", None)))[1]
    found = measured(on_distorted_grid("dsogi-fll", None)).frequency_hz
    assert frequency_ripple_hz("ddsrf-pll", harmonics, 314.16) != pytest.approx(found, rel=0.05)
    assert abs(passed("dsc-pll", 7).positive) < 1e-12
    assert abs(passed("msogi-fll", 7).positive) == 0
