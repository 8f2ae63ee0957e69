"""Currents in steady operation, over the ten or twelve cycles that power quality is judged by."""

from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.evidence.evidence import Evidence, require_finite
from pvlvrt_compliance.measure.groups import window_cycles
from pvlvrt_compliance.measure.quantities import WindowMeasurements
from pvlvrt_compliance.waveforms.container import Samples
from pvlvrt_compliance.waveforms.joining import window_on_one_grid


class SteadyWindow(NamedTuple):
    """Ten cycles at 50 Hz, or twelve at 60 Hz."""

    start_s: float
    end_s: float
    dt_s: float
    frequency_hz: float
    current: Samples
    """Phase currents in units of the rated current's rms, shape (3, n)."""


def steady_currents(evidence: Evidence) -> list[SteadyWindow]:
    """Windows that end with the one before the disturbance and, in a record long enough, with the one at its end.

    After a trip the latter is not looked at. They are counted in cycles of their own frequency from their end
    backwards: a window of 0.2 s holds eleven cycles of 59.8 Hz and a part of the twelfth, and a disturbance may leave
    another frequency than it found.

    Raises
    ------
    MeasurementError
        When the record before the disturbance holds fewer cycles, or a current is missing or not finite.
    """
    before, after = evidence.before(), evidence.measurements.after
    windows = [_last_cycles(evidence, before)]
    return windows if after is None or _is_open(evidence) else [*windows, _last_cycles(evidence, after)]


def _is_open(evidence: Evidence) -> bool:
    """Whether the inverter has tripped by the end of the record: what flows then is not its own."""
    return evidence.known_opening_s is not None


def _last_cycles(evidence: Evidence, window: WindowMeasurements) -> SteadyWindow:
    nominal = evidence.nominal
    frequency_hz = window.frequency_hz or evidence.frequency_hz
    start_s = window.end_s - window_cycles(nominal.frequency_hz) / frequency_hz
    segment = window_on_one_grid(evidence.waveforms, start_s, window.end_s)
    current = np.stack(segment.three_phase("i")) / (nominal.phase_current_peak_a / np.sqrt(2))
    require_finite(current, "the current", segment.t_s)
    return SteadyWindow(start_s, window.end_s, segment.dt_s, frequency_hz, current)
