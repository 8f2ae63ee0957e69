"""Series that several checks need, each made from the record once."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.evidence.cycles import Cycles
from pvlvrt_compliance.measure.fourier import ComplexSamples
from pvlvrt_compliance.measure.power import Power, SequenceCurrent, instantaneous_power
from pvlvrt_compliance.space_vectors import SQRT2_3, clarke
from pvlvrt_compliance.waveforms.container import Samples

Mask = NDArray[np.bool_]

_SAME_INSTANT_S = 1e-9


@dataclass(frozen=True, eq=False, kw_only=True)
class Series(Cycles):
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

    @cached_property
    def t_s(self) -> Samples:
        """Time of each sample (s), shape (n,)."""
        return self.joined(lambda segment: segment.t_s)

    @cached_property
    def step_s(self) -> Samples:
        """Sampling step at each sample (s), by which it counts in what is taken over time, shape (n,)."""
        if len(self.waveforms.segments) > 1:
            return self.joined(lambda segment: np.full(len(segment), segment.dt_s))
        (segment,) = self.waveforms.segments
        return np.broadcast_to(segment.dt_s, len(segment))  # one number, which `measure.durations` sees

    @cached_property
    def voltage_positive_pu(self) -> Samples:
        """One-cycle V+ at the terminals, shape (n,)."""
        return self.sequence_pu("u", 0)

    @cached_property
    def voltage_negative_pu(self) -> Samples:
        """One-cycle V- at the terminals, shape (n,)."""
        return self.sequence_pu("u", 1)

    @property
    def voltage_phasors_pu(self) -> ComplexSamples:
        """One-cycle phasors of the phase-to-neutral voltages at the terminals, shape (3, n)."""
        return self.voltage_phasors_of_pu("u")

    @property
    def no_load_phasors_pu(self) -> ComplexSamples | None:
        """The same of the source without the inverter's current, None in a record that has no such voltages."""
        if "u0_a_v" not in self.waveforms.names:
            return None
        return self.voltage_phasors_of_pu("u0")

    @cached_property
    def tracked_frequency_hz(self) -> Samples:
        """Frequency of the positive sequence as it changes, NaN in the first two cycles, shape (n,).

        Of the source where the record has its voltages: behind an impedance its current turns the terminals'.
        """
        return self._tracked_frequency_hz("u0" if "u0_a_v" in self.waveforms.names else "u")

    @property
    def current_phase_pu(self) -> Samples:
        """One-cycle fundamental amplitudes of the phase currents, shape (3, n)."""
        return self.phase_amplitudes_pu("i")

    @cached_property
    def reactive_current_pu(self) -> Samples:
        """One-cycle reactive current of the positive sequence, above 0 when it delivers reactive power, shape (n,).

        0 where there is no voltage for it to be measured along.
        """
        return self._reactive_where_voltage(self.voltage_positive_pu, self.current_positive_pu.reactive)

    @cached_property
    def reactive_current_negative_pu(self) -> Samples:
        """One-cycle reactive current of the negative sequence, above 0 when it lowers V-, shape (n,).

        0 where V- is too little for it to be measured along: that V- passes through zero is no fault of anything.
        """
        return self._reactive_where_voltage(self.voltage_negative_pu, self.current_negative_pu.reactive)

    def _reactive_where_voltage(self, voltage_pu: Samples, reactive_pu: Samples) -> Samples:
        """A reactive current, 0 where its voltage is below the floor."""
        no_voltage = voltage_pu < self.thresholds.voltage_floor_pu.value
        return np.where(no_voltage, 0.0, reactive_pu) if no_voltage.any() else reactive_pu

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
        return self._sequence_current_pu(0)

    @cached_property
    def current_negative_pu(self) -> SequenceCurrent:
        """One-cycle active and reactive current of the negative sequence, shape (n,) each; NaN without voltage."""
        active, reactive = self._sequence_current_pu(1)
        return SequenceCurrent(active, -reactive)  # as `measure.power.negative_sequence_current` has it

    @property
    def active_power_kw(self) -> Samples:
        """One-cycle mean of P, shape (n,)."""
        return self._mean_powers_kva().p

    @property
    def reactive_power_kvar(self) -> Samples:
        """One-cycle mean of Q, shape (n,)."""
        return self._mean_powers_kva().q

    @property
    def half_cycle_kva(self) -> Power:
        """Half-cycle means of P (kW) and Q (kvar), which leave out what swings at 2f and its multiples, shape (n,)."""
        return self._mean_powers_kva(2)

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

    def between(self, start_s: float, end_s: float) -> Mask:
        """Mask of the samples from one instant to another, both included, shape (n,)."""
        mask = np.zeros(len(self.t_s), dtype=np.bool_)
        first = np.searchsorted(self.t_s, start_s - _SAME_INSTANT_S)
        mask[first : np.searchsorted(self.t_s, end_s + _SAME_INSTANT_S, side="right")] = True
        return mask

    def sequence_pu(self, kind: str, index: int) -> Samples:
        """One-cycle amplitude of a sequence (0 positive, 1 negative) of the voltages ``u`` or ``u0``, shape (n,)."""
        return self.once(("sequence_pu", kind, index), lambda: self._sequence_amplitude_pu(kind, index))

    def phase_amplitudes_pu(self, kind: str) -> Samples:
        """One-cycle fundamental amplitudes of the phases of ``u``, ``u0`` or ``i``, shape (3, n)."""
        return self.once(("phase_amplitudes_pu", kind), lambda: self._phase_amplitudes_pu(kind))
