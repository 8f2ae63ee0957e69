"""Harmonics and direct current in steady operation, at both sides of every limit."""

import numpy as np
import pytest

from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.events import FrequencyStep
from pvlvrt_compliance.units import Nominal

LIMITS = {
    "orders": {
        "confidence": "chosen",
        "source": "the test",
        "rows": [
            {"orders": [2, 10], "which": "even", "limit_percent": 1.0},
            {"orders": [3, 9], "which": "odd", "limit_percent": 4.0},
            {"orders": [11, 50], "limit_percent": 0.3},
        ],
    }
}
BY_A_HUNDREDTH = [(1.01, Status.FAIL), (0.99, Status.PASS)]


def tone(order: float, percent: float, phase: int = 0, frequency_hz: float = 50.0, from_s: float = 0.0):
    """Current at a multiple of the fundamental in one phase, in percent of the rated current."""

    def current(t: np.ndarray) -> np.ndarray:
        extra = np.zeros((3, len(t)))
        extra[phase] = percent / 100 * np.cos(2 * np.pi * order * frequency_hz * t + 0.4) * (t >= from_s)
        return extra

    return current


@pytest.fixture
def distorted(bench, demanding):
    """Make a record whose current has an additional component."""

    def make(extra, limits=LIMITS, **settings):
        settings = {"q_sag_kvar": 100.0} | settings
        return bench(profile=demanding(harmonics=limits), extra_current_pu=extra, **settings)

    return make


@pytest.mark.parametrize(
    ("order", "limit", "phase"), [(2, 1.0, 0), (10, 1.0, 2), (3, 4.0, 1), (9, 4.0, 0), (11, 0.3, 1), (50, 0.3, 2)]
)
@pytest.mark.parametrize(("times", "status"), BY_A_HUNDREDTH)
def test_limit_by_order(distorted, order, limit, phase, times, status):
    """Each order has its limit in percent of the rated current, whatever current flows."""
    made = distorted(tone(order, times * limit, phase), p_before_kw=460.0, p_after_kw=460.0)
    check = made.check("harmonics")
    assert check.status is status
    assert f"harmonic {order} of the current in phase {'abc'[phase]}" in check.message
    assert (check.limit, check.unit) == (limit, "%")
    assert check.measured == pytest.approx(times * limit, rel=1e-3)


@pytest.mark.parametrize(("times", "status"), BY_A_HUNDREDTH)
def test_neighbouring_line_belongs_to_the_harmonic(distorted, times, status):
    """A line 5 Hz beside a harmonic is in its subgroup."""
    assert distorted(tone(5.1, times * 4)).check("harmonics").status is status


def test_interharmonic_between_two_orders_is_in_neither(distorted):
    """A line 25 Hz from the nearest harmonics is in no subgroup."""
    check = distorted(tone(5.5, 20.0)).check("harmonics")
    assert check.status is Status.PASS
    assert check.measured == pytest.approx(0, abs=1e-3)


@pytest.mark.parametrize(("times", "status"), BY_A_HUNDREDTH)
@pytest.mark.parametrize("order", [5, 5.5])
def test_total_rated_current_distortion(distorted, order, times, status):
    """TRD counts harmonics and interharmonics, in percent of the rated current."""
    check = distorted(tone(order, times * 5, phase=1), {"total_percent": 5.0}).check("harmonics")
    assert check.status is status
    assert "total rated-current distortion in phase b" in check.message
    assert check.measured == pytest.approx(times * 5, rel=2e-3)


@pytest.mark.parametrize(("times", "status"), BY_A_HUNDREDTH)
def test_thd(distorted, times, status):
    """THD is in percent of the fundamental that flows, here 0.92 of the rated current."""
    extra = lambda t: tone(5, times * 0.6 * 3 * 0.92)(t) + tone(7, times * 0.8 * 3 * 0.92)(t)  # noqa: E731
    made = distorted(extra, {"thd_percent": 3.0}, p_before_kw=460.0, p_after_kw=460.0)
    check = made.check("harmonics")
    assert check.status is status
    assert check.measured == pytest.approx(times * 3, rel=1e-3)


def test_harmonics_after_the_sag_count(distorted):
    """What appears after the sag is judged at the end of the record."""
    check = distorted(tone(7, 5.0, from_s=1.4)).check("harmonics")
    assert check.status is Status.FAIL
    assert check.at_s == pytest.approx(1.5, abs=1e-3)


def test_harmonics_of_the_sag_do_not_count(distorted):
    """The sag and its clearing are not steady operation."""
    extra = lambda t: tone(7, 20.0)(t) * ((t > 0.29) & (t < 1.4))  # noqa: E731
    assert distorted(extra).check("harmonics").status is Status.PASS


@pytest.mark.parametrize(("times", "status"), BY_A_HUNDREDTH)
@pytest.mark.parametrize("frequency_hz", [59.8, 60.0])
def test_at_60_hz(bench, demanding, frequency_hz, times, status):
    """Twelve cycles of the frequency measured, at and beside 60 Hz."""
    made = bench(
        profile=demanding(harmonics=LIMITS),
        scenario={"frequency_hz": frequency_hz},
        nominal=Nominal(frequency_hz=60),
        q_sag_kvar=100.0,
        extra_current_pu=tone(3, times * 4, frequency_hz=frequency_hz),
    )
    check = made.check("harmonics")
    assert check.status is status
    assert check.measured == pytest.approx(times * 4, rel=1e-3)


def test_frequency_that_a_disturbance_leaves(distorted):
    """At the end of a record harmonics are those of the frequency there, not of the one before the disturbance."""
    events = (FrequencyStep(t_s=0.1, to_hz=50.6),)
    check = distorted(tone(7, 0.0), scenario={"events": events}).check("harmonics")
    assert check.status is Status.PASS
    assert check.measured == pytest.approx(0, abs=1e-3)


def test_nothing_limited(distorted):
    """A requirement without any limit judges nothing."""
    assert distorted(tone(5, 9.0), {}).check("harmonics").status is Status.NOT_APPLICABLE


@pytest.mark.parametrize("sign", [-1, 1])
@pytest.mark.parametrize("phase", [0, 1, 2])
@pytest.mark.parametrize(("times", "status"), BY_A_HUNDREDTH)
def test_dc_injection(bench, demanding, sign, phase, times, status):
    """0.5 % of the rated rms current, of either sign, in any phase."""

    def direct(t: np.ndarray) -> np.ndarray:
        extra = np.zeros((3, len(t)))
        extra[phase] = sign * times * 0.005 / np.sqrt(2)  # peak of the rated current is the unit here
        return extra

    made = bench(profile=demanding(dc_injection={"limit_percent": 0.5}), extra_current_pu=direct, q_sag_kvar=100.0)
    check = made.check("dc_injection")
    assert check.status is status
    assert f"phase {'abc'[phase]}" in check.message
    assert check.measured == pytest.approx(times * 0.5, abs=1e-4)
    assert check.margin == pytest.approx(0.5 * (1 - times), abs=1e-4)


def test_harmonics_are_no_direct_current(bench, demanding):
    """A large harmonic leaves no mean over whole cycles."""
    made = bench(profile=demanding(dc_injection={"limit_percent": 0.5}), extra_current_pu=tone(2, 5.0), q_sag_kvar=100)
    assert made.check("dc_injection").measured == pytest.approx(0, abs=1e-3)


@pytest.mark.parametrize(("kind", "numbers"), [("harmonics", LIMITS), ("dc_injection", {"limit_percent": 0.5})])
def test_missing_numbers(bench, demanding, kind, numbers):
    """A sample that is no number in the window leaves the test without a verdict."""
    made = bench(profile=demanding(**{kind: numbers}), spoiled={"i_b_a": 0.2}, q_sag_kvar=100.0)
    assert made.check(kind).status is Status.NOT_EVALUATED


def test_what_is_drawn_is_what_was_judged(distorted):
    """Every limited order and the total stand in the spectrum of each window, the one put in at its size."""
    limits = LIMITS | {"total_percent": 5.0}
    result = distorted(tone(7, 3.9, phase=1), limits, duration_s=0.3, scenario={"after_s": 1.5}).result()
    assert [spectrum.check for spectrum in result.spectra] == ["harmonics", "harmonics"]
    for spectrum in result.spectra:
        bars = {bar.order or bar.name: bar for bar in spectrum.bars}
        assert set(bars) == {*range(2, 51), "TRD"}
        assert (bars[7].measured, bars[7].limit, bars[7].phase) == (pytest.approx(3.9, rel=1e-3), 4.0, "b")
        assert bars["TRD"].measured == pytest.approx(3.9, rel=1e-2)
        assert max(bar.measured for order, bar in bars.items() if order not in (7, "TRD")) < 0.1
    check = next(check for check in result.checks if check.check == "harmonics")
    nearest = min(
        (bar for spectrum in result.spectra for bar in spectrum.bars), key=lambda bar: 1 - bar.measured / bar.limit
    )
    assert check.measured == pytest.approx(nearest.measured, rel=1e-9)  # both windows have it: the first is reported
    assert check.limit == nearest.limit
    assert check.at_s in {spectrum.start_s for spectrum in result.spectra}
