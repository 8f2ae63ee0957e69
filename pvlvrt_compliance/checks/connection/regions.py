"""Limits of the voltage that are regions with modes: staying connected, ceasing and tripping there."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.checks.connection.demand import Demand
from pvlvrt_compliance.checks.connection.envelopes import Limit
from pvlvrt_compliance.evidence.evidence import Evidence, require_finite
from pvlvrt_compliance.evidence.excursions import excursions, inside_of, time_spent_s
from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.evidence.stretches import settled_pu, settling_s
from pvlvrt_compliance.evidence.voltages import NAMES, Place, voltage_quantity_pu
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.profile.curves import LARGEST_LEVEL_PU, Side
from pvlvrt_compliance.profile.regions import LinearTime, Region, RegionTable
from pvlvrt_compliance.profile.requirements import RideThrough
from pvlvrt_compliance.results import Band
from pvlvrt_compliance.results.band import voltage_band
from pvlvrt_compliance.waveforms.container import Samples

_TOP_PU, _LEAST_HEIGHT_PU = 1.4, 0.1  # where a region without an upper end ends in a figure


class Visit(NamedTuple):
    """A region in one record."""

    region: Region
    voltage_pu: Samples  # of the quantity that the region speaks of
    beyond: tuple[Span, ...]  # in it or in a worse one
    within: tuple[Span, ...]  # in it alone

    @property
    def name(self) -> str:
        """The region in words."""
        low, high = self.region.voltage_pu
        return f"the region {low:g} to {high:g} pu ({self.region.mode.replace('_', ' ')})"


def visits(table: RegionTable, tolerance_pu: float, evidence: Evidence, place: Place) -> list[Visit]:
    """What a record has of each region but the continuous one; above the last the inverter may trip.

    A voltage less than the tolerance beyond the edge of a region is not in it, nor is what a one-cycle voltage shows
    of the other side after a step.

    Raises
    ------
    MeasurementError
        When a voltage is missing or not finite.
    """
    return evidence.once_for(
        table,
        ("visits", tolerance_pu, place),
        lambda: [visit for side in Side for visit in _visits_of(table, side, tolerance_pu, evidence, place)],
    )


def region_limits(table: RegionTable, found: list[Visit], evidence: Evidence) -> list[Limit]:
    """The limit that each region is to the record."""
    return [_limit(table, visit, evidence) for visit in found]


def _visits_of(
    table: RegionTable, side: Side, tolerance_pu: float, evidence: Evidence, place: Place
) -> Iterator[Visit]:
    quantity = table.low_quantity if side is Side.LOW else table.high_quantity
    voltage_pu = voltage_quantity_pu(evidence, quantity, place)
    after_start = evidence.samples(evidence.disturbance.start_s, evidence.waveforms.end_s)
    require_finite(voltage_pu[after_start], NAMES[quantity], evidence.t_s[after_start])
    from_mild_to_worse = _by_distance(table, side)
    masks = [_beyond(region, side, voltage_pu, tolerance_pu) for region in from_mild_to_worse]
    nowhere = np.zeros(len(voltage_pu), dtype=np.bool_)
    for region, beyond, worse in zip(from_mild_to_worse, masks, [*masks[1:], nowhere], strict=True):
        yield Visit(region, voltage_pu, _stretches(beyond, evidence), _stretches(beyond & ~worse, evidence))


def _by_distance(table: RegionTable, side: Side) -> list[Region]:
    """Regions of a side, the one next to normal operation first."""
    regions = [row for row in table.rows if row.mode != "continuous" and table.side_of(row) is side]
    if side is Side.LOW:
        return regions[::-1]
    top_pu = table.rows[-1].voltage_pu[1]
    above = Region(voltage_pu=(top_pu, max(LARGEST_LEVEL_PU, 2 * top_pu)), mode="may_trip")
    return [*regions, above]


def _beyond(region: Region, side: Side, voltage_pu: Samples, tolerance_pu: float) -> Mask:
    low, high = region.voltage_pu
    return voltage_pu < high - tolerance_pu if side is Side.LOW else voltage_pu > low + tolerance_pu


def _stretches(mask: Mask, evidence: Evidence) -> tuple[Span, ...]:
    cycle_s = 1 / evidence.frequency_hz
    steps_s = evidence.disturbance.voltage_steps_s
    return tuple(excursions(mask, evidence.t_s, steps_s, lag_s=settling_s(evidence), gap_s=cycle_s))


def _limit(table: RegionTable, visit: Visit, evidence: Evidence) -> Limit:
    def demand(since_s: float, stay_s: float) -> Demand:
        uncertain_s = evidence.thresholds.uncertainty_instant_s.value
        return Demand(since_s, stay_s, visit.name, table.clause, table.mark_of(visit.region), uncertain_s)

    def demand_at(at_s: float) -> Demand | None:
        settled = settled_pu(evidence, visit.voltage_pu, at_s)
        begun_s = next((begin_s for begin_s, end_s in visit.beyond if begin_s <= at_s < end_s), None)
        if settled is None or begun_s is None:
            return None
        return demand(begun_s, float(_stay_s(visit.region, np.array([settled]))[0]))

    here = np.flatnonzero(inside_of(list(visit.beyond), evidence.t_s)) if visit.beyond else np.empty(0, dtype=np.intp)
    t_s, stay_s = evidence.t_s[here], _stay_s(visit.region, visit.voltage_pu[here])
    free = np.flatnonzero(time_spent_s(list(visit.beyond), t_s, table.cumulative_window_s) >= stay_s)
    if not len(free):
        return Limit(None, demand_at)
    first = free[0]
    return Limit(demand(float(t_s[first] - stay_s[first]), float(stay_s[first])), demand_at)


def region_bands(kind: str, requirement: RideThrough, evidence: Evidence) -> list[Band]:
    """Regions as a figure draws them: normal operation, and each that the voltage is in or beyond, as far as its time.

    Where the voltage enters a region anew, its time counts from there; times that add up are cut by what was spent.
    """
    table = requirement.regions
    if table is None:
        return []
    found = visits(table, requirement.envelope_tolerance_pu.value, evidence, "no_load")
    whole = Span(evidence.disturbance.start_s, evidence.waveforms.end_s)
    normal = _region_band(kind, table, table.continuous, whole.start_s, (whole.end_s, whole.end_s))
    return [normal, *(band for visit in found for band in _visit_bands(kind, table, visit, evidence))]


def _visit_bands(kind: str, table: RegionTable, visit: Visit, evidence: Evidence) -> Iterator[Band]:
    for begin_s, end_s in visit.beyond:
        at_s = evidence.t_s[[min(int(np.searchsorted(evidence.t_s, begin_s)), len(evidence.t_s) - 1)]]
        before_s = float(time_spent_s(list(visit.beyond), at_s, table.cumulative_window_s)[0])
        until_s = []
        for u_pu in visit.region.voltage_pu:
            ride_s = visit.region.ride_through_s(u_pu)
            free_s = begin_s + max(ride_s - before_s, 0.0) if ride_s > 0 else end_s
            until_s.append(min(free_s, evidence.waveforms.end_s))
        yield _region_band(kind, table, visit.region, begin_s, (until_s[0], until_s[1]))


def _region_band(kind: str, table: RegionTable, region: Region, begin_s: float, until_s: tuple[float, float]) -> Band:
    """One region from an instant until its time is over: at its lower and at its upper voltage (s)."""
    low, high = region.voltage_pu[0], min(region.voltage_pu[1], max(_TOP_PU, region.voltage_pu[0] + _LEAST_HEIGHT_PU))
    at_low_s, at_high_s = until_s
    first_ends_low = at_low_s <= at_high_s
    side = table.low_quantity if table.side_of(region) is Side.LOW else table.high_quantity
    return Band(
        check=kind,
        quantity=voltage_band(side),
        name=f"{region.mode.replace('_', ' ')}, {region.voltage_pu[0]:g} to {region.voltage_pu[1]:g}",
        t_s=(begin_s, *sorted(until_s)),
        lower=(low, low, high if first_ends_low else low),
        upper=(high, high, high if first_ends_low else low),
        region=region.mode,
    )


def _stay_s(region: Region, voltage_pu: Samples) -> Samples:
    """How long the inverter must stay connected at voltages in a region or beyond it (s)."""
    if not isinstance(region.ride_s, LinearTime):
        return np.full(len(voltage_pu), region.ride_through_s(region.voltage_pu[0]))
    time = region.ride_s
    return time.s + time.slope_s_per_pu * (np.clip(voltage_pu, *region.voltage_pu) - time.at_pu)
