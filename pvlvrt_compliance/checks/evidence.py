"""What a check sees of one test: the record, its measurements and the series made from it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pvlvrt_compliance.checks.series import Series
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.quantities import Measurements, WindowMeasurements
from pvlvrt_compliance.measure.windows import Span, WindowRules, standard_windows
from pvlvrt_compliance.profile.procedure import Detection
from pvlvrt_compliance.profile.requirements import Requirements
from pvlvrt_compliance.scenario.timeline import asked_sequences_pu
from pvlvrt_compliance.waveforms.container import Samples
from pvlvrt_compliance.waveforms.joining import window_on_one_grid


class NotApplicable(Exception):  # noqa: N818 - it is a verdict, not an error
    """Raised by a check that the code lets off in this test; the text is the reason."""


@dataclass(frozen=True, eq=False)
class Evidence(Series):
    """One record and its series, with what is known about its test.

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
    requirements : Requirements, optional
        All that the profile demands, for checks that depend on each other's demands.
    """

    available_power_w: float
    measurements: Measurements
    rules: WindowRules
    blocked_below_pu: float
    k_factor: float | None = None
    detection: Detection | None = None
    requirements: Requirements | None = None

    @cached_property
    def disconnected_at_s(self) -> float | None:
        """First instant the breaker is open (s), None when it never opens.

        Raises
        ------
        MeasurementError
            When the record does not say, or not everywhere.
        """
        connected = require_finite(self.joined(lambda segment: segment["connected"]), "connected", self.t_s)
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
            require_finite(self.sequence_pu("u0", index)[inside], "u0", self.t_s[inside]) for index in (0, 1)
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

    def before(self) -> WindowMeasurements:
        """Measurements of the window before the sag.

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
