import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import lambertw

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.plant import pv_array
from pvlvrt_compliance.plant.pv_array import STP320_24_VE, current_at, fit, maximum_power_point, open_circuit_voltage

IRRADIANCES = (100.0, 300.0, 600.0, 1000.0, 1200.0)


def at(temperature: float) -> pv_array.PvParams:
    """The array of the paper at a cell temperature (degrees C)."""
    return fit(STP320_24_VE, temperature, 22, 72)


def test_table_1_of_the_paper():
    """Open circuit, short circuit and maximum power of 72 x 22 modules are those of Table 1 within 0.1 %."""
    array = at(25.0)
    best = maximum_power_point(1000.0, array)
    found = [open_circuit_voltage(1000.0, array), current_at(0.0, 1000.0, array), best.v, best.p / best.v, best.p]
    assert found == pytest.approx([1003.2, 653.04, 807.4, 627.84, 506.91e3], rel=1e-3)


@pytest.mark.parametrize("temperature", [-10.0, 25.0, 60.0])
@pytest.mark.parametrize("irradiance", IRRADIANCES)
def test_the_characteristic_is_that_of_pvlib(irradiance, temperature):
    """Currents from 0 to 1.02 open-circuit voltages agree with pvlib's single-diode equation within 1e-6."""
    pvsystem = pytest.importorskip("pvlib.pvsystem")
    array = at(temperature)
    G = irradiance / 1000
    v = np.linspace(0, 1.02 * open_circuit_voltage(irradiance, array), 41)
    module = pvsystem.i_from_v(
        v / array.n_series, array.I_L * G, array.I_0, array.R_s, 1 / (array.G_sh * G), array.a, method="newton"
    )
    found = [current_at(x, irradiance, array) for x in v]
    assert np.allclose(found, array.n_parallel * module, rtol=1e-6, atol=1e-6 * found[0])


@pytest.mark.parametrize("temperature", [-30.0, 0.0, 50.0, 80.0])
def test_temperature_coefficients_of_the_data_sheet(temperature):
    """Open-circuit voltage, short-circuit current and maximum power move by the coefficients given."""
    dT = temperature - 25
    array, module = at(temperature), STP320_24_VE
    v_oc, i_sc, p_mp = 22 * module.V_oc, 72 * module.I_sc, 22 * 72 * module.V_mp * module.I_mp
    assert open_circuit_voltage(1000.0, array) == pytest.approx(v_oc * (1 + module.beta_voc * dT), rel=1e-6)
    assert current_at(0.0, 1000.0, array) == pytest.approx(i_sc * (1 + module.alpha_isc * dT), rel=1e-6)
    i_mp, v_mp = 1 + module.alpha_isc * dT, 1 + (module.gamma_pmp - module.alpha_isc) * dT
    assert maximum_power_point(1000.0, array).p == pytest.approx(p_mp * i_mp * v_mp, rel=1e-6)


def test_slope_of_the_maximum_power_at_standard_conditions():
    """dP_mp/dT at 25 degrees C is the coefficient of the data sheet."""
    above, below = (maximum_power_point(1000.0, at(25.0 + d)).p for d in (1.0, -1.0))
    assert (above - below) / 2 / maximum_power_point(1000.0, at(25.0)).p == pytest.approx(
        STP320_24_VE.gamma_pmp, rel=1e-4
    )


@given(st.floats(-200, 200))
def test_lambert_w_is_that_of_scipy(ln_x):
    """W of any positive number is that of scipy.special.lambertw to 1e-15, and W(0) is 0."""
    x = math.exp(ln_x)
    assert pv_array.lambert_w(x) == pytest.approx(float(lambertw(x).real), rel=1e-15)
    assert pv_array.lambert_w(0.0) == 0


def test_no_irradiance_gives_no_current():
    """In the dark there is neither current nor open-circuit voltage nor power."""
    array = at(25.0)
    assert open_circuit_voltage(0.0, array) == 0
    assert maximum_power_point(0.0, array).p == 0
    assert abs(current_at(0.0, 0.0, array)) < 1e-9
    assert abs(current_at(600.0, 0.0, array)) < 1e-3


@pytest.mark.parametrize("irradiance", IRRADIANCES)
def test_the_maximum_power_point_is_a_maximum(irradiance):
    """The slope of the power is zero there, and less power is found to its right."""
    array = at(25.0)
    best = maximum_power_point(irradiance, array)

    def power(v):
        return v * current_at(v, irradiance, array)

    assert abs(power(best.v + 0.1) - power(best.v - 0.1)) < 1e-5 * best.p
    v = pv_array.voltage_at_power(0.8 * best.p, irradiance, array)
    assert v > best.v
    assert power(v) == pytest.approx(0.8 * best.p, rel=1e-9)


@given(st.floats(0, 1100), st.floats(0, 1.5), st.floats(-5, 60))
def test_the_junction_voltage_is_found_from_any_guess(in_python, v, G, guess):
    """Newton's iteration ends at the root of the single-diode equation wherever it starts."""
    array = at(25.0)
    x = in_python(pv_array.diode_voltage)(v, G, guess, array)
    diode = array.I_0 * math.expm1(x / array.a) + array.G_sh * G * x
    module = array.I_L * G - diode - (x - v / array.n_series) / array.R_s
    assert abs(module) < 1e-6 * (1 + abs(diode))


def test_impossible_data_sheets_are_refused():
    """Numbers that no single diode can meet end with a sentence, not with a wrong curve."""
    with pytest.raises(UsageError, match="25 C"):
        fit(STP320_24_VE._replace(V_mp=20.0), 25.0, 22, 72)
