"""The first of those that are equal but for rounding, whichever way they are rounded."""

import math

import numpy as np
import pytest

from pvlvrt_compliance.measure.extremes import first_least, first_most, largest, smallest
from pvlvrt_compliance.measure.swing import swing

EITHER_WAY = [-1e-12, 0.0, 1e-12]


@pytest.mark.parametrize("by", EITHER_WAY)
def test_the_first_sample_of_those_that_are_equal(by):
    """Rounding of either sign moves neither the largest nor the smallest; the value is that of the extreme."""
    x = 500.0 * np.array([0.5, 1.0, 0.7, 1.0 + by, 0.2, 0.2 - by, 1.0])
    assert largest(x, 500.0) == (x.max(), 1)
    assert smallest(x, 500.0) == (x.min(), 4)
    assert largest(-x, 500.0) == (-x.min(), 4)


def test_rounding_is_that_of_the_scale_not_of_the_value():
    """Noise of a series about zero is that of what it was made of; what differs by more is another value."""
    assert largest(np.array([1e-11, 3e-11]), 1.0).at == 0
    assert largest(np.array([1e-11, 3e-11]), 1e-3).at == 1
    assert largest(np.array([1.0, 1.0 + 1e-8]), 1.0).at == 1


@pytest.mark.parametrize("by", EITHER_WAY)
def test_several_rows_are_counted_row_by_row(by):
    """Of samples in rows and phases in columns the earliest sample, then the first phase."""
    assert largest(np.array([[0.0, 1.0 + by], [1.0, 1.0]]), 1.0).at == 1


@pytest.mark.parametrize("by", EITHER_WAY)
def test_the_first_of_some_items(by):
    """Items go by a value of theirs; infinite ones are equal to each other and to nothing else."""
    items = [("a", 3.0), ("b", 1.0), ("c", 1.0 + by), ("d", 3.0 - by)]
    assert first_least(items, lambda item: item[1], 1.0)[0] == "b"
    assert first_most(items, lambda item: item[1], 1.0)[0] == "a"
    assert first_least([("a", 0.0), ("b", -math.inf), ("c", -math.inf)], lambda item: item[1], 1.0)[0] == "b"
    assert first_least([("a", math.inf), ("b", math.inf)], lambda item: item[1], 1.0)[0] == "a"


@pytest.mark.parametrize("by", EITHER_WAY)
def test_the_first_sample_of_a_swing(by):
    """Of two crests of the same height, the earlier one."""
    t_s, x = np.arange(9.0), np.array([0.0, 1, 0, -1, 0, 1 + by, 0, -1, 0])
    line = np.polynomial.Polynomial.fit(t_s, x, 1)(t_s)
    x = x - line  # the crests of what is left are as high as each other
    x[5] = x[1] + by
    at = swing(t_s, 500 + x, np.ones(9), 500.0).at
    assert at == int(np.abs(x).round(9).argmax())
