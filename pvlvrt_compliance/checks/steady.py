"""Currents in steady operation, over the ten or twelve cycles that power quality is judged by."""

from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.checks.evidence import Evidence, require_finite
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.groups import group_windows
from pvlvrt_compliance.measure.quantities import WindowMeasurements
from pvlvrt_compliance.waveforms.container import Samples


class SteadyWindow(NamedTuple):
    """Ten cycles at 50 Hz, or twelve at 60 Hz."""

    start_s: float
    end_s: float
    dt_s: float
    current: Samples
    """Phase currents in units of the rated current's rms, shape (3, n)."""


def steady_currents(evidence: Evidence) -> list[SteadyWindow]:
    """Windows before the sag and, where the record is long enough for one, at its end; the last cycles of each.

    Raises
    ------
    MeasurementError
        When the window before the sag holds fewer cycles, or a current is missing or not finite.
    """
    before, after = evidence.before(), evidence.measurements.after
    windows = [_last_cycles(evidence, before)]
    return windows if after is None else [*windows, _last_cycles(evidence, after)]


def _last_cycles(evidence: Evidence, window: WindowMeasurements) -> SteadyWindow:
    nominal = evidence.nominal
    segment = evidence.waveforms.window(window.start_s, window.end_s)
    stretches = group_windows(len(segment), segment.dt_s, evidence.frequency_hz, nominal.frequency_hz)
    if not stretches:
        raise MeasurementError(
            f"the window {window.start_s:.3f} s to {window.end_s:.3f} s is shorter than the cycles that harmonics are "
            "grouped over"
        )
    length = stretches[0].stop
    last = segment.slice(segment.t_s[-length] - segment.dt_s / 2, window.end_s)
    current = np.stack(last.three_phase("i")) / (nominal.phase_current_peak_a / np.sqrt(2))
    require_finite(current, "the current", last.t_s)
    return SteadyWindow(last.t0_s, window.end_s, last.dt_s, current)
