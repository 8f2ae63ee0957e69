"""What a check sees of one test: the record, and what is known about its test."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from pvlvrt_compliance.disturbance.model import Moved, Stretch
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.record import Record
from pvlvrt_compliance.evidence.required import NotApplicable, floors_of, require_finite, required
from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.measure.quantities import WindowMeasurements
from pvlvrt_compliance.measure.windows import Span, settled_window
from pvlvrt_compliance.profile.procedure import Detection, Expect, RowDemand
from pvlvrt_compliance.profile.requirements import Requirements
from pvlvrt_compliance.waveforms.container import Samples
from pvlvrt_compliance.waveforms.joining import window_on_one_grid

__all__ = ["ANY_LIGHT", "Evidence", "NotApplicable", "Until", "floors_of", "require_finite", "required"]

Until = Literal["trip", "release"]
"""What ends that which is judged: support is due up to the release, limits hold up to the trip."""

ANY_LIGHT: tuple[Moved, ...] = ("irradiance",)
"""What may move in a window whose quantity does not depend on it: reactive power and current."""


def after_trip(at_s: float) -> str:
    """Why nothing is judged once the inverter has let go (s); reports read the instant from it."""
    return f"not judged after the trip at {at_s:.3f} s"


@dataclass(frozen=True, eq=False, kw_only=True)
class Evidence(Record):
    """One record and its series, with what is known about its test.

    Parameters
    ----------
    waveforms : Waveforms
        The record.
    nominal : Nominal
        Base of the per-unit values.
    disturbance : Disturbance
        What the grid did.
    available_power_w : float
        What the PV array could give before the disturbance (W).
    measurements, rules, blocked_below_pu
        As `Record` has them.
    cell_temperature_c : float, optional
        Of the PV array (degrees C).
    k_factor : float, optional
        K that this test was run with, in place of the requirement's.
    detection : Detection, optional
        The profile's thresholds of a voltage event.
    requirements : Requirements, optional
        All that the profile demands, for checks that depend on each other's demands.
    expect, by_s : optional
        What the row of the test table demands (`TestRow`); none of a sag of the user's own.
    row : RowDemand, optional
        Clause and mark of that row (`TestCase.demand`).
    release : function, optional
        Says of evidence when the limits of the voltage let the inverter go (s), None when they never do.
    """

    available_power_w: float
    cell_temperature_c: float | None = None
    k_factor: float | None = None
    detection: Detection | None = None
    requirements: Requirements | None = None
    expect: Expect | None = None
    by_s: float | None = None
    row: RowDemand | None = None
    release: "Callable[[Evidence], float | None] | None" = None

    @cached_property
    def released_at_s(self) -> float | None:
        """When the limits of the voltage let the inverter go (s), None when they never do, or nobody says so.

        Raises
        ------
        MeasurementError
            When a voltage is missing or not finite.
        """
        return None if self.release is None else self.release(self)

    def stretches_until(self, until: Until) -> tuple[Stretch, ...]:
        """What follows each step of anything, up to the trip, or the release if that comes first.

        Raises
        ------
        NotApplicable
            When nothing is left, with what ended it.
        MeasurementError
            When the record does not say everywhere whether the breaker is closed.
        """
        return self.once(("stretches", until), lambda: self._stretches_until(until))

    def _stretches_until(self, until: Until) -> tuple[Stretch, ...]:
        end_s = self.record_end_s
        reason = "nothing of the record is left to judge"
        if (tripped_s := self.known_opening_s) is not None and tripped_s < end_s:
            end_s, reason = tripped_s, after_trip(tripped_s)
        released_s = self.released_at_s if until == "release" else None
        if released_s is not None and released_s < end_s:
            end_s, reason = released_s, f"not judged from {released_s:.3f} s on, when the inverter may let go"
        if end_s <= self.disturbance.start_s:
            raise NotApplicable(reason)
        return self.disturbance.following_stretches(end_s)

    def disturbed_until(self, until: Until) -> tuple[Stretch, ...]:
        """Of those, the ones before the voltage has come to where it stays: levels of sags and swells, gaps between.

        Of a test without a step of the voltage, all.

        Raises
        ------
        NotApplicable, MeasurementError
            As `stretches_until`.
        """
        last_s = self.disturbance.end_s if self.disturbance.voltage_steps_s else self.record_end_s
        return tuple(part for part in self.stretches_until(until) if part.begin_s < last_s)

    def departed_until(self, until: Until) -> tuple[Stretch, ...]:
        """Of those, the ones that are no gap: not at the normal voltage of before the disturbance.

        Of a test without a step of the voltage, all.

        Raises
        ------
        NotApplicable, MeasurementError
            As `stretches_until`.
        """
        parts = self.disturbed_until(until)
        if not self.disturbance.voltage_steps_s:
            return parts
        before = self.disturbance.no_load(self.waveforms.t0_s)
        return tuple(part for part in parts if part.kind != "normal" or part.ramps or part.voltage != before)

    def window_of(self, stretch: Stretch, despite: tuple[Moved, ...] = ()) -> WindowMeasurements:
        """What is measured in a stretch once it is settled, as `during` is in a sag.

        Parameters
        ----------
        stretch : Stretch
        despite : tuple, optional
            What may ramp in it: means of what is measured do not depend on it.

        Raises
        ------
        NotApplicable
            When something else ramps in the stretch, or it is too short for a whole cycle.
        MeasurementError
            When the record cannot be measured in it.
        """
        if moving := [what for what in stretch.ramps if what not in despite]:
            raise NotApplicable(f"the {' and the '.join(moving)} moves from {stretch.begin_s:.3f} s on")
        span = settled_window(stretch.begin_s, stretch.end_s, self.frequency_hz, self.rules)
        if span is None:
            length_s = stretch.end_s - stretch.begin_s
            raise NotApplicable(f"the {length_s:.3f} s from {stretch.begin_s:.3f} s on leave no whole cycle to measure")
        if span not in self._windows:
            found = self.measurements.during if span == self.during_span else None
            inside = Span(stretch.begin_s, stretch.end_s)
            self._windows[span] = found or self.measured_in(span, inside)
        if (window := self._windows[span]) is None:
            window_on_one_grid(self.waveforms, *span)  # raises with the reason where there is one
            raise MeasurementError(f"the window from {span.start_s:.3f} s to {span.end_s:.3f} s cannot be measured")
        return window

    def windows_of(self, stretches: Iterable[Stretch], despite: tuple[Moved, ...] = ()) -> Iterator[WindowMeasurements]:
        """Those of some stretches that can be measured; parameters as `window_of`."""
        for stretch in stretches:
            with suppress(NotApplicable, MeasurementError):
                yield self.window_of(stretch, despite)

    @cached_property
    def _windows(self) -> dict[Span, WindowMeasurements | None]:
        return {}

    @property
    def power_uncertainty_kva(self) -> float:
        """What method and measurement leave open of a power (kW or kvar)."""
        return self.thresholds.uncertainty_power_pu.value * self.nominal.apparent_power_kva

    def is_event(self, v_positive_pu: Samples) -> Mask:
        """Where a V+ (pu) is a sag or a swell by the profile's thresholds; without them, everywhere. Shape of V+."""
        if self.detection is None:
            return np.ones(np.shape(v_positive_pu), dtype=np.bool_)
        return np.asarray(self.detection.is_event(v_positive_pu), dtype=np.bool_)
