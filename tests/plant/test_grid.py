import cmath
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.plant import grid
from pvlvrt_compliance.plant import plant as plant_module
from pvlvrt_compliance.scenario.events import Harmonic
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.surroundings import harmonic_table
from pvlvrt_compliance.simulation.translate import nominal_of

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


@given(st.integers(-50, 50), st.floats(-7, 7))
def test_a_power_of_the_turning_is_that_many_times_the_angle(in_python, order, theta):
    """exp(j order theta) by squaring."""
    assert in_python(grid.power_of)(cmath.rect(1, theta), order) == pytest.approx(
        cmath.rect(1, order * theta), abs=1e-12
    )


@pytest.mark.parametrize("t", [0.99, 1.0, 1.0004, 1.00199, 1.0021])
def test_a_recording_takes_the_place_of_the_source_while_it_lasts(in_python, t):
    """Between its samples it runs along straight lines; before and after it, the source is what it was."""
    u = np.array([1 + 1j, 3 - 1j, 2 + 0j])
    table = grid.PlaybackTable(t=1.0, dt=1e-3, u=u, u_zero=u.real)
    at = 1.0 + 1e-3 * np.arange(3)
    lasts = 1.0 <= t < 1.002
    found, zero = (
        in_python(plant_module.or_playback)(7j, t, table),
        in_python(plant_module.zero_or_playback)(7.0, t, table),
    )
    assert found == pytest.approx(np.interp(t, at, u.real) + 1j * np.interp(t, at, u.imag) if lasts else 7j)
    assert zero == pytest.approx(np.interp(t, at, u.real) if lasts else 7.0)
    assert in_python(plant_module.or_playback)(7j, t, None) == 7j


@pytest.mark.parametrize(("t", "held"), [(0.9, 0), (1.0, 1), (1.5, 1), (2.0, 0)])
def test_harmonics_turn_with_the_fundamental(in_python, source, plant, t, held):
    """The fifth turns backwards five times as fast, the third stands in the zero sequence; each while it lasts."""
    _, tables = plant()
    at = source["source_at"](t, 0, tables.grid)
    harmonics = grid.HarmonicTable(
        order=np.array([-5, 3]),
        u=np.array([10 + 0j, 0j]),
        u_zero=np.array([0j, 4 + 0j]),
        t_on=np.array([1.0, 1.0]),
        t_off=np.array([2.0, 2.0]),
        t_over=np.array([2.0, 2.0]),
    )
    theta = cmath.phase(at.turn)
    e = in_python(plant_module.with_harmonics)(100 + 0j, at, t, harmonics)
    zero = in_python(plant_module.zero_with_harmonics)(1.0, at, t, harmonics)
    assert e == pytest.approx(100 + held * cmath.rect(10, -5 * theta))
    assert zero == pytest.approx(1.0 + held * 4 * math.cos(3 * theta))
    assert in_python(plant_module.with_harmonics)(100 + 0j, at, t, None) == 100


SPANS = st.lists(
    st.tuples(
        st.one_of(st.none(), st.integers(-10, 20)), st.one_of(st.none(), st.integers(1, 12)), st.sampled_from([3, 5, 7])
    ),
    max_size=12,
)


@given(spans=SPANS, tick=st.integers(-15, 35))
def test_whatever_holds_of_many_harmonics_is_summed(in_python, spans, tick):
    """In any order, over each other or not, from the beginning on or to the end."""
    events = [
        Harmonic(
            kind="harmonic",
            order=order,
            amplitude_pu=0.01 * (k + 1),
            phase_deg=10.0 * k,
            **({} if begin is None else {"t_s": 0.01 * begin}),
            **({} if length is None else {"duration_s": 0.01 * length}),
        )
        for k, (begin, length, order) in enumerate(spans)
    ]
    scenario = Scenario(sag=Sag(depth=0.0), duration_s=0.2, events=tuple(events))
    nominal = nominal_of(Parameters(), scenario)
    t = scenario.start_s + 0.01 * tick + 0.005
    source = grid.Source(0, 1e9, 0j, 0j, 0j, cmath.rect(1, 0.7), 1 + 0j, 0j, 0j)
    table = harmonic_table(scenario, nominal)
    e, zero = 0j, 0.0
    for k, (begin, length, order) in enumerate(spans):
        began = begin is None or begin <= tick
        ended = length is not None and (begin is None or tick >= begin + length)  # from the beginning: long over
        if began and not ended:
            in_phase_a = nominal.phase_voltage_peak_v * 0.01 * (k + 1)
            u = cmath.rect(in_phase_a, math.radians(10.0 * k))
            turned = {3: 0j, 5: (u.conjugate()) * cmath.rect(1, -5 * 0.7), 7: u * cmath.rect(1, 7 * 0.7)}[order]
            e += math.sqrt(1.5) * turned
            zero += (u * cmath.rect(1, 3 * 0.7)).real if order == 3 else 0.0
    assert in_python(plant_module.with_harmonics)(0j, source, t, table) == pytest.approx(e, abs=1e-9)
    assert in_python(plant_module.zero_with_harmonics)(0.0, source, t, table) == pytest.approx(zero, abs=1e-9)
