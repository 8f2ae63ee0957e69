"""The plant step that goes with a controller's sample time."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.controllers.sample_time import rates_of
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.simulation.parameters import parameters_from

DEFAULTS = parameters_from(())
SWITCHED = parameters_from(("simulation.fidelity=switched",))


@pytest.mark.parametrize(
    ("sample_time_s", "plant_step_us"),
    [(10e-6, 5.0), (40.9568e-6, 5.1196), (100e-6, 5.0), (200e-6, 5.0), (5e-3, 5000 / 977)],
)
def test_plant_step_is_the_largest_whole_part(sample_time_s, plant_step_us):
    """Of the sample time, not above the default; which is kept to the bit for the bundled controller's."""
    found = rates_of(sample_time_s, DEFAULTS)
    assert found.plant_step_us == pytest.approx(plant_step_us, rel=1e-12)
    if plant_step_us == DEFAULTS.simulation.plant_step_us:
        assert (found.plant_step_us, found.steps, found.periods, found.thinning) == (plant_step_us, 8, 1, 1)


@given(st.floats(min_value=1e-6, max_value=0.1), st.booleans())
def test_rates_fit_each_other(sample_time_s, switched):
    """Whole numbers lead from the plant step to the sample time; a step, and a row of a record, is never too long."""
    parameters = SWITCHED if switched else DEFAULTS
    found = rates_of(sample_time_s, parameters)
    assert found.sample_time_s == pytest.approx(sample_time_s, rel=2e-9)
    assert found.plant_step_us <= 5.1196 * (1 + 1e-8)
    row_us = found.plant_step_us * found.steps * found.thinning
    assert row_us <= 40.9568 * (1 + 1e-8)
    fewer = found.steps * found.periods - 1
    assert switched or fewer == 0 or 1e6 * sample_time_s / fewer > 5.1196 * (1 - 1e-8)


def test_carrier_of_the_switched_inverter_has_a_usual_length():
    """Also where the number of plant steps would have no divisors, the carrier's period stays near the default."""
    found = rates_of(5e-3, SWITCHED)
    assert 35 < found.plant_step_us * found.steps <= 40.96


def test_fixed_step_that_does_not_fit_is_refused():
    """With the nearest steps that do."""
    with pytest.raises(UsageError) as error:
        rates_of(100e-6, parameters_from(("simulation.plant_step_us=3",)))
    assert "the nearest are 3.0303 us (33 steps) or 2.94118 us (34 steps)" in str(error.value)


def test_fixed_step_that_fits_is_kept():
    """As is a fixed ratio."""
    assert rates_of(100e-6, parameters_from(("simulation.plant_step_us=2.5",))).plant_step_us == 2.5
    assert rates_of(100e-6, parameters_from(("simulation.control_ratio=50",))).plant_step_us == pytest.approx(2.0)


def test_fixed_step_and_ratio_that_contradict_are_refused():
    """One of the two has to go."""
    with pytest.raises(UsageError, match="leave one of the two out"):
        rates_of(100e-6, parameters_from(("simulation.plant_step_us=2.5", "simulation.control_ratio=8")))


def test_step_longer_than_the_sample_time_is_refused():
    """The nearest that fit are not longer than the sample time."""
    with pytest.raises(UsageError, match=r"the nearest are 2 us \(1 steps\) or 1 us \(2 steps\)"):
        rates_of(2e-6, parameters_from(("simulation.plant_step_us=5",)))


@pytest.mark.parametrize("sample_time_s", [0.0, -1e-4, 5e-7, 0.2, float("nan"), float("inf")])
def test_sample_time_out_of_range_is_refused(sample_time_s):
    """With the range."""
    with pytest.raises(UsageError, match=r"from 1e-06 s to 0.1 s"):
        rates_of(sample_time_s, DEFAULTS)
