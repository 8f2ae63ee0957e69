"""What is compiled of windows gives what `measure` defines, however long they are and whatever is in them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure import frequency as by_definition
from pvlvrt_compliance.measure.frequency import frequency_before, fundamental_frequency
from pvlvrt_compliance.measure.harmonics import harmonic_amplitudes
from pvlvrt_compliance.measure.summary import measure
from pvlvrt_compliance.measure.window_sums import WINDOWS_BY_DEFINITION, window_sums
from pvlvrt_compliance.simulation.streaming import whole_cycles
from pvlvrt_compliance.study.instruments import compiled_instruments
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms import Segment, Waveforms

WINDOWS = compiled_instruments().windows
NOMINAL = Nominal()
STEPS_S = (40.9568e-6, 163.8272e-6, 1e-3 / 3, 1.9e-3)


@st.composite
def windows(draw):
    """A window of voltages, currents and a DC voltage: unbalance, harmonics, noise, a drift, or flat; any length."""
    noise = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    dt_s, hz = draw(st.sampled_from(STEPS_S)), draw(st.one_of(st.just(50.0), st.floats(45, 63)))
    cycles = draw(st.one_of(st.just(1.0), st.floats(0.5, 12)))
    n = max(round(cycles / hz / dt_s), 2)
    angle = 2 * np.pi * hz * dt_s * np.arange(n) + draw(st.floats(-3, 3))
    size = draw(st.sampled_from([300.0, 300.0, 1e-3, 0.0, 1e9]))
    unbalance, distortion, noisy = (draw(st.sampled_from([0.0, x])) for x in (0.3, 0.1, 0.02))
    channels = {}
    for k, name in enumerate(("u_a_v", "u_b_v", "u_c_v", "i_a_a", "i_b_a", "i_c_a")):
        shift = k % 3 * 2 * np.pi / 3
        wave = np.cos(angle - shift) + unbalance * np.cos(angle + shift) + distortion * np.cos(7 * angle + k)
        channels[name] = size * (wave + noisy * noise.normal(size=n))
    ripple = draw(st.sampled_from([0.0, 5.0]))
    channels["v_dc_v"] = 850 + draw(st.floats(-500, 500)) * dt_s * np.arange(n) + ripple * np.cos(2 * angle)
    return Segment(draw(st.sampled_from([0.0, 7.3])), dt_s, channels), hz, size


def either(measured):
    """What a function gives, or what it says is wrong."""
    try:
        return measured()
    except MeasurementError as error:
        return str(error)


@given(windows())
@draws(120)
def test_sums_over_whole_cycles(drawn):
    """Voltages, powers and DC voltage; a window without a whole cycle is refused in the same words."""
    segment, hz, size = drawn
    expected, found = (either(lambda by=by: window_sums(segment, hz, by)) for by in (WINDOWS_BY_DEFINITION, WINDOWS))
    if isinstance(expected, str):
        assert found == expected
        return
    assert np.abs(found.voltages - expected.voltages).max() <= 1e-9 * size
    assert np.abs(np.subtract(found.powers, expected.powers)).max() <= 1e-9 * size**2
    assert np.abs(np.subtract(found.dc, expected.dc)).max() <= 1e-9 * 850


def test_a_record_that_lacks_a_channel_is_summed_by_numpy():
    """What is compiled takes all channels, and a recording may have some."""
    t = 1e-4 * np.arange(2000)
    channels = {f"u_{phase}_v": np.cos(2 * np.pi * (50 * t - k / 3)) for k, phase in enumerate("abc")}
    found = window_sums(Segment(0.0, 1e-4, channels), 50.0, WINDOWS)
    assert found.powers is None
    assert found.dc is None
    assert np.abs(found.voltages) == pytest.approx([1.0] * 3, rel=1e-9)


@given(windows(), st.sampled_from([1, 2, 40]))
@draws(120)
def test_harmonics(drawn, highest):
    """Of every order that the sampling carries, from the mean on."""
    segment, hz, size = drawn
    currents = np.stack(segment.three_phase("i")) + 0.1 * size
    expected, found = (
        either(lambda by=by: harmonic_amplitudes(currents, segment.dt_s, hz, highest, by))
        for by in (None, WINDOWS.harmonics)
    )
    if isinstance(expected, str):
        assert found == expected
    else:
        assert np.abs(found - expected).max() <= 1e-9 * size


def test_harmonics_of_what_is_no_number_are_none():
    """One sample is enough, and the other phases keep theirs."""
    currents = np.cos(2 * np.pi * 50 * 1e-4 * np.arange(2000)) * np.ones((3, 1))
    currents[1, 77] = np.nan
    for by in (None, WINDOWS.harmonics):
        found = harmonic_amplitudes(currents, 1e-4, 50.0, by=by)
        assert np.isnan(found[1]).all()
        assert found[[0, 2], 1] == pytest.approx([1.0, 1.0], rel=1e-9)


@given(windows(), st.sampled_from([50.0, 60.0, 49.2]))
@draws(120)
def test_frequency(drawn, nominal_hz):
    """Of a window; none, in the same words, where it is too short, or has no voltage, or no frequency near nominal."""
    segment, _, _ = drawn
    expected, found = (
        either(lambda by=by: fundamental_frequency(segment, nominal_hz, "u", 1.0, by))
        for by in (None, WINDOWS.frequency)
    )
    if isinstance(expected, str):
        assert found == expected
    else:
        assert found == pytest.approx(expected, abs=1e-9 * nominal_hz)


def test_frequency_is_looked_for_as_the_definition_does():
    """By as many corrections, until as little is left, by as many angles a cycle."""
    names = ("ITERATIONS", "SETTLED_HZ", "ANGLES_A_CYCLE")
    assert [getattr(whole_cycles, name) for name in names] == [getattr(by_definition, f"_{name}") for name in names]


@pytest.mark.parametrize("length_s", [0.2, 3.5])
def test_windows_of_a_record(length_s):
    """Every quantity of every window, one of over three seconds among them, whose end alone has a frequency."""
    dt_s, start_s = 1e-4, 0.3
    t = dt_s * np.arange(round((start_s + length_s + 1.4) / dt_s))
    sagging = (t >= start_s) & (t < start_s + length_s)
    angle = 2 * np.pi * (50.02 * t - np.arange(3)[:, np.newaxis] / 3)
    u = np.where(sagging, 0.4, 1.0) * NOMINAL.phase_voltage_peak_v * np.cos(angle)
    i = NOMINAL.phase_current_peak_a * (np.cos(angle - 0.3) + np.where(sagging, 0.05, 0.01) * np.cos(5 * angle))
    channels = dict(zip(("u_a_v", "u_b_v", "u_c_v", "i_a_a", "i_b_a", "i_c_a"), (*u, *i), strict=True))
    channels |= {"v_dc_v": 850 + 3 * np.cos(2 * angle[0]), "q_ref_var": np.where(sagging, 1e5, 0.0)}
    record = Waveforms((Segment(0.0, dt_s, channels),))
    expected, found = (
        measure(record, NOMINAL, start_s, start_s + length_s, by=by) for by in (WINDOWS_BY_DEFINITION, WINDOWS)
    )
    assert frequency_before(record, start_s, 50.0, by=WINDOWS.frequency) == pytest.approx(50.02, abs=1e-6)
    for name in ("before", "during", "after"):
        numbers = getattr(expected, name).model_dump()
        assert None not in numbers.values()
        for quantity, value in numbers.items():
            assert getattr(getattr(found, name), quantity) == pytest.approx(value, rel=1e-9, abs=1e-9), quantity
