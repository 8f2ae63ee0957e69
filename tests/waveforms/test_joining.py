import math

import numpy as np
import pytest

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.fourier import one_cycle_mean, one_cycle_phasor
from pvlvrt_compliance.waveforms import Segment, Waveforms
from pvlvrt_compliance.waveforms.joining import one_cycle_series, window_on_one_grid

DT_S = 40.9568e-6


def record(whole, *cuts):
    """Stretches of a uniform record: (first sample, step), the first samples being multiples of all steps."""
    ends = [first for first, _ in cuts[1:]] + [len(whole)]
    return Waveforms(
        tuple(
            Segment(first * DT_S, step * DT_S, {"x": whole[first:end:step], "k": np.arange(first, end, step) * 1.0})
            for (first, step), end in zip(cuts, ends, strict=True)
        )
    )


def phasors(frequency_hz):
    """One-cycle amplitude of a segment."""
    return lambda segment: np.abs(one_cycle_phasor(segment["x"], segment.dt_s, frequency_hz))


def wave(frequency_hz, harmonics, n):
    """A sinusoid of amplitude 1 with harmonics."""
    angle = 2 * np.pi * frequency_hz * DT_S * np.arange(n)
    return np.cos(angle + 0.4) + sum(a * np.cos(h * angle + h) for h, a in harmonics.items())


@pytest.mark.parametrize("frequency_hz", [50.0, 60.0])
@pytest.mark.parametrize(("step", "harmonics"), [(8, {}), (8, {5: 0.05, 7: 0.03}), (37, {})])
def test_one_cycle_series_go_on_across_changes_of_step(frequency_hz, harmonics, step):
    """After a change of step, either way, the amplitude is the closed form's as well as on a grid of its own.

    What is added to it is what the documented error of the interpolation allows.
    """
    n = step * (60000 // step)
    cuts = ((0, 1), (step * (15000 // step), step), (step * (40000 // step), 1))
    waveforms = record(wave(frequency_hz, harmonics, n), *cuts)
    found = one_cycle_series(waveforms, phasors(frequency_hz), frequency_hz)
    alone = [np.abs(phasors(frequency_hz)(segment) - 1) for segment in waveforms]
    own = np.nanmax([np.nanmax(x) for x in alone])
    h = step * DT_S * 2 * math.pi * frequency_hz
    added = sum(a * min(1.07e-3 * (order * h) ** 8, 1) for order, a in {1: 1.0, **harmonics}.items())
    cycle = math.ceil(1 / (frequency_hz * DT_S))
    assert np.isnan(found[0][:cycle]).all()
    assert np.isfinite(found[0][cycle + 2 :]).all()
    for values in found[1:]:
        assert np.abs(values - 1).max() <= own + 2 * added + 1e-12


def test_series_of_a_segment_are_unchanged_by_what_is_before_it():
    """Beyond its first cycle, a segment's values are the ones it has alone, bit by bit."""
    waveforms = record(np.random.default_rng(3).normal(size=40000), (0, 1), (16000, 8), (32000, 1))
    for segment, values in zip(waveforms, one_cycle_series(waveforms, phasors(50.0), 50.0), strict=True):
        alone = phasors(50.0)(segment)
        beyond = math.ceil(0.02 / segment.dt_s) + 3
        assert np.array_equal(values[beyond:], alone[beyond:])


def test_from_fine_to_thin_nothing_is_interpolated():
    """The thin segment's first cycle is that of the thin grid laid over the whole record, noise and all."""
    noise = np.random.default_rng(4).normal(size=32000)
    values = one_cycle_series(record(noise, (0, 1), (16000, 8)), phasors(50.0), 50.0)[1]
    everywhere = phasors(50.0)(Segment(0.0, 8 * DT_S, {"x": noise[::8]}))[2000:]
    assert np.allclose(values, everywhere, rtol=0, atol=1e-12)


def test_a_cycle_over_several_segments():
    """Segments shorter than a cycle are reached across."""
    whole = wave(50.0, {}, 8 * 1000)
    cuts = ((0, 1), (4000, 8), (4080, 4), (4160, 1), (4200, 2))
    for values in one_cycle_series(record(whole, *cuts), phasors(50.0), 50.0)[1:]:
        assert np.abs(values - 1).max() < 1e-6


def test_means_go_on_too():
    """The one-cycle mean of a straight line is its value half a cycle ago, across changes of step too."""
    waveforms = record(np.arange(40000) * 1.0, (0, 1), (16000, 8), (32000, 1))
    series = one_cycle_series(waveforms, lambda s: one_cycle_mean(s["x"], s.dt_s, 50.0), 50.0)
    for segment, values in zip(waveforms.segments[1:], series[1:], strict=True):
        assert np.allclose(values, segment["x"] - 0.01 / DT_S, rtol=0, atol=1e-6)


@pytest.mark.parametrize(("gap", "step"), [(1.5, 1), (2, 1), (1, 2.5)])
def test_grids_that_do_not_fit_begin_anew(gap, step):
    """A pause or a step that is no multiple leaves the first cycle unknown."""
    first = Segment(0.0, DT_S, {"x": wave(50.0, {}, 4000)})
    second = Segment(first.end_s + gap * DT_S, step * DT_S, {"x": wave(50.0, {}, 4000)})
    waveforms = Waveforms((first, second))
    assert np.isnan(one_cycle_series(waveforms, phasors(50.0), 50.0)[1][0])
    with pytest.raises(MeasurementError, match="crosses a change of the sampling step"):
        window_on_one_grid(waveforms, 0.1, 0.2)


def test_a_window_across_steps_holds_every_sample_of_the_coarsest_grid():
    """Exactly the samples of the coarsest grid between the ends, from finer steps by picking."""
    waveforms = record(np.arange(40000) * 1.0, (0, 1), (16000, 8), (32000, 2))
    window = window_on_one_grid(waveforms, 15003.5 * DT_S, 33001.0 * DT_S)
    assert np.array_equal(window["k"], np.arange(15008, 33001, 8))
    assert window.dt_s == 8 * DT_S
    assert np.allclose(window.t_s, window["k"] * DT_S, rtol=0, atol=1e-12)


def test_a_window_within_one_step_keeps_its_step():
    """Nothing is thinned that need not be."""
    waveforms = record(np.arange(40000) * 1.0, (0, 1), (16000, 8))
    assert len(window_on_one_grid(waveforms, 1000 * DT_S, 2000 * DT_S)) == 1000


def test_a_window_outside_the_record_is_refused():
    """As `Waveforms.window` does."""
    with pytest.raises(MeasurementError, match="leaves the record"):
        window_on_one_grid(record(np.zeros(4000), (0, 1), (1600, 8)), 0.1, 0.5)
