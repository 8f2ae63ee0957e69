"""Series that several checks need, each made from the record once."""

from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.disturbance.model import Disturbance
from pvlvrt_compliance.evidence.instruments import BY_DEFINITION, Instruments
from pvlvrt_compliance.measure.fourier import ComplexSamples
from pvlvrt_compliance.measure.frequency import frequency_before
from pvlvrt_compliance.measure.power import (
    Power,
    SequenceCurrent,
    instantaneous_power,
    negative_sequence_current,
    sequence_current,
)
from pvlvrt_compliance.measure.sliding import Frequency
from pvlvrt_compliance.measure.tracking import steering_frequency
from pvlvrt_compliance.profile.thresholds import STANDARD_THRESHOLDS, Thresholds
from pvlvrt_compliance.space_vectors import SQRT2_3, Sequences, clarke, phases
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Samples, Segment, Waveforms, phase_channels
from pvlvrt_compliance.waveforms.joining import one_cycle_series

Mask = NDArray[np.bool_]
Made = TypeVar("Made")

_SAME_INSTANT_S = 1e-9
_AT_A_TIME = 4096  # samples: what is made of so many on the way stays in the processor's own memory
_TRACKING_CYCLES = 4  # that a tracked frequency rests on, and settles in
_STEERING_CYCLES = 8  # that the frequency of one-cycle windows rests on, and settles in


@dataclass(frozen=True, eq=False, kw_only=True)
class Series:
    """Series of one record: one value a sample, all segments joined.

    One-cycle series are NaN in the first cycle of the record, and after a change to a sampling step that does not fit
    the one before (`waveforms.joining`).

    Parameters
    ----------
    waveforms : Waveforms
        The record.
    nominal : Nominal
        Base of the per-unit values.
    disturbance : Disturbance
        What the grid did.
    thresholds : Thresholds
        Floors of measurement.
    instruments : Instruments
        What one-cycle series are measured with.
    """

    waveforms: Waveforms
    nominal: Nominal
    disturbance: Disturbance
    thresholds: Thresholds = STANDARD_THRESHOLDS
    instruments: Instruments = BY_DEFINITION

    @cached_property
    def frequency_hz(self) -> float:
        """Fundamental frequency, measured before the disturbance (Hz)."""
        return frequency_before(self.waveforms, self.disturbance.start_s, self.nominal.frequency_hz, self._floor_v)

    @cached_property
    def t_s(self) -> Samples:
        """Time of each sample (s), shape (n,)."""
        return self.joined(lambda segment: segment.t_s)

    @cached_property
    def step_s(self) -> Samples:
        """Sampling step at each sample (s), by which it counts in what is taken over time, shape (n,)."""
        return self.joined(lambda segment: np.full(len(segment), segment.dt_s))

    @cached_property
    def voltage_positive_pu(self) -> Samples:
        """One-cycle V+ at the terminals, shape (n,)."""
        return self.sequence_pu("u", 0)

    @cached_property
    def voltage_negative_pu(self) -> Samples:
        """One-cycle V- at the terminals, shape (n,)."""
        return self.sequence_pu("u", 1)

    @cached_property
    def voltage_phasors_pu(self) -> ComplexSamples:
        """One-cycle phasors of the phase-to-neutral voltages at the terminals, shape (3, n)."""
        return self._phases_pu("u", self.nominal.phase_voltage_peak_v)

    @cached_property
    def no_load_phasors_pu(self) -> ComplexSamples | None:
        """The same of the source without the inverter's current, None in a record that has no such voltages."""
        if "u0_a_v" not in self.waveforms.names:
            return None
        return self._phases_pu("u0", self.nominal.phase_voltage_peak_v)

    @cached_property
    def tracked_frequency_hz(self) -> Samples:
        """Frequency of the positive sequence as it changes, NaN in the first two cycles, shape (n,).

        Of the source where the record has its voltages: behind an impedance its current turns the terminals'.
        """
        kind = "u0" if "u0_a_v" in self.waveforms.names else "u"
        tracked, nominal_hz = self.instruments.tracked_frequency, self.nominal.frequency_hz
        return self._of_cycles(
            lambda segment: tracked(segment, nominal_hz, kind, self._floor_v), _TRACKING_CYCLES, (kind,)
        )

    @cached_property
    def current_phase_pu(self) -> Samples:
        """One-cycle fundamental amplitudes of the phase currents, shape (3, n)."""
        return np.abs(self._phases_pu("i", self.nominal.phase_current_peak_a))

    @cached_property
    def reactive_current_pu(self) -> Samples:
        """One-cycle reactive current of the positive sequence, above 0 when it delivers reactive power, shape (n,).

        0 where there is no voltage for it to be measured along.
        """
        no_voltage = self.voltage_positive_pu < self.thresholds.voltage_floor_pu.value
        return np.where(no_voltage, 0.0, self.current_positive_pu.reactive)

    @cached_property
    def reactive_current_negative_pu(self) -> Samples:
        """One-cycle reactive current of the negative sequence, above 0 when it lowers V-, shape (n,).

        0 where V- is too little for it to be measured along: that V- passes through zero is no fault of anything.
        """
        no_voltage = self.voltage_negative_pu < self.thresholds.voltage_floor_pu.value
        return np.where(no_voltage, 0.0, self.current_negative_pu.reactive)

    @cached_property
    def reactive_share(self) -> Samples:
        """Share of the reactive current in the positive sequence's, shape (n,); NaN without voltage or current."""
        active, reactive = self.current_positive_pu
        total = np.hypot(active, reactive)
        return np.divide(reactive, total, out=np.full_like(total, np.nan), where=total > 0)

    @cached_property
    def current_pu(self) -> Samples:
        """Instantaneous phase currents, shape (3, n)."""
        return self.joined(lambda segment: np.stack(segment.three_phase("i"))) / self.nominal.phase_current_peak_a

    @cached_property
    def voltage_pu(self) -> Samples:
        """Instantaneous phase-to-neutral voltages at the terminals, shape (3, n)."""
        return self.joined(lambda segment: np.stack(segment.three_phase("u"))) / self.nominal.phase_voltage_peak_v

    @cached_property
    def current_positive_pu(self) -> SequenceCurrent:
        """One-cycle active and reactive current of the positive sequence, shape (n,) each; NaN without voltage."""
        return self._sequence_current_pu(0, sequence_current)

    @cached_property
    def current_negative_pu(self) -> SequenceCurrent:
        """One-cycle active and reactive current of the negative sequence, shape (n,) each; NaN without voltage."""
        return self._sequence_current_pu(1, negative_sequence_current)

    @cached_property
    def active_power_kw(self) -> Samples:
        """One-cycle mean of P, shape (n,)."""
        return self._mean_powers.p / 1e3

    @cached_property
    def reactive_power_kvar(self) -> Samples:
        """One-cycle mean of Q, shape (n,)."""
        return self._mean_powers.q / 1e3

    @cached_property
    def _mean_powers(self) -> Power:
        """One-cycle means of P (W) and Q (var)."""
        return Power(*self._windowed(self.instruments.mean_powers, "ui"))

    @cached_property
    def half_cycle_kva(self) -> Power:
        """Half-cycle means of P (kW) and Q (kvar), which leave out what swings at 2f and its multiples, shape (n,)."""
        mean_powers = self.instruments.mean_powers
        return Power(*self._windowed(lambda segment, window_hz: mean_powers(segment, 2 * window_hz), "ui") / 1e3)

    @cached_property
    def instantaneous_kva(self) -> Power:
        """Instantaneous P (kW) and Q (kvar), shape (n,) each."""
        return Power(*self.joined(lambda segment: np.stack(instantaneous_power(segment))) / 1e3)

    @cached_property
    def dc_voltage_v(self) -> Samples:
        """DC voltage (V), shape (n,)."""
        return self.joined(lambda segment: segment["v_dc_v"])

    @cached_property
    def array_power_kw(self) -> Samples:
        """Power of the PV array (kW), shape (n,)."""
        return self.joined(lambda segment: segment["v_dc_v"] * segment["i_pv_a"]) / 1e3

    @cached_property
    def current_vector_pu(self) -> ComplexSamples:
        """Space vector of the current, as long as the amplitude of a balanced one, shape (n,)."""
        return np.asarray(SQRT2_3 * clarke(*self.current_pu), dtype=np.complex128)

    def once(self, key: Hashable, make: Callable[[], Made]) -> Made:
        """What a function makes of the record, made when it is first asked for by its key."""
        if key not in self._made:
            self._made[key] = make()
        found: Made = self._made[key]
        return found

    @cached_property
    def _made(self) -> dict[Hashable, Any]:
        return {}

    def forget(self) -> None:
        """Let go of all that was made of the record, once nobody asks for more: some refers back to the record."""
        self._made.clear()

    def between(self, start_s: float, end_s: float) -> Mask:
        """Mask of the samples from one instant to another, both included, shape (n,)."""
        mask = np.zeros(len(self.t_s), dtype=np.bool_)
        first = np.searchsorted(self.t_s, start_s - _SAME_INSTANT_S)
        mask[first : np.searchsorted(self.t_s, end_s + _SAME_INSTANT_S, side="right")] = True
        return mask

    def sequence_pu(self, kind: str, index: int) -> Samples:
        """One-cycle amplitude of a sequence (0 positive, 1 negative) of the voltages ``u`` or ``u0``, shape (n,)."""
        return self.once(
            ("sequence_pu", kind, index),
            lambda: np.abs(self._sequences(kind)[index]) / self.nominal.phase_voltage_peak_v,
        )

    def joined(self, series: Callable[[Segment], Samples]) -> Samples:
        """What a function makes of each segment, one after the other, shape (..., n)."""
        parts = [series(segment) for segment in self.waveforms]
        return np.concatenate(parts, axis=-1) if len(parts) > 1 else parts[0]

    def _of_cycles(self, series: Callable[[Segment], NDArray[Any]], cycles: int, kinds: Iterable[str]) -> NDArray[Any]:
        """What a function makes of quantities of some kinds in the cycles that end at each sample, shape (..., n)."""
        channels = [name for kind in kinds for name in phase_channels(kind)]
        parts = one_cycle_series(self.waveforms, series, self.frequency_hz, cycles, channels)
        return np.concatenate(parts, axis=-1) if len(parts) > 1 else parts[0]

    def _sequence_current_pu(self, index: int, split: Callable[..., SequenceCurrent]) -> SequenceCurrent:
        found = split(self._sequences("u")[index], self._sequences("i")[index], self._floor_v)
        return SequenceCurrent(*(x / self.nominal.phase_current_peak_a for x in found))

    def _phases_pu(self, kind: str, base: float) -> ComplexSamples:
        """One-cycle phasors of the phases by a base, shape (3, n)."""
        sequences = self._sequences(kind)
        found = np.empty((3, len(sequences.zero)), dtype=np.complex128)
        for begin in range(0, found.shape[1], _AT_A_TIME):
            part = slice(begin, begin + _AT_A_TIME)
            found[:, part] = phases(*(phasor[part] for phasor in sequences))
        found.view(np.float64)[...] /= base
        return found

    def _sequences(self, kind: str) -> Sequences:
        """One-cycle phasors of the sequences, peak values in V or A; angles of the same sample can be compared."""
        if kind not in self._found:
            phasors = self.instruments.sequence_phasors
            self._found[kind] = Sequences(
                *self._windowed(lambda segment, window_hz: phasors(segment, kind, window_hz), (kind,))
            )
        return self._found[kind]

    @property
    def _floor_v(self) -> float:
        """Amplitude below which a voltage has no angle to speak of (V, peak)."""
        return self.thresholds.voltage_floor_pu.value * self.nominal.phase_voltage_peak_v

    @cached_property
    def _found(self) -> dict[str, Sequences]:
        return {}

    @property
    def _is_steady(self) -> bool:
        """Whether the grid keeps its frequency: one-cycle windows go by the one before the disturbance then."""
        return not self.disturbance.frequency_moves

    def _steered_hz(self, segment: Segment) -> Samples:
        """Frequency that one-cycle windows go by where it moves (Hz), shape (n,)."""

        def steered() -> Samples:
            tracked, nominal_hz = self.instruments.tracked_frequency, self.nominal.frequency_hz
            return steering_frequency(segment, "u", nominal_hz, self._floor_v, tracked)[0]

        # The same parts of the record are asked for by every series.
        return self.once(("steered", segment.t0_s, segment.dt_s, len(segment)), steered)

    def _windowed(self, series: Callable[[Segment, Frequency], NDArray[Any]], kinds: Iterable[str]) -> NDArray[Any]:
        """What a function makes of the cycle that ends at each sample, from quantities of some kinds."""
        if self._is_steady:
            return self._of_cycles(lambda segment: series(segment, self.frequency_hz), 1, kinds)
        return self._of_cycles(
            lambda segment: series(segment, self._steered_hz(segment)), _STEERING_CYCLES, {*kinds, "u"}
        )
