"""What a check sees of one test: the record, its measurements and the series made from it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.fourier import ComplexSamples, one_cycle_mean
from pvlvrt_compliance.measure.frequency import frequency_before
from pvlvrt_compliance.measure.power import VOLTAGE_FLOOR_V, instantaneous_power, sequence_current
from pvlvrt_compliance.measure.quantities import Measurements, WindowMeasurements
from pvlvrt_compliance.measure.sequences import phase_amplitudes, sequence_phasors
from pvlvrt_compliance.measure.tracking import tracked_frequency
from pvlvrt_compliance.measure.windows import Span, WindowRules, standard_windows
from pvlvrt_compliance.profile.procedure import Detection
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.timeline import asked_sequences_pu
from pvlvrt_compliance.space_vectors import phases
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Samples, Segment, Waveforms
from pvlvrt_compliance.waveforms.joining import one_cycle_series, window_on_one_grid

Mask = NDArray[np.bool_]

_SAME_INSTANT_S = 1e-9
_TRACKING_CYCLES = 4  # that a tracked frequency rests on, and settles in


class NotApplicable(Exception):  # noqa: N818 - it is a verdict, not an error
    """Raised by a check that the code lets off in this test; the text is the reason."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """One record with what is known about its test.

    Series have one value a sample of the record, all segments joined. One-cycle series are NaN in the first cycle of
    the record, and after a change to a sampling step that does not fit the one before (`waveforms.joining`).

    Parameters
    ----------
    waveforms : Waveforms
        The record.
    nominal : Nominal
        Base of the per-unit values.
    scenario : Scenario
        What was asked of the grid; its times count from the start of the record.
    available_power_w : float
        What the PV array could give before the sag (W).
    measurements : Measurements
        Of the windows before, during and after the sag.
    rules : WindowRules
        Where those windows lie.
    blocked_below_pu : float
        Phase currents that all stay below this to the end of the record show a blocked bridge (pu).
    k_factor : float, optional
        K that this test was run with, in place of the requirement's.
    detection : Detection, optional
        The profile's thresholds of a voltage event.
    """

    waveforms: Waveforms
    nominal: Nominal
    scenario: Scenario
    available_power_w: float
    measurements: Measurements
    rules: WindowRules
    blocked_below_pu: float
    k_factor: float | None = None
    detection: Detection | None = None

    @cached_property
    def frequency_hz(self) -> float:
        """Fundamental frequency, measured before the sag (Hz)."""
        return frequency_before(self.waveforms, self.scenario.start_s, self.nominal.frequency_hz)

    @cached_property
    def t_s(self) -> Samples:
        """Time of each sample (s), shape (n,)."""
        return self._joined(lambda segment: segment.t_s)

    @cached_property
    def step_s(self) -> Samples:
        """Sampling step at each sample (s), by which it counts in what is taken over time, shape (n,)."""
        return self._joined(lambda segment: np.full(len(segment), segment.dt_s))

    @cached_property
    def voltage_positive_pu(self) -> Samples:
        """One-cycle V+ at the terminals, shape (n,)."""
        return self._sequence_pu("u", 0)

    @cached_property
    def voltage_negative_pu(self) -> Samples:
        """One-cycle V- at the terminals, shape (n,)."""
        return self._sequence_pu("u", 1)

    @cached_property
    def voltage_phasors_pu(self) -> ComplexSamples:
        """One-cycle phasors of the phase-to-neutral voltages at the terminals, shape (3, n)."""
        return self._phasors_pu("u")

    @cached_property
    def no_load_phasors_pu(self) -> ComplexSamples | None:
        """The same of the source without the inverter's current, None in a record that has no such voltages."""
        return self._phasors_pu("u0") if "u0_a_v" in self.waveforms.names else None

    @cached_property
    def tracked_frequency_hz(self) -> Samples:
        """Frequency of the positive sequence as it changes, NaN in the first two cycles, shape (n,).

        Of the source where the record has its voltages: behind an impedance its current turns the terminals'.
        """
        kind = "u0" if "u0_a_v" in self.waveforms.names else "u"
        found: Samples = self._one_cycle(
            lambda segment: tracked_frequency(segment, self.nominal.frequency_hz, kind), _TRACKING_CYCLES
        )
        return found

    @cached_property
    def current_phase_pu(self) -> Samples:
        """One-cycle fundamental amplitudes of the phase currents, shape (3, n)."""
        base = self.nominal.phase_current_peak_a
        return self._one_cycle(lambda segment: phase_amplitudes(segment, "i", self.frequency_hz) / base)

    @cached_property
    def reactive_current_pu(self) -> Samples:
        """One-cycle reactive current of the positive sequence, above 0 when it delivers reactive power, shape (n,).

        0 where there is no voltage for it to be measured along.
        """
        return self._one_cycle(self._reactive_current_a) / self.nominal.phase_current_peak_a

    @cached_property
    def current_pu(self) -> Samples:
        """Instantaneous phase currents, shape (3, n)."""
        return self._joined(lambda segment: np.stack(segment.three_phase("i"))) / self.nominal.phase_current_peak_a

    @cached_property
    def active_power_kw(self) -> Samples:
        """One-cycle mean of P, shape (n,)."""
        return self._one_cycle(lambda segment: self._cycle_mean(segment, instantaneous_power(segment).p)) / 1e3

    @cached_property
    def reactive_power_kvar(self) -> Samples:
        """One-cycle mean of Q, shape (n,)."""
        return self._one_cycle(lambda segment: self._cycle_mean(segment, instantaneous_power(segment).q)) / 1e3

    @cached_property
    def dc_voltage_v(self) -> Samples:
        """DC voltage (V), shape (n,)."""
        return self._joined(lambda segment: segment["v_dc_v"])

    @cached_property
    def disconnected_at_s(self) -> float | None:
        """First instant the breaker is open (s), None when it never opens.

        Raises
        ------
        MeasurementError
            When the record does not say, or not everywhere.
        """
        connected = require_finite(self._joined(lambda segment: segment["connected"]), "connected", self.t_s)
        opened = connected < 0.5
        return float(self.t_s[opened.argmax()]) if opened.any() else None

    @cached_property
    def blocked_at_s(self) -> float | None:
        """Instant from which no phase carries current while the breaker stays closed (s), None when there is none.

        A record without ``connected`` is taken to have its breaker closed.
        """
        if self.is_switched and self.disconnected_at_s is not None:
            return None
        current = require_finite(self.current_pu, "the current", self.t_s)
        flowing = np.flatnonzero((np.abs(current) >= self.blocked_below_pu).any(axis=0))
        if not len(flowing) or flowing[-1] == len(self.t_s) - 1:
            return None
        return float(self.t_s[flowing[-1] + 1])

    @property
    def is_switched(self) -> bool:
        """Whether the record says when the breaker is closed."""
        return "connected" in self.waveforms.names

    @cached_property
    def no_load_pu(self) -> tuple[float, float] | None:
        """Mean V+ and V- of the source without the inverter's current while the sag lasts (pu).

        In the during-window; where the sag is too short for one, from one cycle after the start to clearing. None
        where not even one cycle fits.
        """
        inside = self.between(*self._no_load_span)
        if not inside.any():
            return None
        positive, negative = (
            require_finite(self._sequence_pu("u0", index)[inside], "u0", self.t_s[inside]) for index in (0, 1)
        )
        step_s = self.step_s[inside]
        return float(np.average(positive, weights=step_s)), float(np.average(negative, weights=step_s))

    @property
    def asked_pu(self) -> tuple[float, float]:
        """Mean V+ and V- that the source was asked for where `no_load_pu` is measured (pu)."""
        asked = [asked_sequences_pu(self.scenario, float(t)) for t in np.linspace(*self._no_load_span, 101)]
        return (
            float(np.mean([abs(sequences.positive) for sequences in asked])),
            float(np.mean([abs(sequences.negative) for sequences in asked])),
        )

    @property
    def _no_load_span(self) -> Span:
        return self.during_span or Span(self.scenario.start_s + 1 / self.frequency_hz, self.scenario.clear_s)

    @property
    def power_before_kw(self) -> float:
        """Mean P in the window before the sag (kW).

        Raises
        ------
        MeasurementError
            When it could not be measured.
        """
        before = self.measurements.before
        return required(before.active_power_kw if before else None, "P before the sag")

    @property
    def during_span(self) -> Span | None:
        """The during-window, None when the sag is too short for one."""
        scenario = self.scenario
        windows = standard_windows(
            scenario.start_s, scenario.clear_s, self.waveforms.end_s, self.frequency_hz, self.rules
        )
        return windows.during

    def during(self) -> WindowMeasurements:
        """Measurements of the during-window.

        Raises
        ------
        NotApplicable
            When the sag is too short for one.
        MeasurementError
            When there is one, but the record cannot be measured in it.
        """
        if self.measurements.during is not None:
            return self.measurements.during
        if self.during_span is None:
            raise NotApplicable(f"the sag of {self.scenario.duration_s:.3f} s leaves no whole cycle to measure")
        window_on_one_grid(self.waveforms, *self.during_span)  # raises with the reason where there is one
        raise MeasurementError("the window during the sag cannot be measured")

    def between(self, start_s: float, end_s: float) -> Mask:
        """Mask of the samples from one instant to another, both included, shape (n,)."""
        mask: Mask = (self.t_s >= start_s - _SAME_INSTANT_S) & (self.t_s <= end_s + _SAME_INSTANT_S)
        return mask

    def _sequence_pu(self, kind: str, index: int) -> Samples:
        base = self.nominal.phase_voltage_peak_v
        return self._one_cycle(lambda segment: np.abs(sequence_phasors(segment, kind, self.frequency_hz)[index]) / base)

    def _reactive_current_a(self, segment: Segment) -> Samples:
        u, i = (sequence_phasors(segment, kind, self.frequency_hz).positive for kind in "ui")
        return np.where(np.abs(u) < VOLTAGE_FLOOR_V, 0.0, sequence_current(u, i).reactive)

    def _phasors_pu(self, kind: str) -> ComplexSamples:
        def of_phases(segment: Segment) -> ComplexSamples:
            return np.stack(phases(*sequence_phasors(segment, kind, self.frequency_hz)))

        found: ComplexSamples = self._one_cycle(of_phases)
        return found / self.nominal.phase_voltage_peak_v

    def _cycle_mean(self, segment: Segment, x: Samples) -> Samples:
        return one_cycle_mean(x, segment.dt_s, self.frequency_hz)

    def _one_cycle(self, series: Callable[[Segment], NDArray[Any]], cycles: int = 1) -> NDArray[Any]:
        return np.concatenate(one_cycle_series(self.waveforms, series, self.frequency_hz, cycles), axis=-1)

    def _joined(self, series: Callable[[Segment], Samples]) -> Samples:
        return np.concatenate([series(segment) for segment in self.waveforms], axis=-1)


def require_finite(values: Samples, what: str, t_s: Samples) -> Samples:
    """Return the values, shape (..., n), when all are finite.

    Raises
    ------
    MeasurementError
        Naming the first instant at which one is not.
    """
    bad = np.atleast_2d(~np.isfinite(values)).any(axis=0)
    if bad.any():
        raise MeasurementError(f"{what} has no finite value at {t_s[bad.argmax()]:.3f} s")
    return values


def required(value: float | None, what: str) -> float:
    """Return a measured value that a verdict needs.

    Raises
    ------
    MeasurementError
        When it could not be measured.
    """
    if value is None:
        raise MeasurementError(f"{what} could not be measured")
    return value
