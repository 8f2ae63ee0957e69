"""Irradiance over time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.plant.weather import IrradianceTable, irradiance_at


@pytest.mark.parametrize("t", [-2.0, 0.0, 0.5, 1.0, 1.2, 1.5, 3.0, 100.0])
def test_straight_lines_between_the_points_and_the_last_level_held(in_python, t):
    """As numpy interpolates; a step is two points a moment apart."""
    table = IrradianceTable(t=np.array([-1e3, 1.0, 1.0 + 1e-9, 2.0]), G=np.array([1.0, 1.0, 0.4, 0.8]))
    assert in_python(irradiance_at)(t, table) == pytest.approx(np.interp(t, table.t, table.G))


@given(
    steps=st.lists(st.tuples(st.sampled_from([0.1, 0.25, 1.0]), st.floats(0.0, 1.2)), min_size=1, max_size=12),
    t=st.floats(-2.0, 15.0),
)
def test_any_number_of_points(in_python, steps, t):
    """As numpy interpolates between them."""
    at = np.concatenate([[-1e3], np.cumsum([length for length, _ in steps])])
    table = IrradianceTable(t=at, G=np.array([1.0, *(level for _, level in steps)]))
    assert in_python(irradiance_at)(t, table) == pytest.approx(np.interp(t, table.t, table.G))
