"""What is known about one record: its windows, its breaker, and the series made from it."""

import math
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.cycles import Made
from pvlvrt_compliance.evidence.required import NotApplicable, floors_of, require_finite, required
from pvlvrt_compliance.evidence.series import Series
from pvlvrt_compliance.measure.durations import mean_over_time
from pvlvrt_compliance.measure.quantities import MeasuredStretch, MeasuredWindows, WindowMeasurements
from pvlvrt_compliance.measure.response import settled_from
from pvlvrt_compliance.measure.summary import measure_span
from pvlvrt_compliance.measure.windows import Span, WindowRules, standard_windows, stretch_window
from pvlvrt_compliance.waveforms.breaker import opened_at_s
from pvlvrt_compliance.waveforms.container import Samples, Segment
from pvlvrt_compliance.waveforms.joining import window_on_one_grid
from pvlvrt_compliance.waveforms.trip_causes import in_words

_SAME_INSTANT_S = 1e-9
_AT_A_TIME = 4096  # samples: what is made of so many on the way stays in the processor's own memory


@dataclass(frozen=True, eq=False, kw_only=True)
class Record(Series):
    """One record with its standard windows.

    Parameters
    ----------
    measurements : MeasuredWindows
        Of the windows before, during and after the sag.
    rules : WindowRules
        Where those windows lie.
    blocked_below_pu : float
        Phase currents that all stay below this to the end of the record show a blocked bridge (pu).
    """

    measurements: MeasuredWindows
    rules: WindowRules
    blocked_below_pu: float

    def samples(self, start_s: float, end_s: float) -> slice:
        """Samples from one instant to another, both included: those that `between` masks."""
        return self._slice(start_s, end_s + _SAME_INSTANT_S, "right")

    def samples_before(self, start_s: float, end_s: float) -> slice:
        """Samples from one instant to before another."""
        return self._slice(start_s, end_s, "left")

    def _slice(self, start_s: float, end_s: float, side: Literal["left", "right"]) -> slice:
        key = (start_s, end_s, side)  # the checks and the figures ask for the same spans again and again
        if key not in self._slices:
            first = int(self.t_s.searchsorted(start_s - _SAME_INSTANT_S))
            self._slices[key] = slice(first, max(int(self.t_s.searchsorted(end_s, side)), first))
        return self._slices[key]

    @cached_property
    def _slices(self) -> dict[tuple[float, float, str], slice]:
        return {}

    def once_for(self, item: object, key: Hashable, make: Callable[[], Made]) -> Made:
        """As `once`, for one object alone: not for another that is equal to it."""
        return self.once((key, id(item)), lambda: (item, make()))[1]  # while it is kept, no other has its number

    @cached_property
    def largest_current_pu(self) -> Samples:
        """One-cycle fundamental amplitude of the phase current that is the largest, shape (n,)."""
        a, b, c = self.current_phase_pu
        largest: Samples = np.maximum(a, b)
        np.maximum(largest, c, out=largest)
        return largest

    @cached_property
    def largest_instantaneous_pu(self) -> Samples:
        """The largest magnitude of the instantaneous phase currents, shape (n,)."""

        def largest(segment: Segment) -> Samples:
            found, part = np.empty(len(segment)), np.empty(_AT_A_TIME)
            for begin in range(0, len(segment), _AT_A_TIME):
                here = found[begin : begin + _AT_A_TIME]
                a, b, c = (x[begin : begin + _AT_A_TIME] for x in segment.three_phase("i"))
                np.abs(a, out=here)
                for x in (b, c):
                    np.maximum(here, np.abs(x, out=part[: len(x)]), out=here)
                here /= self.nominal.phase_current_peak_a
            return found

        return self.joined(largest)

    @cached_property
    def disconnected_at_s(self) -> float | None:
        """First instant the breaker is open (s), None when it never opens.

        Raises
        ------
        MeasurementError
            When the record does not say, or not everywhere.
        """
        require_finite(self.joined(lambda segment: segment["connected"]), "connected", self.t_s)
        return opened_at_s(self.waveforms)

    @cached_property
    def trip_cause(self) -> str | None:
        """What opened the breaker, in words; None when it stays closed or the record does not say."""
        if "trip_cause" not in self.waveforms.names:
            return None
        code = np.max([segment["trip_cause"].max(initial=0.0) for segment in self.waveforms])
        return in_words(int(code)) if code > 0 else None

    @cached_property
    def tripped_before_s(self) -> float | None:
        """When a relay tripped before the disturbance (s): minus infinity where all that is known is before the record.

        None when none did, or the record does not say.
        """
        if self.trip_cause is None:
            return None
        codes = self.joined(lambda segment: segment["trip_cause"])
        first = int((codes > 0).argmax())
        if not codes[first] > 0 or self.t_s[first] >= self.disturbance.start_s:
            return None
        if (known_s := self.waveforms.tripped_at_s) is not None:
            return known_s
        return float(self.t_s[first]) if first else -math.inf

    @cached_property
    def blocked_at_s(self) -> float | None:
        """Instant from which no phase carries current while the breaker stays closed (s), None when there is none.

        A record without ``connected`` is taken to have its breaker closed.
        """
        if self.known_opening_s is not None:
            return None
        current = require_finite(self.largest_instantaneous_pu, "the current", self.t_s)
        blocked_from = settled_from(current >= self.blocked_below_pu)
        return float(self.t_s[blocked_from]) if blocked_from else None

    @property
    def is_switched(self) -> bool:
        """Whether the record says when the breaker is closed."""
        return "connected" in self.waveforms.names

    @property
    def known_opening_s(self) -> float | None:
        """As `disconnected_at_s`; also None where the record says nothing of the breaker."""
        return self.disconnected_at_s if self.is_switched else None

    @cached_property
    def no_load_pu(self) -> tuple[float, float] | None:
        """Mean V+ and V- of the source without the inverter's current while the sag lasts (pu).

        In the during-window; where the sag is too short for one, from one cycle after the start to clearing. None
        where not even one cycle fits, and in a record that has no such voltages.
        """
        inside = self.samples(*self._no_load_span)
        if inside.start == inside.stop or "u0_a_v" not in self.waveforms.names:
            return None
        positive, negative = (
            require_finite(self.sequence_pu("u0", index)[inside], "u0", self.t_s[inside]) for index in (0, 1)
        )
        step_s = self.step_s[inside]
        return mean_over_time(positive, step_s), mean_over_time(negative, step_s)

    @property
    def asked_pu(self) -> tuple[float, float]:
        """Mean V+ and V- that the source was asked for where `no_load_pu` is measured (pu)."""
        first, last = (self.disturbance.stretch_at(t) for t in self._no_load_span)
        if first is last and first.voltage_at_end is None:  # it holds
            return first.voltage.positive_pu, first.voltage.negative_pu
        asked = [self.disturbance.no_load(float(t)) for t in np.linspace(*self._no_load_span, 101)]
        return (
            float(np.mean([voltage.positive_pu for voltage in asked])),
            float(np.mean([voltage.negative_pu for voltage in asked])),
        )

    @property
    def _no_load_span(self) -> Span:
        return self.during_span or Span(self.disturbance.start_s + 1 / self.frequency_hz, self.disturbance.clear_s)

    @property
    def voltage_stretches(self) -> tuple[Stretch, ...]:
        """What follows each step of the voltage up to the next, the last to the end of the record."""
        return self.disturbance.voltage_stretches(self.waveforms.end_s)

    @cached_property
    def measured_stretches(self) -> tuple[MeasuredStretch, ...]:
        """Each of these stretches, measured in its own settled window."""
        return tuple(self._measured(part) for part in self.voltage_stretches)

    def _measured(self, part: Stretch) -> MeasuredStretch:
        settled = self.thresholds.settled_cycles.value
        span = stretch_window(part.begin_s, part.end_s, self.frequency_hz, settled, self.rules)
        inside = Span(part.begin_s, part.end_s)
        window = span and self.measured_in(span, inside)
        return MeasuredStretch(begin_s=part.begin_s, end_s=part.end_s, in_words=part.in_words, window=window)

    def measured_in(self, span: Span, inside: Span) -> WindowMeasurements | None:
        """What is measured in a window, its largest current looked for in another span; None where it cannot be."""
        floors, by = floors_of(self.thresholds), self.instruments.windows
        return measure_span(self.waveforms, self.nominal, self.frequency_hz, span, inside, floors, by)

    @property
    def record_end_s(self) -> float:
        """End of the record (s): its last sample stands for the step that follows it."""
        return self.waveforms.end_s + self.waveforms.segments[-1].dt_s

    @property
    def half_cycle_s(self) -> float:
        """What a time taken from one-cycle quantities leaves open (s)."""
        return 0.5 / self.frequency_hz

    @property
    def power_before_kw(self) -> float:
        """Mean P in the window before the disturbance (kW).

        Raises
        ------
        MeasurementError
            When it could not be measured.
        """
        before = self.measurements.before
        return required(before.active_power_kw if before else None, "P before the sag")

    @property
    def starting_power_kw(self) -> float:
        """Mean P before the disturbance (kW), where shares of it are demanded.

        Raises
        ------
        NotApplicable
            When there was none.
        MeasurementError
            When it could not be measured.
        """
        if self.power_before_kw <= self.thresholds.no_power_pu.value * self.nominal.apparent_power_kva:
            raise NotApplicable(f"no active power before: {self.power_before_kw:.1f} kW")
        return self.power_before_kw

    def before(self) -> WindowMeasurements:
        """What was measured in the window before the disturbance.

        Raises
        ------
        MeasurementError
            When the record cannot be measured in it.
        """
        if self.measurements.before is None:
            raise MeasurementError("the window before the sag cannot be measured")
        return self.measurements.before

    @property
    def during_span(self) -> Span | None:
        """The during-window, None when the sag is too short for one."""
        start_s, clear_s = self.disturbance.start_s, self.disturbance.clear_s
        return standard_windows(start_s, clear_s, self.waveforms.end_s, self.frequency_hz, self.rules).during

    def during(self) -> WindowMeasurements:
        """What was measured in the during-window.

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
            raise NotApplicable(f"the sag of {self.disturbance.duration_s:.3f} s leaves no whole cycle to measure")
        window_on_one_grid(self.waveforms, *self.during_span)  # raises with the reason where there is one
        raise MeasurementError("the window during the sag cannot be measured")
