"""Bases of a controller beside those of the plant: told where they differ, and never of what is none."""

import math

import pytest

from pvlvrt_compliance.controllers.bases import beside, differing
from pvlvrt_compliance.controllers.description import Description, ParameterInfo, Port
from pvlvrt_compliance.controllers.mapping.port_units import Bases
from pvlvrt_compliance.units import Nominal

NOMINAL = Nominal(apparent_power_va=500e3, phase_voltage_v=230.0, frequency_hz=50.0)
V_DC = 807.0
CURRENT = 500e3 / (3 * 230)


def found(*parameters, inputs=(), bases=None):
    """Bases that differ, of parameters ``(name, value, unit)`` and inputs that are given a constant."""
    it = Description(
        "any",
        "any",
        "",
        1e-4,
        inputs=tuple(Port(name, unit, mapped_to=f"{value:g}") for name, value, unit in inputs),
        parameters=tuple(ParameterInfo(name, value, unit) for name, value, unit in parameters),
    )
    return differing(it, {name: value for name, value, _ in parameters}, bases, NOMINAL, V_DC)


@pytest.mark.parametrize(
    ("name", "value", "unit", "plant"),
    [
        ("VLLbase", 600.0, "V", math.sqrt(3) * 230),
        ("VLLbase", 600.0, "V (RMS)", math.sqrt(3) * 230),
        ("V_nom", 0.6, "kV", math.sqrt(3) * 0.230),
        ("rated_voltage", 690, "", math.sqrt(3) * 230),
        ("Vph_base", 480.0, "V", 230),
        ("Vpk_base", 500.0, "V", math.sqrt(2) * 230),
        ("Vdcbase", 1200.0, "V", V_DC),
        ("Ibase", 100.0, "A", CURRENT),
        ("Sbase", 200e3, "VA", 500e3),
        ("Sn", 0.2, "MVA", 0.5),
        ("MVABase", 0.2, "", 0.5),
        ("kva_rated", 200, "", 500),
        ("nominal_power", 1e6, "W", 500e3),
        ("fbase", 60.0, "Hz", 50),
        ("wbase", 120 * math.pi, "rad/s", 100 * math.pi),
        ("omega_nom", 120 * math.pi, "", 100 * math.pi),
        ("Vb_LL_kV", 0.6, "", math.sqrt(3) * 0.230),
        ("Sb_MVA", 0.2, "", 0.5),
        ("Sbase_kva", 200, "", 500),
        ("fnomHz", 60.0, "", 50),
        ("VLLbase_V", 600.0, "V", math.sqrt(3) * 230),
    ],
)
def test_a_base_that_differs(name, value, unit, plant):
    """It stands beside the plant's, in its own unit; with the plant's value there is nothing to say."""
    (base,) = found((name, value, unit))
    assert base.name == name
    assert base.plant[0].value == pytest.approx(plant)
    for way in base.plant:
        assert found((name, way.value, unit)) == ()
        assert found((name, 1.01 * way.value, unit)) != ()


@pytest.mark.parametrize(
    ("name", "value", "unit"),
    [
        ("Vbase", 1.0, "pu"),
        ("Vbase", "600", ""),
        ("base", 3.0, ""),
        ("wn", 60.0, "rad/s"),
        ("Vb", 12.0, "V"),
        ("P0", 3.0, "W"),
        ("database", 3.0, ""),
        ("turbine", 3.0, ""),
        ("kp_nom", 3.0, ""),
        ("Vbase", 0.0, "V"),
        ("Tnom", 3.0, "s"),
        ("Sbase", 3.0, "degC"),
        ("Vbase_a", 600.0, ""),
        ("Sbase_V", 600.0, ""),
        ("Vb_kV", 0.6, ""),
    ],
)
def test_what_is_no_base(name, value, unit):
    """A natural frequency, phase b, a start value, a word that only sounds like it, a base that is not filled in."""
    assert found((name, value, unit)) == ()


def test_constants_and_bases_of_a_mapping():
    """An input that is given a number, and 1 pu of the mapping file, are bases, too."""
    bases = found(inputs=[("Vnom", 690.0, "V"), ("Va", 3.0, "V")], bases=Bases(voltage_v=490.0, power_va=500e3))
    assert [(base.where, base.name) for base in bases] == [("input", "Vnom"), ("mapping", "voltage_v")]
    assert beside(bases, "input") == {"Vnom": "398.37 V line to line (rms) or 230 V phase to neutral (rms)"}
    assert "563.38 V line to line (peak)" in beside(bases, "mapping")["voltage_v"]
