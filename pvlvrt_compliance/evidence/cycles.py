"""What series of a record are made with: its cycles, by what instruments there are, each sweep made once."""

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
from pvlvrt_compliance.measure.power import Power, SequenceCurrent, sequence_current
from pvlvrt_compliance.measure.sliding import Frequency
from pvlvrt_compliance.measure.tracking import steering_frequency
from pvlvrt_compliance.profile.thresholds import STANDARD_THRESHOLDS, Thresholds
from pvlvrt_compliance.space_vectors import Sequences, phases
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Samples, Segment, Waveforms, phase_channels
from pvlvrt_compliance.waveforms.joining import one_cycle_series

Made = TypeVar("Made")

_AT_A_TIME = 4096  # samples: what is made of so many on the way stays in the processor's own memory
_TRACKING_CYCLES = 4  # that a tracked frequency rests on, and settles in
_STEERING_CYCLES = 8  # that the frequency of one-cycle windows rests on, and settles in


@dataclass(frozen=True, eq=False, kw_only=True)
class Cycles:
    """The cycles of one record: what is measured in the one that ends at each sample, all segments joined.

    Parameters
    ----------
    waveforms, nominal, disturbance, thresholds, instruments
        As `Series` has them.
    """

    waveforms: Waveforms
    nominal: Nominal
    disturbance: Disturbance
    thresholds: Thresholds = STANDARD_THRESHOLDS
    instruments: Instruments = BY_DEFINITION

    @cached_property
    def frequency_hz(self) -> float:
        """Fundamental frequency, measured before the disturbance (Hz)."""
        start_s, nominal_hz = self.disturbance.start_s, self.nominal.frequency_hz
        return frequency_before(self.waveforms, start_s, nominal_hz, self._floor_v, self.instruments.windows.frequency)

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

    def joined(self, series: Callable[[Segment], Samples]) -> Samples:
        """What a function makes of each segment, one after the other, shape (..., n)."""
        parts = [series(segment) for segment in self.waveforms]
        return np.concatenate(parts, axis=-1) if len(parts) > 1 else parts[0]

    def _of_cycles(self, series: Callable[[Segment], NDArray[Any]], cycles: int, kinds: Iterable[str]) -> NDArray[Any]:
        """What a function makes of quantities of some kinds in the cycles that end at each sample, shape (..., n)."""
        channels = [name for kind in kinds for name in phase_channels(kind)]
        parts = one_cycle_series(self.waveforms, series, self.frequency_hz, cycles, channels)
        return np.concatenate(parts, axis=-1) if len(parts) > 1 else parts[0]

    def _sequence_current_pu(self, index: int) -> SequenceCurrent:
        """Current of a sequence along its voltage and across it, as `measure.power.sequence_current` has it."""
        measured = self.instruments.sequence_current
        floor_v, base = self._floor_v, self._base("i")
        if measured is None:
            found = np.stack(sequence_current(self._sequences("u")[index], self._sequences("i")[index], floor_v))
            found /= base
        else:
            found = self._windowed(lambda segment, hz: measured(segment, index, hz, floor_v, base), "ui")
        return SequenceCurrent(*found)

    def _sequence_amplitude_pu(self, kind: str, index: int) -> Samples:
        """One-cycle amplitude of a sequence, shape (n,)."""
        amplitudes = self.instruments.sequence_amplitudes
        found: Samples
        if amplitudes is None or index > 1:
            found = np.abs(self._sequences(kind)[index])
            found /= self._base(kind)
        else:
            found = self.once(("sequence_amplitudes", kind), lambda: self._amplitudes_pu(amplitudes, kind))[index]
        return found

    def _phase_amplitudes_pu(self, kind: str) -> Samples:
        """One-cycle amplitudes of the phases, shape (3, n)."""
        amplitudes = self.instruments.phase_amplitudes
        if amplitudes is not None:
            return self._amplitudes_pu(amplitudes, kind)
        return np.abs(self._phasors_pu(kind) if kind == "i" else self.voltage_phasors_of_pu(kind))

    def voltage_phasors_of_pu(self, kind: str) -> ComplexSamples:
        """One-cycle phasors of the phases of the voltages ``u`` or ``u0``, shape (3, n)."""
        return self.once(("phasors_pu", kind), lambda: self._phasors_pu(kind))

    def _phasors_pu(self, kind: str) -> ComplexSamples:
        """One-cycle phasors of the phases, shape (3, n)."""
        sequences = self._sequences(kind)
        found = np.empty((3, len(sequences.zero)), dtype=np.complex128)
        for begin in range(0, found.shape[1], _AT_A_TIME):
            part = slice(begin, begin + _AT_A_TIME)
            found[:, part] = phases(*(phasor[part] for phasor in sequences))
        found.view(np.float64)[...] /= self._base(kind)
        return found

    def _sequences(self, kind: str) -> Sequences:
        """One-cycle phasors of the sequences, peak values in V or A; angles of the same sample can be compared."""
        phasors = self.instruments.sequence_phasors
        return self.once(("sequences", kind), lambda: Sequences(*self._of_kind(phasors, kind)))

    def _mean_powers_kva(self, times: int = 1) -> Power:
        """Means of P (kW) and Q (kvar) over one cycle of a multiple of the frequency."""
        measured = self.instruments.mean_powers
        return self.once(
            ("mean_powers_kva", times),
            lambda: Power(*self._windowed(lambda segment, hz: measured(segment, times * hz, 1e3), "ui")),
        )

    def _tracked_frequency_hz(self, kind: str) -> Samples:
        """Frequency of the positive sequence of some voltages, NaN in the first two cycles, shape (n,)."""
        tracked, nominal_hz = self.instruments.tracked_frequency, self.nominal.frequency_hz
        return self._of_cycles(
            lambda segment: tracked(segment, nominal_hz, kind, self._floor_v), _TRACKING_CYCLES, (kind,)
        )

    def _base(self, kind: str) -> float:
        """What 1 pu of a kind is (V or A, peak)."""
        return self.nominal.phase_current_peak_a if kind == "i" else self.nominal.phase_voltage_peak_v

    @property
    def _floor_v(self) -> float:
        """Amplitude below which a voltage has no angle to speak of (V, peak)."""
        return self.thresholds.voltage_floor_pu.value * self.nominal.phase_voltage_peak_v

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

    def _of_kind(self, measured: Callable[[Segment, str, Frequency], NDArray[Any]], kind: str) -> NDArray[Any]:
        """What a function makes of the cycle that ends at each sample of one kind of quantity."""
        return self._windowed(lambda segment, window_hz: measured(segment, kind, window_hz), (kind,))

    def _amplitudes_pu(self, measured: Callable[[Segment, str, Frequency, float], Samples], kind: str) -> Samples:
        """The same of amplitudes (pu)."""
        base = self._base(kind)
        return self._windowed(lambda segment, window_hz: measured(segment, kind, window_hz, base), (kind,))
