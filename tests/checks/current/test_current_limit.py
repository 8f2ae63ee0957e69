"""Current limit, just inside and just outside of each part."""

import numpy as np
import pytest
from demands import CONTROL_STEP_S

from pvlvrt_compliance.results import Status


@pytest.mark.parametrize(("q_kvar", "status"), [(254.9, Status.PASS), (255.1, Status.FAIL)])
def test_fundamental_current_during_the_sag(bench, q_kvar, status):
    """At half voltage 255 kvar are 1.02 pu of current."""
    check = bench(q_sag_kvar=q_kvar, p_sag_kw=0.0).check("current_limit")
    assert check.status is status
    assert check.measured == pytest.approx(q_kvar / 250, abs=1e-5)
    assert check.margin == pytest.approx(1.02 - check.measured)
    assert (check.limit, check.unit) == (1.02, "pu")
    assert 0.36 <= check.at_s <= 0.6


@pytest.mark.parametrize(("p_kw", "status"), [(509.9, Status.PASS), (510.1, Status.FAIL)])
def test_fundamental_current_after_clearing(bench, p_kw, status):
    """At full voltage 510 kW are 1.02 pu of current."""
    check = bench(q_sag_kvar=240, p_after_kw=p_kw).check("current_limit")
    assert check.status is status
    assert check.at_s >= 0.66


@pytest.mark.parametrize(("until_s", "status"), [(0.039, Status.PASS), (0.045, Status.FAIL)])
@pytest.mark.parametrize("from_s", [0.3, 0.6])
def test_current_may_settle_for_60_ms(bench, until_s, status, from_s):
    """Too much current is allowed while the one-cycle window still reaches into the first 40 ms."""

    def surge(t: np.ndarray) -> np.ndarray:
        angle = 2 * np.pi * 50 * (t - 0.3)
        shifts = np.array([0, -2 * np.pi / 3, 2 * np.pi / 3])[:, np.newaxis]
        size = 0.15 * ((t >= from_s) & (t < from_s + until_s))
        # Behind the voltage during the sag, where the bench feeds Q; in phase with it after clearing.
        return size * np.cos(angle + shifts - (np.pi / 2 if from_s < 0.6 else 0))

    assert bench(q_sag_kvar=250, extra_current_pu=surge).check("current_limit").status is status


def along(t: np.ndarray, size: np.ndarray, behind_rad: float = 0.0) -> np.ndarray:
    """Balanced current of an amplitude (pu) behind the voltage of a bench that starts at 0.3 s, shape (3, n)."""
    shifts = np.array([0, -2 * np.pi / 3, 2 * np.pi / 3])[:, np.newaxis]
    return size * np.cos(2 * np.pi * 50 * (t - 0.3) + shifts - behind_rad)


@pytest.mark.parametrize(("size_pu", "status"), [(0.199, Status.PASS), (0.201, Status.FAIL)])
@pytest.mark.parametrize(("from_s", "behind_rad"), [(0.3, np.pi / 2), (0.6, 0.0)])
def test_current_on_its_way(bench, size_pu, status, from_s, behind_rad):
    """Before it is settled the current stays below 1.20 pu all the same, from a cycle and a quarter after each step."""
    surge = lambda t: along(t, size_pu * ((t >= from_s) & (t < from_s + 0.039)), behind_rad)  # noqa: E731
    check = bench(q_sag_kvar=250, extra_current_pu=surge).check("current_limit")
    assert check.status is status
    if status is Status.FAIL:
        assert (check.limit, check.bound, check.uncertainty) == (1.2, "at_most", 0.005)
        assert from_s + 0.025 <= check.at_s <= from_s + 0.039
        assert "unsettled" in check.message


def test_before_a_trip_the_peak_counts(bench):
    """A current of 2.5 pu that trips the inverter after 13 ms has broken its limit, in a part of a cycle."""
    surge = lambda t: along(t, 2.5 * ((t >= 0.3) & (t < 0.313)), np.pi / 2)  # noqa: E731
    check = bench(disconnected_after_s=0.013, extra_current_pu=surge).check("current_limit")
    assert check.status is Status.FAIL
    assert (check.limit, check.unit) == (2.0, "pu")
    assert 0.3 <= check.at_s <= 0.313


def test_nothing_counts_after_a_trip(bench):
    """What a record shows after the breaker opened is not the inverter's."""
    surge = lambda t: along(t, 2.5 * (t > 0.401))  # noqa: E731
    assert bench(disconnected_after_s=0.1, extra_current_pu=surge).check("current_limit").status is Status.PASS


def test_every_stage_is_drawn(bench):
    """A figure has the peak over the record, and after each step both limits of the fundamental where they count."""
    drawn = [band for band in bench(q_sag_kvar=250).result().bands if band.check == "current_limit"]
    own = [(band.name, band.t_s, band.upper[0]) for band in drawn]
    assert [(name, pu) for name, _, pu in own] == [
        ("limit, peak", 2.0), *2 * [("limit, fundamental, settling", 1.2), ("limit, fundamental", 1.02)]
    ]  # fmt: skip
    spans = [span for _, span, _ in own[1:]]
    expected = [(0.325, 0.36), (0.36, 0.6), (0.625, 0.66), (0.66, 1.7)]
    assert np.allclose(spans, expected, atol=1e-3)


@pytest.mark.parametrize(("peak_pu", "status"), [(1.999, Status.PASS), (2.0, Status.FAIL), (2.001, Status.FAIL)])
@pytest.mark.parametrize(("phase", "at_s"), [(0, 0.1), (1, 0.3001), (2, 0.62)])
def test_instantaneous_peak(bench, peak_pu, status, phase, at_s):
    """One sample of 2 pu fails, in any phase, before, during or after the sag; of either sign."""
    made = bench(q_sag_kvar=250, dt_s=CONTROL_STEP_S)
    plain = made.waveforms()
    sample = plain.segments[0].index_at(at_s)
    there = plain.segments[0].three_phase("i")[phase][sample] / made.nominal.phase_current_peak_a

    def spike(t: np.ndarray) -> np.ndarray:
        extra = np.zeros((3, len(t)))
        extra[phase, sample] = -(peak_pu + 1e-9) - there
        return extra

    made.extra_current_pu = spike
    check = made.check("current_limit")
    assert check.status is status
    if status is Status.FAIL:
        assert check.measured == pytest.approx(peak_pu)
        assert check.at_s == pytest.approx(at_s, abs=5e-5)
        assert f"phase {'abc'[phase]}" in check.message
