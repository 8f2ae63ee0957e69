"""The inverter stays connected at the frequencies and through the rates of change that the code names."""

from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.checks.disturbances import is_voltage_normal
from pvlvrt_compliance.checks.evidence import Evidence, NotApplicable
from pvlvrt_compliance.checks.excursions import excursions, inside_of, time_spent_s
from pvlvrt_compliance.checks.frequency_series import (
    ACCURACY_HZ,
    frequency_hz,
    held_in_words,
    known_frequency_hz,
    largest_deviation,
)
from pvlvrt_compliance.checks.results import Check, Status
from pvlvrt_compliance.checks.verdicts import judged
from pvlvrt_compliance.measure.frequency import rocof_hz_s
from pvlvrt_compliance.profile.curves import Side
from pvlvrt_compliance.profile.provenance import Marked
from pvlvrt_compliance.profile.requirements import FrequencyRideThrough
from pvlvrt_compliance.profile.tables import FrequencyBand
from pvlvrt_compliance.waveforms.container import Samples

KIND = "frequency_ride_through"


class _Demand(NamedTuple):
    """Stay connected for a time from an instant on, because of a band or of the rate."""

    since_s: float
    stay_s: float
    by: str
    mark: Marked

    @property
    def until_s(self) -> float:
        return self.since_s + self.stay_s


class _Stop(NamedTuple):
    """When the inverter stopped for good, and how."""

    at_s: float
    how: str


def check_frequency_ride_through(requirement: FrequencyRideThrough, evidence: Evidence) -> Check:
    """Judge a trip, or a blocked bridge, by the time in each band (or further out) and the rate of change up to then.

    Each stay beyond a band counts from its own beginning. A frequency or a rate within the accuracy of the measurement
    of a limit is on it (`ACCURACY_HZ`; for the rate, both ends of its window).

    Raises
    ------
    NotApplicable
        When the frequency stays near nominal, or the inverter tripped while the voltage was not normal.
    MeasurementError
        When the voltages are missing, or the record does not say whether the breaker is closed.
    """
    worst_hz, worst_at_s = largest_deviation(evidence)
    frequency = frequency_hz(evidence)
    rate = _rate(requirement, evidence)
    seen = (
        f"furthest {worst_hz:.2f} Hz at {worst_at_s:.3f} s{_rate_in_words(requirement, rate)}{held_in_words(evidence)}"
    )
    demands = [*_band_releases(requirement, evidence, frequency), *_rate_releases(requirement, evidence, rate)]
    release = min(demands, key=lambda demand: demand.until_s, default=None)
    stop = _stop(evidence)
    if stop is None:
        always = _always(requirement, evidence)
        return _verdict(requirement, Status.PASS, f"connected throughout; {seen}", always, evidence.waveforms.end_s)
    if not is_voltage_normal(evidence.scenario, stop.at_s):
        raise NotApplicable(f"{stop.how} while the voltage was not normal, which is judged by ride_through")
    if release is not None and stop.at_s >= release.until_s:
        message = f"{release.by} demands {release.stay_s:.3f} s, connected for {stop.at_s - release.since_s:.2f} s"
        return _verdict(requirement, Status.NOT_APPLICABLE, f"{message}; {seen}", release, stop.at_s)
    demand, words = _always(requirement, evidence), "every frequency and rate up to then demands connection"
    if release is not None and release.since_s <= stop.at_s:
        demand, words = release, f"{release.by} demands {release.stay_s:.3f} s"
    message = (
        f"{stop.how} at {stop.at_s:.3f} s, {stop.at_s - demand.since_s:.3f} s after {demand.since_s:.3f} s; {words}"
    )
    return _verdict(requirement, Status.FAIL, f"{message}; {seen}", demand, stop.at_s)


def _stop(evidence: Evidence) -> _Stop | None:
    if evidence.disconnected_at_s is not None:
        return _Stop(evidence.disconnected_at_s, "tripped")
    return None if evidence.blocked_at_s is None else _Stop(evidence.blocked_at_s, "bridge blocked")


def _always(requirement: FrequencyRideThrough, evidence: Evidence) -> _Demand:
    start_s = evidence.scenario.start_s
    return _Demand(start_s, evidence.waveforms.end_s - start_s, "", requirement.bands)


def _verdict(
    requirement: FrequencyRideThrough, status: Status, message: str, demand: _Demand, stopped_at_s: float
) -> Check:
    connected_s = stopped_at_s - demand.since_s
    return judged(
        KIND,
        requirement,
        status,
        message,
        measured=connected_s,
        limit=demand.stay_s,
        margin=connected_s - demand.stay_s,
        unit="s",
        at_s=stopped_at_s,
        rests_on=(demand.mark,),
        clause=requirement.bands.clause,
    )


def _band_releases(requirement: FrequencyRideThrough, evidence: Evidence, frequency: Samples) -> list[_Demand]:
    """What lets the inverter go: a band whose time is over, and frequencies beyond all bands at once."""
    rows = requirement.bands.rows
    nominal_hz = evidence.nominal.frequency_hz
    low_hz, high_hz = rows[0].frequency_hz[0], rows[-1].frequency_hz[1]
    found = [
        _beyond(requirement, evidence, frequency, Side.LOW, low_hz, 0.0, f"below {low_hz:g} Hz the code"),
        _beyond(requirement, evidence, frequency, Side.HIGH, high_hz, 0.0, f"above {high_hz:g} Hz the code"),
    ]
    for row in rows:
        if row.ride_s is not None:
            side = Side.LOW if row.frequency_hz[1] <= nominal_hz else Side.HIGH
            near_hz = row.frequency_hz[1 if side is Side.LOW else 0]
            found.append(_beyond(requirement, evidence, frequency, side, near_hz, row.ride_s, _band_in_words(row)))
    return [demand for demand in found if demand is not None]


def _band_in_words(row: FrequencyBand) -> str:
    return f"the band {row.frequency_hz[0]:g} to {row.frequency_hz[1]:g} Hz"


def _beyond(
    requirement: FrequencyRideThrough,
    evidence: Evidence,
    frequency: Samples,
    side: Side,
    edge_hz: float,
    ride_s: float,
    by: str,
) -> _Demand | None:
    sign = 1 if side is Side.LOW else -1
    found = excursions(sign * (edge_hz - frequency) > ACCURACY_HZ, evidence.t_s, gap_s=1 / evidence.frequency_hz)
    spent_s = time_spent_s(found, evidence.t_s, None)
    free = np.flatnonzero(inside_of(found, evidence.t_s) & (spent_s >= ride_s))
    if not len(free):
        return None
    return _Demand(float(evidence.t_s[free[0]]) - ride_s, ride_s, by, requirement.bands)


def _rate(requirement: FrequencyRideThrough, evidence: Evidence) -> Samples | None:
    """Rate of change between two frequencies that are known: after one that is held, the first known one is no step."""
    if requirement.rocof_window_s is None:
        return None
    return np.abs(rocof_hz_s(evidence.t_s, known_frequency_hz(evidence), requirement.rocof_window_s.value))


def _rate_releases(requirement: FrequencyRideThrough, evidence: Evidence, rate: Samples | None) -> list[_Demand]:
    if rate is None or requirement.rocof_hz_s is None or requirement.rocof_window_s is None:
        return []
    limit = requirement.rocof_hz_s
    too_fast = np.flatnonzero(rate > limit.value + 2 * ACCURACY_HZ / requirement.rocof_window_s.value)
    by = f"beyond {limit.value:g} Hz/s the code"
    return [_Demand(float(evidence.t_s[too_fast[0]]), 0.0, by, limit)] if len(too_fast) else []


def _rate_in_words(requirement: FrequencyRideThrough, rate: Samples | None) -> str:
    if rate is None or requirement.rocof_window_s is None or not np.isfinite(rate).any():
        return ""
    return f", fastest {np.nanmax(rate):.2f} Hz/s over {requirement.rocof_window_s.value:g} s"
