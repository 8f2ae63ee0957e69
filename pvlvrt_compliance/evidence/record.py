"""What is known about one record: its windows, its breaker, and the series made from it."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.series import Series
from pvlvrt_compliance.measure.quantities import MeasuredStretch, MeasuredWindows, WindowMeasurements
from pvlvrt_compliance.measure.response import settled_from
from pvlvrt_compliance.measure.summary import Floors, measure_span
from pvlvrt_compliance.measure.windows import Span, WindowRules, standard_windows, stretch_window
from pvlvrt_compliance.profile.thresholds import Thresholds
from pvlvrt_compliance.waveforms.breaker import opened_at_s
from pvlvrt_compliance.waveforms.container import Samples
from pvlvrt_compliance.waveforms.joining import window_on_one_grid
from pvlvrt_compliance.waveforms.trip_causes import in_words


class NotApplicable(Exception):  # noqa: N818 - it is a verdict, not an error
    """Raised by a check that the code lets off in this test; the text is the reason."""


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
        codes = self._trip_codes
        return in_words(int(codes.max())) if codes.max() > 0 else None

    @cached_property
    def tripped_before_s(self) -> float | None:
        """When a relay tripped before the disturbance (s): minus infinity where all that is known is before the record.

        None when none did, or the record does not say.
        """
        if "trip_cause" not in self.waveforms.names:
            return None
        first = int((self._trip_codes > 0).argmax())
        if not self._trip_codes[first] > 0 or self.t_s[first] >= self.disturbance.start_s:
            return None
        if (known_s := self.waveforms.tripped_at_s) is not None:
            return known_s
        return float(self.t_s[first]) if first else -math.inf

    @property
    def _trip_codes(self) -> Samples:
        return self.joined(lambda segment: segment["trip_cause"])

    @cached_property
    def blocked_at_s(self) -> float | None:
        """Instant from which no phase carries current while the breaker stays closed (s), None when there is none.

        A record without ``connected`` is taken to have its breaker closed.
        """
        if self.known_opening_s is not None:
            return None
        current = require_finite(self.current_pu, "the current", self.t_s)
        blocked_from = settled_from(np.asarray((np.abs(current) >= self.blocked_below_pu).any(axis=0)))
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
        inside = self.between(*self._no_load_span)
        if not inside.any() or "u0_a_v" not in self.waveforms.names:
            return None
        positive, negative = (
            require_finite(self.sequence_pu("u0", index)[inside], "u0", self.t_s[inside]) for index in (0, 1)
        )
        step_s = self.step_s[inside]
        return float(np.average(positive, weights=step_s)), float(np.average(negative, weights=step_s))

    @property
    def asked_pu(self) -> tuple[float, float]:
        """Mean V+ and V- that the source was asked for where `no_load_pu` is measured (pu)."""
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
        window = span and measure_span(
            self.waveforms, self.nominal, self.frequency_hz, span, inside, floors_of(self.thresholds)
        )
        return MeasuredStretch(begin_s=part.begin_s, end_s=part.end_s, in_words=part.in_words, window=window)

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


def floors_of(thresholds: Thresholds) -> Floors:
    """From where on the quantities of a window are stated."""
    return Floors(
        voltage_pu=thresholds.window_voltage_floor_pu.value,
        fundamental_pu=thresholds.least_fundamental_fraction.value,
        other_frequency_hz=thresholds.other_frequency_hz.value,
    )


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
