"""Edges of frequency: bands and rates that must be ridden through, and power over frequency."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from edges.edge import FAIL, LET_OFF, LONG_S, PASS, RATED_KVA, STEP_S, Edge, Record, Statuses, hz, record
from pvlvrt_compliance.profile import Profile
from pvlvrt_compliance.profile.requirements import FrequencyRideThrough, OverfrequencyPower

ACCURACY_HZ = 0.010
"""Nearer to a limit is on it."""

F_HZ = 0.003
"""Distance in frequency."""


def frequency_ride_through(demand: FrequencyRideThrough, profile: Profile) -> Iterator[Edge]:
    """Time and edges of each band, and the rate. The bands are judged without the rate, which a step would exceed."""
    nominal_hz = hz(profile)
    rows = demand.bands.rows
    alone = {"rocof_hz_s": None, "rocof_window_s": None}
    for row in rows:
        if row.ride_s is not None:
            low = row.frequency_hz[1] <= nominal_hz
            near_hz = row.frequency_hz[1 if low else 0] + (-ACCURACY_HZ if low else ACCURACY_HZ)
            in_band_hz, on_edge_hz = near_hz + (-F_HZ if low else F_HZ), near_hz + (F_HZ if low else -F_HZ)
            late_s = row.ride_s + 2.1 / nominal_hz + _step_s(row.ride_s, nominal_hz)
            freed = _step(PASS, in_band_hz, late_s, nominal_hz)
            early_s = row.ride_s - _step_s(row.ride_s, nominal_hz)
            label = f"{row.frequency_hz[0]:g} to {row.frequency_hz[1]:g} Hz"
            early = _step(FAIL, in_band_hz, early_s, nominal_hz)
            beside = _step(FAIL, on_edge_hz, late_s, nominal_hz)
            yield Edge(label, ("bands",), freed, early, alone, further=beside)
    for edge_hz, sign in ((rows[0].frequency_hz[0], -1), (rows[-1].frequency_hz[1], 1)):
        far_hz = edge_hz + sign * ACCURACY_HZ
        sides = (_step(s, far_hz + sign * by, 0.5, nominal_hz) for s, by in ((LET_OFF, F_HZ), (FAIL, -F_HZ)))
        yield Edge(f"{edge_hz:g} Hz, last edge", ("bands",), *sides, alone)
    if demand.rocof_hz_s is not None and demand.rocof_window_s is not None:
        yield from _rates(demand.rocof_hz_s.value, demand.rocof_window_s.value)


def _step_s(time_s: float, nominal_hz: float) -> float:
    """Distance in time: two samples."""
    return 2 / (8 * nominal_hz) if time_s > LONG_S else STEP_S


def _step(statuses: Statuses, to_hz: float, trip_s: float, nominal_hz: float) -> Record:
    events = {"events": [{"kind": "frequency_step", "t_s": 0.0, "to_hz": to_hz}]}
    settings: dict[str, Any] = {"p_sag_kw": RATED_KVA, "disconnected_after_s": trip_s}
    if trip_s > LONG_S:
        settings["dt_s"] = 1 / (8 * nominal_hz)
    return record(statuses, duration_s=trip_s + 0.5, scenario=events, **settings)


def _rates(rate_hz_s: float, window_s: float) -> Iterator[Edge]:
    """The rate for longer than the window, and twice the rate for half of it; either way."""
    limit = rate_hz_s + 2 * ACCURACY_HZ / window_s
    for sign in (-1, 1):
        for label, factor, lasts_s in (("rate", 1.0, 1.2 * window_s), ("rate over the window", 2.0, 0.5 * window_s)):
            sides = []
            for statuses, by in ((LET_OFF, 1.01), (FAIL, 0.99)):
                ramp = {"kind": "frequency_ramp", "t_s": 0.0, "rate_hz_s": sign * factor * by * limit}
                scenario = {"events": [ramp | {"duration_s": lasts_s}]}
                trip_s = lasts_s + window_s + 0.1
                sides.append(
                    record(
                        statuses,
                        duration_s=trip_s + 0.4,
                        scenario=scenario,
                        p_sag_kw=RATED_KVA,
                        disconnected_after_s=trip_s,
                    )
                )
            yield Edge(f"{label}, {sign * factor * rate_hz_s:g} Hz/s", ("rocof_hz_s", "rocof_window_s"), *sides)


def overfrequency_power(demand: OverfrequencyPower, profile: Profile) -> Iterator[Edge]:
    """P on either side of the droop at two frequencies, at the threshold, and late."""
    threshold, droop = demand.threshold_hz.value, demand.droop_fraction.value
    activation_s = demand.activation_s.value
    tolerance_kw = demand.tolerance_fraction.value * RATED_KVA
    nominal_hz = hz(profile)

    def wanted_kw(f_hz: float) -> float:
        return RATED_KVA * (1 - (f_hz - threshold) / (droop * nominal_hz))

    def stepped(statuses: Statuses, f_hz: float, p_kw: float, from_s: float = 0.5, lasts_s: float = 0.0) -> Record:
        events = {"events": [{"kind": "frequency_step", "t_s": 0.0, "to_hz": f_hz}]}
        power = lambda t: np.where(t < from_s, RATED_KVA, p_kw)  # noqa: E731
        return record(statuses, duration_s=(lasts_s or activation_s) + 0.5, scenario=events, p_kw=power)

    names = ("threshold_hz", "droop_fraction", "tolerance_fraction")
    for f_hz in (threshold + 0.3, threshold + 0.8):
        for sign in (-1, 1):
            levels = [wanted_kw(f_hz) + sign * (tolerance_kw + by) for by in (-0.2, 0.2)]
            sides = (stepped(s, f_hz, p_kw) for s, p_kw in zip((PASS, FAIL), levels, strict=True))
            yield Edge(f"{sign * tolerance_kw:+g} kW at {f_hz:g} Hz", names, *sides)
    far_kw = RATED_KVA - 2 * tolerance_kw
    inside = stepped(LET_OFF, threshold - F_HZ, far_kw)
    yield Edge("threshold", ("threshold_hz",), inside, stepped(FAIL, threshold + F_HZ, far_kw))
    # P falls in one step, so that its mean is within the tolerance a part of a cycle later.
    f_hz = threshold + 0.8
    fall_kw = RATED_KVA - wanted_kw(f_hz)
    late_s = activation_s - (fall_kw - tolerance_kw) / fall_kw / f_hz
    # The frequency is known to be above the threshold a part of two cycles after the step.
    sides = (stepped(s, f_hz, wanted_kw(f_hz), late_s + by) for s, by in ((PASS, 0.0), (FAIL, 2.1 / nominal_hz)))
    yield Edge("activation", ("activation_s",), *sides)
