"""Instantaneous active and reactive power, and current and power of each sequence.

Signs are those of a generator. In phasors of a sequence, S = 3/2 U conj(I) with peak values.
"""

from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.measure.fourier import AMPLITUDE_FLOOR, ComplexSamples
from pvlvrt_compliance.space_vectors import Sequences, clarke
from pvlvrt_compliance.waveforms.container import Samples, Segment


class Power(NamedTuple):
    """Instantaneous powers, generator sign, shape (n,)."""

    p: Samples  # active (W)
    q: Samples  # reactive (var), positive with the current behind the voltage


class SequenceCurrent(NamedTuple):
    """Current of a sequence along its voltage and across it, A peak, shape (n,)."""

    active: Samples
    reactive: Samples


class SequencePowers(NamedTuple):
    """Powers of the sequences, shape (n,); the sums are the means of `instantaneous_power` over a cycle."""

    positive: Power
    negative: Power


def instantaneous_power(segment: Segment) -> Power:
    """Powers that flow to the grid at each sample: p + jq = u conj(i), eqs (2) and (3) of the paper.

    Raises
    ------
    MeasurementError
        When a voltage or a current is missing.
    """
    s = clarke(*segment.three_phase("u")) * clarke(*segment.three_phase("i")).conj()
    return Power(p=s.real, q=s.imag)


def sequence_current(u: ComplexSamples, i: ComplexSamples, floor: float = AMPLITUDE_FLOOR) -> SequenceCurrent:
    """Active and reactive current of the positive sequence, I_active + j I_reactive = U+ conj(I+) / |U+|.

    Active current delivers power. Reactive current is positive when the current lags the voltage, eq (3) of the
    paper: it raises |U+| behind an inductive grid, as a capacitor would.

    Parameters
    ----------
    u, i : array, shape (n,)
        Phasors of the positive sequence (V and A, peak), of one reference angle: both from `sequence_phasors` or both
        from `tracked_sequences`.
    floor : float
        Amplitude of the voltage (V, peak) below which there is no direction; NaN there.

    Returns
    -------
    SequenceCurrent
        A peak; not a number where a phasor is not.
    """
    amplitude = np.abs(u)
    power = u * i.conj()
    per_volt = np.divide(1.0, amplitude, out=np.full(amplitude.shape, np.nan), where=amplitude >= floor)
    return SequenceCurrent(active=power.real * per_volt, reactive=power.imag * per_volt)


def negative_sequence_current(u: ComplexSamples, i: ComplexSamples, floor: float = AMPLITUDE_FLOOR) -> SequenceCurrent:
    """Active and reactive current of the negative sequence, I_active - j I_reactive = U- conj(I-) / |U-|.

    The sign of the reactive current is the opposite of the positive sequence's: behind a grid of reactance X,
    U- = E- + j X I-, so that a current of I- = j k U-/|U-|, ahead of U-, lowers |U-| by k X. That current reads
    I_reactive = k > 0: the inverter absorbs reactive power of the negative sequence, as support in both sequences
    asks for (NTS 631, K2). With this sign Q- adds to the Q of eq (3).

    Parameters and returns as `sequence_current`, with phasors of the negative sequence (Fortescue's).
    """
    active, reactive = sequence_current(u, i, floor)
    return SequenceCurrent(active=active, reactive=-reactive)


def sequence_powers(u: Sequences, i: Sequences) -> SequencePowers:
    """P and Q of positive and negative sequence: 3/2 |U| times its active and its reactive current.

    P+ + jQ+ = 3/2 U+ conj(I+), P- + jQ- = 3/2 conj(U-) I-. Sign of each as of its reactive current, so that P+ + P- and
    Q+ + Q- are the mean of p and of q by eqs (2) and (3); the zero sequence carries nothing in three wires.

    Parameters
    ----------
    u, i : Sequences
        Voltages (V, peak) and currents (A, peak) of one reference angle.

    Returns
    -------
    SequencePowers
        Active (W) and reactive power (var) of each, shape (n,).
    """
    positive, negative = 1.5 * u.positive * i.positive.conj(), 1.5 * u.negative.conj() * i.negative
    return SequencePowers(Power(positive.real, positive.imag), Power(negative.real, negative.imag))
