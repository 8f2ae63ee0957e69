import pytest

from validation.simulator import photovoltaics


def test_the_array_is_that_of_table_1(assert_within):
    """All five figures of Table 1 within 0.1 %."""
    assert_within(photovoltaics.table_rows())


def test_currents_are_those_of_pvlib(assert_within):
    """I(v) agrees within 1e-6 from 100 to 1200 W/m2, in the kernel and in closed form."""
    pytest.importorskip("pvlib.pvsystem")
    assert_within(photovoltaics.current_rows())


def test_temperature_moves_the_array_by_the_datasheet(assert_within):
    """Voltage, current and power change by the coefficients."""
    assert_within(photovoltaics.temperature_rows())
