"""Frequency at each sample, and sequence phasors whose window follows it.

Delays. The frequency is the mean turning of a one-cycle phasor over one cycle: it rests on the last two cycles and is
one cycle late on a ramp. The phasors rest on the last cycle and are half a cycle late; the window that they are taken
with follows the frequency three and a half cycles late, which matters to second order only.
"""

import math
from bisect import bisect_left, insort
from collections.abc import Callable

import numpy as np

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.fourier import (
    AMPLITUDE_FLOOR,
    ComplexSamples,
    one_cycle_phasor,
    turning,
)
from pvlvrt_compliance.measure.sequences import sequence_phasors
from pvlvrt_compliance.measure.sliding import CycleWindows, Frequency, running_integral
from pvlvrt_compliance.space_vectors import SQRT2_3, Sequences, clarke
from pvlvrt_compliance.waveforms.container import Samples, Segment

RANGE = 0.25
"""How far from nominal a frequency is followed, as a fraction of nominal; beyond, the estimate stays at the bound."""

# Each pass leaves a few per cent of the error of what it starts from: 3 Hz become under 1 mHz.
_PASSES = 3
# An event spoils two cycles of the frequency; the median of five does not see them.
_STEERING_CYCLES = 5
_STEERING_A_CYCLE = 16


def tracked_frequency(segment: Segment, nominal_hz: float, kind: str = "u", floor: float = AMPLITUDE_FLOOR) -> Samples:
    """Frequency (Hz) of the positive sequence at each sample, causal.

    f(t) = (theta(t) - theta(t - T)) / (2 pi T), theta the angle of the positive sequence in the cycle that ends at t.
    That cycle is counted by an assumed frequency, nominal at first and then the estimate itself, so that unbalance and
    harmonics leave nothing in a steady state. Rests on the two cycles before t; one cycle late on a ramp. An event is
    seen as it is: a phase jump by a turns the estimate by a / (2 pi T) for up to two cycles.

    Parameters
    ----------
    segment : Segment
        Uniformly sampled record.
    nominal_hz : float
        Nominal frequency (Hz); frequencies within `RANGE` of it are followed.
    kind : str
        ``u``, ``u0`` or ``i``.
    floor : float
        Amplitude of the positive sequence (V or A, peak) below which the last value is held.

    Returns
    -------
    array, shape (n,)
        Frequency (Hz); NaN for the first two cycles, until the positive sequence first exceeds the floor, and from a
        sample on that is not finite.

    Raises
    ------
    MeasurementError
        When a channel is missing, or a cycle has fewer than two samples.
    """
    # SQRT2_3 / 2 of the space vector's own phasor is Fortescue's positive sequence of the three phases' phasors.
    vector = SQRT2_3 / 2 * clarke(*segment.three_phase(kind))
    assumed: Frequency = nominal_hz
    tracked, since = np.full(len(vector), np.nan), 0
    for _ in range(_PASSES):
        found = _turning_hz(vector, segment.dt_s, nominal_hz, assumed, floor)
        known = np.flatnonzero(np.isfinite(found))
        if not len(known):
            return np.full(len(vector), np.nan)
        since = max(since, int(known[0]))
        # Before the first value nothing is reported, hence to assume that value there looks at no future.
        assumed = tracked = np.clip(
            _held(found, float(found[known[0]])), (1 - RANGE) * nominal_hz, (1 + RANGE) * nominal_hz
        )
    tracked[:since] = np.nan
    tracked[np.logical_or.accumulate(~np.isfinite(vector))] = np.nan
    return tracked


def _turning_hz(vector: ComplexSamples, dt_s: float, nominal_hz: float, assumed_hz: Frequency, floor: float) -> Samples:
    """Frequency from the turning over one cycle; NaN where it is not known."""
    positive, reference = _phasor_and_reference(vector, dt_s, nominal_hz, assumed_hz)
    cycle = np.broadcast_to(1 / (assumed_hz * dt_s), vector.shape)
    now = np.arange(len(vector))
    ago = np.maximum(now - np.rint(cycle).astype(np.intp), 0)
    # The phasor has the angle at the middle of its window, less the mean of the angle it was turned back by.
    middle_s = dt_s * (now - 0.5 * cycle)
    turned = np.angle(positive * positive[ago].conj()) + reference - reference[ago]
    amplitude = np.abs(positive)
    known = np.minimum(amplitude, amplitude[ago]) >= floor
    found = np.full(len(vector), np.nan)
    found[known] = nominal_hz + turned[known] / (2 * np.pi * (middle_s - middle_s[ago])[known])
    return found


def _phasor_and_reference(
    vector: ComplexSamples, dt_s: float, nominal_hz: float, assumed_hz: Frequency
) -> tuple[ComplexSamples, Samples]:
    """One-cycle phasor, and the mean angle over its cycle that it was turned back by besides nominal."""
    if not isinstance(assumed_hz, np.ndarray):
        return one_cycle_phasor(vector, dt_s, assumed_hz), np.zeros(len(vector))
    windows = CycleWindows(1 / (assumed_hz * dt_s))
    reference = windows.average(2 * np.pi * dt_s * running_integral(assumed_hz - nominal_hz))
    return windows.average(vector * turning(len(vector), dt_s, assumed_hz), 2.0), reference


def _held(x: Samples, before: float) -> Samples:
    """Last finite value at each sample, ``before`` where there was none yet; shape (n,)."""
    last = np.maximum.accumulate(np.where(np.isfinite(x), np.arange(len(x)), -1))
    return np.where(last >= 0, x[last], before)


def tracked_sequences(segment: Segment, kind: str, nominal_hz: float) -> Sequences:
    """Sequence phasors of the cycle that ends at each sample, the cycle being that of the measured frequency.

    X(t) = (2/T) integral of x exp(-j theta) over t - T .. t, dtheta/dt = 2 pi f, T = 1/f, and Fortescue's sequences of
    the three phases. f is the median of the last five cycles of `tracked_frequency` of the terminal voltages, the same
    for voltages and currents, whose phasors can thus be multiplied. In a record without terminal voltages it is that
    of the quantity itself. Half a cycle late, settled one cycle after a step. A frequency that changes is followed
    three and a half cycles late; meanwhile an error of df leaves up to about df/(2f) of each other sequence in one.

    Parameters
    ----------
    segment : Segment
        Uniformly sampled record.
    kind : str
        ``u`` or ``u0`` (V) or ``i`` (A).
    nominal_hz : float
        Nominal frequency (Hz); it counts where there was no voltage yet to measure a frequency on.

    Returns
    -------
    Sequences
        Peak values, shape (n,), angles referenced to the segment's first sample; NaN until there is a frequency: the
        first two cycles, and two and two thirds where there is no voltage.

    Raises
    ------
    MeasurementError
        When a channel is missing, or a cycle has fewer than two samples.
    """
    frequency_hz, since = steering_frequency(segment, kind, nominal_hz)
    phasors = sequence_phasors(segment, kind, frequency_hz)
    for phasor in phasors:
        phasor[:since] = np.nan * (1 + 1j)
    return phasors


def steering_frequency(
    segment: Segment,
    kind: str,
    nominal_hz: float,
    floor: float = AMPLITUDE_FLOOR,
    tracked: Callable[[Segment, float, str, float], Samples] = tracked_frequency,
) -> tuple[Samples, int]:
    """Frequency that one-cycle windows go by, and the sample from which they may be used.

    Median of the last five cycles of `tracked_frequency`, refreshed 16 times a cycle. Before the sample returned the
    values are assumed, so that every window after it is whole. Parameters and errors as `tracked_sequences`; ``floor``
    (V or A, peak) as `tracked_frequency`, or what stands in for it as ``tracked``.

    Returns
    -------
    tuple of array, shape (n,), and int
        Frequency (Hz), finite at every sample; index of the first sample that is measured.
    """
    try:
        measured = tracked(segment, nominal_hz, "u", floor)
    except MeasurementError:
        measured = tracked(segment, nominal_hz, kind, floor)
    cycle = 1 / (nominal_hz * segment.dt_s)
    latest = math.ceil(2 * cycle / (1 - RANGE)) + 4  # by then two cycles of any frequency have passed
    known = np.flatnonzero(np.isfinite(measured[:latest]))
    since = int(known[0]) if len(known) else latest
    held = _held(measured, float(measured[known[0]]) if len(known) else nominal_hz)
    return _running_median(held, max(int(cycle / _STEERING_A_CYCLE), 1)), since


def _running_median(x: Samples, stride: int) -> Samples:
    """Median of the values of five cycles, every ``stride`` samples; held in between, shape (n,)."""
    width = _STEERING_CYCLES * _STEERING_A_CYCLE
    thinned = np.pad(x[::stride], (width - 1, 0), mode="edge")
    return np.repeat(_sliding_median(thinned.tolist(), width), stride)[: len(x)]


def _sliding_median(x: list[float], width: int) -> list[float]:
    """Median of every ``width`` numbers in a row: they stay sorted while one comes and one goes."""
    ordered = sorted(x[:width])
    low, high = (width - 1) // 2, width // 2
    medians = [(ordered[low] + ordered[high]) / 2]
    for gone, new in zip(x, x[width:], strict=False):
        if new != gone:
            del ordered[bisect_left(ordered, gone)]
            insort(ordered, new)
        medians.append((ordered[low] + ordered[high]) / 2)
    return medians
