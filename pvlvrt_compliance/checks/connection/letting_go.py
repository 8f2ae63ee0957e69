"""When the inverter let go for good, what opened the breaker, and what the grid did just then."""

from typing import Literal, NamedTuple

import numpy as np

from pvlvrt_compliance.disturbance.model import Voltage
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.evidence.no_load import no_load_series_pu

Moved = Literal["low voltage", "high voltage", "frequency", "angle"]
"""What is not that of normal operation."""


class Stop(NamedTuple):
    """The instant at which the breaker opened."""

    at_s: float
    by: str | None  # the relay, or the controller; none: the record does not say

    @property
    def in_words(self) -> str:
        """As a message says it."""
        return f"tripped at {self.at_s:.3f} s{self.cause}"

    @property
    def cause(self) -> str:
        """What opened the breaker, to be put behind a verb; empty where nobody knows."""
        return f" by the {self.by}" if self.by else ""


def stop_of(evidence: Evidence) -> Stop | None:
    """When and by what the inverter let go, None when it stayed.

    Raises
    ------
    MeasurementError
        When the record does not say whether the breaker is closed.
    """
    opened_s = evidence.disconnected_at_s
    return None if opened_s is None else Stop(opened_s, evidence.trip_cause)


def moved_at(evidence: Evidence, at_s: float) -> Moved | None:
    """What of the grid is not normal at an instant, None where all of it is.

    The voltage comes first: where it is not normal, its limits decide, whatever else moves. A jump of the angle counts
    for a while after it, but not one that comes with a step of the voltage, as every fault has it.
    """
    grid, thresholds = evidence.disturbance, evidence.thresholds
    voltage = grid_voltage(evidence, at_s)
    if not grid.normal.holds(voltage):
        return "high voltage" if voltage.positive_pu > grid.normal.high_pu else "low voltage"
    if abs(grid_frequency_hz(evidence, at_s) - evidence.nominal.frequency_hz) > thresholds.frequency_deviation_hz.value:
        return "frequency"
    recent_s, least_deg = thresholds.normal_jump_s.value, thresholds.normal_jump_deg.value
    jumps = [
        jump for jump in grid.jumps if at_s - recent_s <= jump.at_s <= at_s and jump.at_s not in grid.voltage_steps_s
    ]
    return "angle" if any(max(abs(jump.positive_deg), abs(jump.phase_deg)) > least_deg for jump in jumps) else None


def grid_voltage(evidence: Evidence, at_s: float) -> Voltage:
    """Voltage of the source at an instant: the one asked for, or where a recording is played, the one measured."""
    part = evidence.disturbance.stretch_at(at_s)
    if "recording" not in part.ramps:
        return part.voltage_at(at_s)
    sample = min(int(np.searchsorted(evidence.t_s, at_s)), len(evidence.t_s) - 1)
    positive, negative = (float(np.nan_to_num(no_load_series_pu(evidence, index)[sample])) for index in (0, 1))
    return Voltage(positive_pu=positive, negative_pu=negative, zero_pu=0.0)


def grid_frequency_hz(evidence: Evidence, at_s: float) -> float:
    """Frequency of the source at an instant (Hz): the one asked for, or the last that was measured before."""
    part = evidence.disturbance.stretch_at(at_s)
    if part.frequency_hz is not None and "recording" not in part.ramps and evidence.disturbance.origin == "asked":
        return part.frequency_hz + part.rocof_hz_s * (at_s - part.begin_s)
    known = np.flatnonzero(np.isfinite(evidence.tracked_frequency_hz) & (evidence.t_s <= at_s))
    return float(evidence.tracked_frequency_hz[known[-1]]) if len(known) else evidence.nominal.frequency_hz
