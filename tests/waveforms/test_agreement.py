"""How far columns are from what was expected: closed forms, what is no number, and shifts."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.waveforms.agreement import Tolerance, agreement, differences, parse_tolerance

T_S = 1e-3 * np.arange(50)
ALL = np.arange(50)
NOTHING = Tolerance(0.0, 0.0)


def compared(found, expected, tolerance=NOTHING, places=ALL):
    """Two columns beside each other."""
    return agreement("y", "V", T_S, np.asarray(found, float), places, np.asarray(expected, float), tolerance)


@pytest.mark.parametrize(
    ("text", "share", "absolute"),
    [
        ("0.1%", 1e-3, 0.0),
        ("1e-6", 1e-6, 0.0),
        ("1e-6+1e-9", 1e-6, 1e-9),
        ("0 + 0.5", 0.0, 0.5),
        ("2.5 % + 1e+1", 0.025, 10.0),
        ("1e+0+1e+0", 1.0, 1.0),
        (".5", 0.5, 0.0),
    ],
)
def test_a_tolerance_is_read(text, share, absolute):
    """A share, and a number in the unit of the column."""
    assert parse_tolerance(text, "--tolerance") == pytest.approx((share, absolute), rel=1e-15)
    assert parse_tolerance(str(Tolerance(share, absolute)), "--tolerance") == pytest.approx((share, absolute))


@pytest.mark.parametrize("text", ["", "-1", "1e-6-1e-9", "1e-6+", "+1", "nan", "inf", "1e999", "0.1 V", "1,5"])
def test_what_is_no_tolerance_is_refused(text):
    """With how it is written, or that it is not finite."""
    with pytest.raises(UsageError, match=r"--tolerance: .*(write a share of the largest expected value|not finite)"):
        parse_tolerance(text, "--tolerance")


def test_the_rule_is_a_share_of_the_peak_and_a_number():
    """Just inside and just outside of 1 % of 200 and 0.5; the least expected value is a peak, too."""
    expected = np.linspace(-200, 100, 50)
    for off, is_inside in ((2.4999, True), (2.5001, False)):
        found = compared(expected + off * (ALL == 7), expected, Tolerance(0.01, 0.5))
        assert (found.is_inside, found.peak, found.allowed) == (is_inside, 200, 2.5)
        assert (found.outside, found.first is None) == ((0, True) if is_inside else (1, False))


def test_largest_share_and_rms():
    """Of an error of 3 in one sample and 4 in another, of 50, beside a peak of 8."""
    expected = np.where(ALL == 30, -8.0, 0.0)
    found = compared(expected + 3 * (ALL == 10) - 4 * (ALL == 20), expected, Tolerance(0.0, 1.0))
    assert (found.largest, found.at_s, found.share) == (4, pytest.approx(0.02), 0.5)
    assert found.rms == pytest.approx(5 / math.sqrt(50))
    assert found.first == (10, pytest.approx(0.01), 3.0, 0.0)
    assert found.outside == 2


def test_of_zeros_alone_there_is_no_share():
    """A number alone may be allowed."""
    found = compared(np.full(50, 1e-10), np.zeros(50), Tolerance())
    assert found.is_inside
    assert math.isnan(found.share)


def test_numbers_beyond_what_squares_hold():
    """The mean square of large errors is one."""
    assert compared(np.full(50, 1e200), np.zeros(50)).rms == pytest.approx(1e200)


@pytest.mark.parametrize("none", [np.nan, np.inf, -np.inf])
def test_what_is_no_number(none):
    """It agrees with itself alone; the peak is of numbers."""
    column = np.where(ALL >= 40, none, 2.0)
    same, missing, new = (
        compared(column, column),
        compared(np.full(50, 2.0), column),
        compared(column, np.full(50, 2.0)),
    )
    assert (same.is_inside, same.largest, same.rms, same.peak) == (True, 0, 0, 2)
    assert (missing.first.sample, missing.largest, missing.rms) == (40, np.inf, np.inf)
    assert (new.first.sample, new.outside) == (40, 10)
    assert not compared(column, -column if np.isinf(none) else np.where(ALL >= 40, np.inf, 2.0)).is_inside


@pytest.mark.parametrize("shift", [-2, -1, 1, 2])
def test_a_shift_is_seen(shift):
    """Positive: late. What it would take beyond the ends is not asked for."""
    wave = np.sin(0.3 * np.arange(60))
    found = compared(wave[5 : 5 + 50], wave[5 + shift : 5 + shift + 50], Tolerance(1e-9, 0.0))
    assert found.shifted == shift
    some = np.arange(4, 44, 4)
    assert compared(wave[:50], wave[4 + shift : 44 + shift : 4], Tolerance(1e-9), some).shifted == shift


@pytest.mark.parametrize(
    "found",
    [np.sin(0.3 * ALL) + 0.1, np.sin(0.3 * (ALL - 3)), np.zeros(50), np.full(50, np.nan)],
    ids=["offset", "three", "zeros", "none"],
)
def test_what_is_no_shift(found):
    """Another error, a longer shift, and what does not change at all."""
    assert compared(found, np.sin(0.3 * ALL), Tolerance(1e-9)).shifted == 0
    assert compared(np.where(ALL == 3, 2.0, 1.0), np.ones(50)).shifted == 0


@given(st.lists(st.tuples(st.floats(), st.floats()), min_size=1, max_size=30))
def test_differences_are_never_no_number(pairs):
    """At least 0, 0 of what is the same, and the same both ways round."""
    a, b = (np.array(x) for x in zip(*pairs, strict=True))
    off = differences(a, b)
    assert (off >= 0).all()
    assert (off == differences(b, a)).all()
    assert (differences(a, a) == 0).all()
    assert ((off == 0) == ((a == b) | (np.isnan(a) & np.isnan(b)))).all()
