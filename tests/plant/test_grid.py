import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.plant import grid
from pvlvrt_compliance.scenario.sag import Sag

U = math.sqrt(3) * 230


@pytest.fixture(scope="module")
def source(in_python):
    """The blocks of the source in Python, by name."""
    return {
        name: in_python(getattr(grid, name)) for name in ("source_at", "step_later", "source_voltage", "zero_sequence")
    }


@given(st.floats(0, 0.29), st.floats(47, 62))
def test_a_step_later_is_the_source_of_that_instant(source, plant, t, frequency):
    """Turning step by step and looking up the instant agree."""
    p, tables = plant(frequency_hz=frequency)
    stepped = source["source_at"](t, 0, tables.grid)
    for _ in range(8):
        stepped = source["step_later"](stepped)
    looked_up = source["source_at"](t + 8 * p.T_S, 0, tables.grid)
    assert stepped.turn == pytest.approx(looked_up.turn, abs=1e-9)


@pytest.mark.parametrize(("t", "size"), [(0.0, 1), (0.2999, 1), (0.3001, 0.1), (0.6089, 0.1), (0.6092, 1), (5.0, 1)])
def test_the_sag_lies_between_its_breakpoints(source, plant, t, size):
    """The source is healthy before the sag, sagged from its start and healthy from its clearing on."""
    _, tables = plant(sag=Sag(depth=0.9), duration_s=0.309)
    assert abs(source["source_voltage"](source["source_at"](t, 0, tables.grid))) == pytest.approx(size * U)


@pytest.mark.parametrize("angle", [0, 90, 210])
@pytest.mark.parametrize("sag", [Sag(depth=0.9, phases="c"), Sag(depth=0.6, phases="ca", two_phase=True)])
def test_phases_of_the_source_are_those_of_the_sag(source, plant, sag, angle):
    """Each phase is the real part of its phasor, zero sequence included, phase a at its angle at the start."""
    _, tables = plant(sag=sag, point_on_wave_deg=angle)
    t = 0.31
    x = source["source_at"](t, 0, tables.grid)
    turning = cmath.exp(1j * (math.radians(angle) + 2 * math.pi * 50 * (t - 0.3)))
    expected = [math.sqrt(2) * 230 * (phasor * turning).real for phasor in sag.phasors_pu()]
    along = math.sqrt(2 / 3) * source["source_voltage"](x)
    zero = source["zero_sequence"](x)
    found = [(along * cmath.exp(-2j * math.pi * k / 3)).real + zero for k in range(3)]
    assert found == pytest.approx(expected, abs=1e-6)
