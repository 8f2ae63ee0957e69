"""Fundamental frequency from the turning of the positive-sequence phasor."""

import math
from collections.abc import Callable

import numpy as np

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.fourier import AMPLITUDE_FLOOR, ComplexSamples, turning
from pvlvrt_compliance.measure.sliding import steady_average_at
from pvlvrt_compliance.space_vectors import SQRT2_3, clarke
from pvlvrt_compliance.waveforms.container import Samples, Segment, Waveforms

_SETTLED_HZ = 1e-6
_ITERATIONS = 20
_ANGLES_A_CYCLE = 16
_LONGEST_S = 0.5

Found = Callable[[Segment, float, str, float], float | None]
"""Segment, nominal frequency (Hz), kind and floor: the frequency (Hz), None where there is none."""


def fundamental_frequency(
    segment: Segment,
    nominal_hz: float,
    kind: str = "u",
    floor: float = AMPLITUDE_FLOOR,
    by: Found | None = None,
) -> float:
    """Frequency (Hz) of the positive sequence, mean over a segment.

    The one-cycle phasor of the positive sequence stands still when the frequency assumed is the true one; its turning
    corrects the assumption until it does. Exact for a steady periodic record with unbalance and harmonics.

    Parameters
    ----------
    segment : Segment
        One and a half cycles at least.
    nominal_hz : float
        Where the search starts (Hz); the result lies within half of it on either side.
    kind : str
        ``u``, ``u0`` or ``i``.
    floor : float
        Least amplitude of the positive sequence (V or A, peak).
    by : function, optional
        Does the same in place of numpy, and gives None where it finds none.

    Raises
    ------
    MeasurementError
        When there is no voltage (or current), too short a segment, a missing channel or no frequency to settle on.
    """
    if by is not None and (found := by(segment, nominal_hz, kind, floor)) is not None:
        return found
    vector = clarke(*segment.three_phase(kind))
    frequency_hz = nominal_hz
    for _ in range(_ITERATIONS):
        correction_hz = _turning_hz(vector, segment.dt_s, frequency_hz, floor)
        frequency_hz += correction_hz
        if not abs(frequency_hz - nominal_hz) <= 0.5 * nominal_hz:
            break
        if abs(correction_hz) < _SETTLED_HZ:
            return frequency_hz
    raise MeasurementError(f"no steady frequency near {nominal_hz:g} Hz")


def _turning_hz(vector: ComplexSamples, dt_s: float, frequency_hz: float, floor: float) -> float:
    cycle = 1 / (frequency_hz * dt_s)
    if len(vector) - math.ceil(cycle) - 1 < 0.45 * cycle:
        raise MeasurementError("the record is too short to measure its frequency: under one and a half cycles")
    stride = max(int(cycle / _ANGLES_A_CYCLE), 1)
    at = np.arange(math.ceil(cycle) + 1, len(vector), stride)
    # SQRT2_3 / 2 of the space vector's own phasor, twice the average, is Fortescue's positive sequence of the phases.
    positive = steady_average_at(vector * turning(len(vector), dt_s, frequency_hz), cycle, at, SQRT2_3)
    if not np.abs(positive).min() >= floor:
        raise MeasurementError("no voltage or current to measure the frequency of")
    angle = np.unwrap(np.angle(positive))
    k = np.arange(len(angle)) - 0.5 * (len(angle) - 1)
    return float((angle @ k) / (k @ k) / (2 * np.pi * stride * dt_s))


def frequency_before(
    waveforms: Waveforms,
    start_s: float,
    nominal_hz: float,
    floor: float = AMPLITUDE_FLOOR,
    by: Found | None = None,
) -> float:
    """Frequency (Hz) of the voltages just before an instant: what windows and Fourier components of a record go by.

    From the last half second, or what the record has of it at one sampling step; ``by`` as in
    `fundamental_frequency`.

    Raises
    ------
    MeasurementError
        When the record before ``start_s`` has no voltage, or is shorter than one and a half cycles.
    """
    for segment in reversed(waveforms.segments):
        piece = segment.slice(start_s - _LONGEST_S, start_s)
        if len(piece) * piece.dt_s * nominal_hz >= 2:
            return fundamental_frequency(piece, nominal_hz, "u", floor, by)
    raise MeasurementError(f"the record before {start_s:.3f} s is too short to measure its frequency")


def rocof_hz_s(t_s: Samples, frequency_hz: Samples, window_s: float) -> Samples:
    """Rate of change of frequency, mean over the window that ends at each instant.

    (f(t) - f(t - W)) / W, straight lines between the samples. Half a window late, besides the delay of f.

    Parameters
    ----------
    t_s, frequency_hz : array, shape (n,)
        Instants (s), rising, and the frequency at them (Hz), as `tracked_frequency` gives it.
    window_s : float
        Length W of the window (s); what a code states with its limit.

    Returns
    -------
    array, shape (n,)
        Rate (Hz/s); NaN during the first window, and where the frequency is not known at both ends.

    Raises
    ------
    MeasurementError
        When the window is not above zero.
    """
    if not window_s > 0:
        raise MeasurementError(f"a window of {window_s:g} s has no rate of change")
    past = np.interp(t_s - window_s, t_s, frequency_hz, left=np.nan)
    return (frequency_hz - past) / window_s
