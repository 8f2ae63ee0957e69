"""What a check limits is drawn, where it has a level over time, and at the level that the verdict goes by."""

import numpy as np
import pytest

from pvlvrt_compliance.checks.registry import find_check
from pvlvrt_compliance.evidence.frequency import frequency_hz
from pvlvrt_compliance.evidence.voltages import voltage_quantity_pu
from pvlvrt_compliance.profile import known_profiles, load_profile
from pvlvrt_compliance.results import JUDGED, Status
from pvlvrt_compliance.results.band import voltage_in
from sampled import SAMPLE, sampled

UNDRAWN = {
    "harmonics": "a spectrum of ten cycles has no level over time, but one by order",
    "dc_injection": "a mean of ten cycles, too small to be seen beside the current",
    "toggling": "how often a current comes on is a number, and no level",
    "repeated_runs": "a row of tests has no record",
}
"""Checks that limit nothing that could be drawn over time, with the reason."""

AT_EVERY_INSTANT = {"active_power_support", "overfrequency_power", "reactive_ratio", "active_power_recovery"}
"""Checks whose limits hold at every instant that they are drawn at, of the series that is drawn."""

SERIES = {
    "active_power_kw": lambda evidence: evidence.active_power_kw,
    "reactive_power_kvar": lambda evidence: evidence.reactive_power_kvar,
    "dc_voltage_v": lambda evidence: evidence.dc_voltage_v,
    "current_pu": lambda evidence: np.abs(evidence.current_pu).max(axis=0),
    "reactive_current_pu": lambda evidence: evidence.reactive_current_pu,
    "reactive_current_negative_pu": lambda evidence: evidence.reactive_current_negative_pu,
    "reactive_share": lambda evidence: evidence.reactive_share,
    "frequency_hz": frequency_hz,
}

pytestmark = pytest.mark.slow


def series_of(evidence, quantity):
    """The series that a band is of."""
    if quantity in SERIES:
        return SERIES[quantity](evidence)
    return voltage_quantity_pu(evidence, voltage_in(quantity), "no_load")


def beyond(evidence, band):
    """How far a series goes beyond a band (below zero: stays within it), and how large the band's numbers are."""
    inside = (evidence.t_s >= band.t_s[0] - 1e-9) & (evidence.t_s <= band.t_s[-1] + 1e-9)
    t_s, x = evidence.t_s[inside], series_of(evidence, band.quantity)[inside]
    below = [] if band.lower is None else [np.interp(t_s, band.t_s, band.lower) - x]
    above = [] if band.upper is None else [x - np.interp(t_s, band.t_s, band.upper)]
    return max(float(part.max()) for part in (*below, *above)), np.abs(band.lower or band.upper).max()


def widest(bands):
    """Of a limit and the same with its tolerance the latter."""
    loose = {(band.quantity, band.name, band.t_s[0]) for band in bands if band.widened}
    return [band for band in bands if band.widened or (band.quantity, band.name, band.t_s[0]) not in loose]


@pytest.mark.parametrize("name", SAMPLE)
def test_every_check_that_judged_is_drawn(name):
    """Each verdict that passed or failed has a band of a quantity that figures know, or a reason not to."""
    judged = sampled(name)
    drawn = {band.check for band in judged.result.bands}
    for check in judged.result.checks:
        if check.status in JUDGED:
            assert (check.check in drawn) != (check.check in UNDRAWN), check.check
    assert not drawn & set(UNDRAWN)
    judged_kinds = {check.check for check in judged.result.checks if check.status in JUDGED}
    assert ("harmonics" in judged_kinds) == any(judged.result.spectra)
    assert ("overfrequency_power" in judged_kinds) == any(judged.result.characteristics)
    assert ("support_dynamics" in judged_kinds) == any(judged.result.instants)
    for band in judged.result.bands:
        assert np.isfinite(series_of(judged.evidence, band.quantity)).any()
        assert list(band.t_s) == sorted(band.t_s)
        assert judged.evidence.waveforms.t0_s <= band.t_s[0]
        assert band.t_s[-1] <= judged.evidence.record_end_s + 1e-9


def test_the_sample_has_every_check_of_the_shipped_profiles():
    """What a shipped profile demands is judged in the sample, and so is what is not drawn, but for rows."""
    shipped = [name for name, known in known_profiles().items() if known.origin == "shipped"]
    kinds = {kind for name in shipped for kind, _ in load_profile(name).requirements.by_kind()}
    results = [sampled(name).result for name in SAMPLE]
    judged = {check.check for result in results for check in result.checks if check.status in JUDGED}
    assert kinds - judged == {"repeated_runs"}
    assert all(find_check(kind) is not None for kind in UNDRAWN)


@pytest.mark.parametrize("name", SAMPLE)
def test_bands_say_what_verdicts_say(name):
    """Where a limit holds at every instant, the series is within all its bands if and only if the check passed."""
    judged = sampled(name)
    for check in judged.result.checks:
        bands = widest([band for band in judged.result.bands if band.check == check.check])
        if check.check in AT_EVERY_INSTANT and check.status in JUDGED:
            worst = max(excess - 2e-3 * size for excess, size in (beyond(judged.evidence, band) for band in bands))
            assert (worst <= 0) == (check.status is Status.PASS), (check.check, worst)


@pytest.mark.parametrize("name", SAMPLE)
def test_means_lie_within_the_bands_of_what_passed(name):
    """The mean of what is limited in a window is within the band that is drawn there."""
    judged = sampled(name)
    kinds = {"reactive_support", "reactive_current", "negative_sequence_current", "return_to_prefault", "oscillation"}
    passed = {check.check for check in judged.result.checks if check.status is Status.PASS}
    for band in widest([band for band in judged.result.bands if band.check in kinds & passed]):
        evidence = judged.evidence
        inside = evidence.between(band.t_s[0], band.t_s[-1])
        mean = np.average(series_of(evidence, band.quantity)[inside], weights=evidence.step_s[inside])
        assert band.lower is None or mean >= band.lower[0] - 1e-9, band.name
        assert band.upper is None or mean <= band.upper[0] + 1e-9, band.name


def test_a_two_phase_sag_has_its_own_envelope():
    """An isolated two-phase fault is drawn with the envelope that judges it, which lies elsewhere than the other."""
    levels = []
    for name in ("es-po-12.3:PVVC-2-1", "es-po-12.3:PVVC-4-1"):
        bands = [band for band in sampled(name).result.bands if band.name == "ride-through envelope"]
        start_s = sampled(name).evidence.disturbance.start_s
        levels.append([(t - start_s, u) for t, u in zip(bands[0].t_s, bands[0].lower, strict=True)][:3])
    demand = load_profile("es-po-12.3").ride_through
    both = (demand.envelope, demand.envelope_two_phase)
    assert levels[0] != levels[1]
    for drawn, envelope in zip(levels, both, strict=True):
        np.testing.assert_allclose(drawn, envelope.points[:3], atol=1e-6)


def test_regions_end_with_their_time():
    """The region 0.45 to 0.65 pu of category II, which 0.46 pu lies in, lasts 0.32 s; those above, longer."""
    judged = sampled("ieee1547-cat-ii:0.460pu-0.32s")
    start_s = judged.evidence.disturbance.start_s
    lasts = {
        (band.region, band.lower[0], band.upper[0]): band.t_s[-1] - start_s
        for band in judged.result.bands
        if band.region
    }
    rest_s = judged.evidence.waveforms.end_s - start_s
    assert lasts == {
        ("continuous", 0.88, 1.1): pytest.approx(rest_s),
        ("mandatory", 0.65, 0.88): pytest.approx(rest_s),
        ("permissive", 0.45, 0.65): pytest.approx(0.32, abs=1e-4),
    }


def test_times_that_add_up_are_cut_by_what_was_spent():
    """The second of two sags of PRC-029 has what the first has left of the time of its region."""
    judged = sampled("nerc-prc-029:cumulative-0.255pu")
    regions = load_profile("nerc-prc-029").ride_through.regions
    region = next(row for row in regions.rows if row.voltage_pu[0] <= 0.255 < row.voltage_pu[1])
    first, second = (b for b in judged.result.bands if b.region and (b.lower[0], b.upper[0]) == region.voltage_pu)
    begin_s, end_s, *_ = judged.evidence.disturbance.voltage_steps_s
    assert first.t_s[-1] - first.t_s[0] == pytest.approx(region.ride_s, abs=1e-3)
    assert second.t_s[-1] - second.t_s[0] == pytest.approx(region.ride_s - (end_s - begin_s), abs=1e-3)
