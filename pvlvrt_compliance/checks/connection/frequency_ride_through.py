"""The inverter stays connected at the frequencies and through the rates of change that the code names."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.connection.demand import Demand, failed_throughout, judged_stay
from pvlvrt_compliance.checks.connection.letting_go import stop_of
from pvlvrt_compliance.data.marks import Marked
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable
from pvlvrt_compliance.evidence.excursions import excursions, inside_of, time_spent_s
from pvlvrt_compliance.evidence.frequency import (
    frequency_hz,
    held_in_words,
    known_frequency_hz,
    largest_deviation,
)
from pvlvrt_compliance.measure.frequency import rocof_hz_s
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.profile.curves import Side
from pvlvrt_compliance.profile.requirements import FrequencyRideThrough
from pvlvrt_compliance.profile.tables import FrequencyBand
from pvlvrt_compliance.results import Band, Status, Verdict
from pvlvrt_compliance.results.band import FREQUENCY
from pvlvrt_compliance.waveforms.container import Samples

KIND = "frequency_ride_through"


class _Stop(NamedTuple):
    """When the inverter stopped for good, and how."""

    at_s: float
    how: str


class FrequencyRideThroughCheck(Check):
    """Judges whether the inverter feeds for as long as bands of the frequency and its rate of change demand."""

    kind = KIND
    title = "Ride-through of frequency disturbances"
    requirement = FrequencyRideThrough
    judges_connection = True

    def judge(self, requirement: FrequencyRideThrough, evidence: Evidence) -> Verdict:
        """Judge a trip, or a blocked bridge, by the time in each band (or further out) and the rate of change.

        Each stay beyond a band counts from its own beginning. A frequency or a rate within the accuracy of the
        measurement of a limit is on it (`frequency_accuracy_hz`; for the rate, both ends of its window).

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
        fastest, held = _rate_in_words(requirement, rate), held_in_words(evidence)
        seen = f"furthest {worst_hz:.2f} Hz at {worst_at_s:.3f} s{fastest}{held}"
        demands = [*_band_releases(requirement, evidence, frequency), *_rate_releases(requirement, evidence, rate)]
        release = min(demands, key=lambda demand: demand.until_s, default=None)
        always = _always(requirement, evidence)
        stop = _stop(evidence)
        if stop is None:
            end_s = max(evidence.record_end_s, always.until_s)
            let_go = release is not None and release.until_s <= always.until_s
            demand = always.of_row_alone(evidence) if let_go else always
            return judged_stay(
                KIND, requirement, Status.PASS, f"connected throughout; {seen}", demand, stopped_at_s=end_s
            )
        if not evidence.disturbance.is_normal(stop.at_s):
            raise NotApplicable(f"{stop.how} while the voltage was not normal, which is judged by ride_through")
        return _judge_stop(requirement, stop, release, always, evidence, seen)

    def limits(self, requirement: FrequencyRideThrough, evidence: Evidence) -> tuple[Band, ...]:
        """Bands for ever over the whole record, others from where the frequency enters them, for their time."""
        return tuple(_bands(requirement, evidence))


def _bands(requirement: FrequencyRideThrough, evidence: Evidence) -> Iterator[Band]:
    frequency, end_s = frequency_hz(evidence), evidence.waveforms.end_s
    for row in requirement.bands.rows:
        if row.ride_s is None:
            yield _band(row, (evidence.waveforms.t0_s, end_s))
        else:
            side, near_hz = _near_edge(row, evidence)
            for begin_s, _ in _excursions(evidence, frequency, side, near_hz):
                yield _band(row, (begin_s, min(begin_s + row.ride_s, end_s)))


def _band(row: FrequencyBand, span: tuple[float, float]) -> Band:
    low, high = row.frequency_hz
    mode, time = ("continuous", "") if row.ride_s is None else ("mandatory", f" for {row.ride_s:g} s")
    name = f"stay connected{time}, {low:g} to {high:g} Hz"
    edges = {"lower": (low, low), "upper": (high, high)}
    return Band(check=KIND, quantity=FREQUENCY, name=name, t_s=span, region=mode, **edges)


def _judge_stop(
    requirement: FrequencyRideThrough,
    stop: _Stop,
    release: Demand | None,
    always: Demand,
    evidence: Evidence,
    seen: str,
) -> Verdict:
    begun_s = release.since_s if release is not None else evidence.disturbance.start_s
    message = f"{stop.how} at {stop.at_s:.3f} s, {stop.at_s - begun_s:.3f} s after {begun_s:.3f} s; {seen}"
    whole = evidence.expect == "ride_through" and stop.at_s < evidence.disturbance.end_s
    if whole:
        let_go = release is not None and release.until_s <= stop.at_s
        demand = always.of_row_alone(evidence) if let_go else always
        return judged_stay(
            KIND, requirement, Status.FAIL, f"{message}; {demand.in_words}", demand, stopped_at_s=stop.at_s
        )
    if release is None or stop.at_s < release.since_s:
        words = f"{message}; every frequency and rate up to then demands connection"
        return failed_throughout(KIND, requirement, words, always, stopped_at_s=stop.at_s)
    if release.stay_s <= 0:
        raise NotApplicable(f"{message}; {release.by} demands nothing")
    status = Status.PASS if stop.at_s >= release.until_s else Status.FAIL
    return judged_stay(KIND, requirement, status, f"{message}; {release.in_words}", release, stopped_at_s=stop.at_s)


def _stop(evidence: Evidence) -> _Stop | None:
    stop = stop_of(evidence)
    if stop is not None:
        return _Stop(stop.at_s, f"tripped{stop.cause}")
    return None if evidence.blocked_at_s is None else _Stop(evidence.blocked_at_s, "bridge blocked")


def _always(requirement: FrequencyRideThrough, evidence: Evidence) -> Demand:
    grid, bands = evidence.disturbance, requirement.bands
    uncertain_s = evidence.thresholds.uncertainty_instant_s.value
    return Demand(grid.start_s, grid.end_s - grid.start_s, "the test", bands.clause, bands, uncertain_s)


def _band_releases(requirement: FrequencyRideThrough, evidence: Evidence, frequency: Samples) -> list[Demand]:
    """What lets the inverter go: a band whose time is over, and frequencies beyond all bands at once."""
    rows = requirement.bands.rows
    low_hz, high_hz = rows[0].frequency_hz[0], rows[-1].frequency_hz[1]
    found = [
        _beyond(
            requirement,
            evidence,
            frequency,
            Side.LOW,
            low_hz,
            0.0,
            f"below {low_hz:g} Hz the code",
            requirement.bands.mark_of(rows[0]),
        ),
        _beyond(
            requirement,
            evidence,
            frequency,
            Side.HIGH,
            high_hz,
            0.0,
            f"above {high_hz:g} Hz the code",
            requirement.bands.mark_of(rows[-1]),
        ),
    ]
    for row in rows:
        if row.ride_s is not None:
            side, near_hz = _near_edge(row, evidence)
            mark = requirement.bands.mark_of(row)
            found.append(
                _beyond(requirement, evidence, frequency, side, near_hz, row.ride_s, _band_in_words(row), mark)
            )
    return [demand for demand in found if demand is not None]


def _near_edge(row: FrequencyBand, evidence: Evidence) -> tuple[Side, float]:
    """On which side of nominal a band lies, and its edge that is nearer to it (Hz)."""
    if row.frequency_hz[1] <= evidence.nominal.frequency_hz:
        return Side.LOW, row.frequency_hz[1]
    return Side.HIGH, row.frequency_hz[0]


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
    mark: Marked,
) -> Demand | None:
    found = _excursions(evidence, frequency, side, edge_hz)
    spent_s = time_spent_s(found, evidence.t_s, None)
    free = np.flatnonzero(inside_of(found, evidence.t_s) & (spent_s >= ride_s))
    if not len(free):
        return None
    begun_s, uncertain_s = float(evidence.t_s[free[0]]) - ride_s, evidence.half_cycle_s
    return Demand(begun_s, ride_s, by, requirement.bands.clause, mark, uncertain_s)


def _excursions(evidence: Evidence, frequency: Samples, side: Side, edge_hz: float) -> list[Span]:
    """Where the frequency lies beyond an edge by more than it can be measured with."""
    sign = 1 if side is Side.LOW else -1
    beyond = sign * (edge_hz - frequency) > evidence.thresholds.frequency_accuracy_hz.value
    return excursions(beyond, evidence.t_s, gap_s=1 / evidence.frequency_hz)


def _rate(requirement: FrequencyRideThrough, evidence: Evidence) -> Samples | None:
    """Rate of change between two frequencies that are known: after one that is held, the first known one is no step."""
    if requirement.rocof_window_s is None:
        return None
    return np.abs(rocof_hz_s(evidence.t_s, known_frequency_hz(evidence), requirement.rocof_window_s.value))


def _rate_releases(requirement: FrequencyRideThrough, evidence: Evidence, rate: Samples | None) -> list[Demand]:
    if rate is None or requirement.rocof_hz_s is None or requirement.rocof_window_s is None:
        return []
    limit = requirement.rocof_hz_s
    too_fast = np.flatnonzero(
        rate > limit.value + 2 * evidence.thresholds.frequency_accuracy_hz.value / requirement.rocof_window_s.value
    )
    by = f"beyond {limit.value:g} Hz/s the code"
    return [Demand(float(evidence.t_s[too_fast[0]]), 0.0, by, requirement.bands.clause, limit)] if len(too_fast) else []


def _rate_in_words(requirement: FrequencyRideThrough, rate: Samples | None) -> str:
    if rate is None or requirement.rocof_window_s is None or not np.isfinite(rate).any():
        return ""
    return f", fastest {np.nanmax(rate):.2f} Hz/s over {requirement.rocof_window_s.value:g} s"
