"""What all limits of the voltage together demand of the connection, and when they let the inverter go."""

from typing import NamedTuple

from pvlvrt_compliance.checks.connection.demand import Demand
from pvlvrt_compliance.checks.connection.envelopes import Limit, deciding_envelope, envelope_limits
from pvlvrt_compliance.checks.connection.regions import Visit, region_limits, visits
from pvlvrt_compliance.data.marks import Marked
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.profile.requirements import RideThrough


class Limits(NamedTuple):
    """Envelopes and regions as they apply to a record, by the voltage without the inverter's current."""

    limits: tuple[Limit, ...]
    visits: list[Visit]
    clause: str
    mark: Marked

    @property
    def release(self) -> Demand | None:
        """The first that lets the inverter go, None when none does."""
        found = [limit.release for limit in self.limits if limit.release is not None]
        return min(found, key=lambda demand: demand.until_s, default=None)

    def demand_at(self, at_s: float) -> Demand | None:
        """The shortest time that the voltage at an instant would have to be ridden through, had it gone on."""
        found = [demand for limit in self.limits if (demand := limit.demand_at(at_s)) is not None]
        ahead = [demand for demand in found if at_s < demand.until_s < float("inf")]
        return min(ahead, key=lambda demand: demand.until_s, default=None)

    def whole(self, evidence: Evidence, stopped_at_s: float | None = None) -> Demand:
        """Ride through the disturbance from its start to its end.

        Parameters
        ----------
        stopped_at_s : float, optional
            When the inverter let go (s), None of one that stayed. Had the voltage let it go by then, or did no voltage
            move at all, the row of the test table alone demands it.
        """
        grid, release = evidence.disturbance, self.release
        by = "the test" if evidence.expect == "ride_through" else "a voltage within its limits"
        if not self.limits:
            by = "the profile, which has no envelope,"
        uncertain_s = evidence.thresholds.uncertainty_instant_s.value
        demand = Demand(grid.start_s, grid.end_s - grid.start_s, by, self.clause, self.mark, uncertain_s)
        at_s = grid.end_s if stopped_at_s is None else stopped_at_s
        let_go = not grid.voltage_steps_s or (release is not None and release.until_s <= at_s)
        return demand.of_row_alone(evidence) if let_go and at_s <= grid.end_s else demand


def limits_of(requirement: RideThrough, evidence: Evidence) -> Limits:
    """What envelopes and regions demand in a record.

    Raises
    ------
    MeasurementError
        When a voltage is missing or not finite.
    """
    return evidence.once_for(requirement, "limits", lambda: _made(requirement, evidence))


def _made(requirement: RideThrough, evidence: Evidence) -> Limits:
    limits, found = envelope_limits(requirement, evidence), []
    if requirement.regions is not None:
        tolerance_pu = requirement.envelope_tolerance_pu.value
        found = visits(requirement.regions, tolerance_pu, evidence, "no_load")
        limits += region_limits(requirement.regions, found, evidence)
    decides = deciding_envelope(requirement, evidence) or requirement.regions
    clause = requirement.clause if decides is None else decides.clause or requirement.clause
    return Limits(tuple(limits), found, clause, decides or requirement.envelope_tolerance_pu)


def released_at_s(requirement: RideThrough, evidence: Evidence) -> float | None:
    """When the voltage's limits let the inverter go (s), None when they never do.

    Of a row that asks for all of its disturbance, only where the voltage is not normal after that, and not before.

    Raises
    ------
    MeasurementError
        When a voltage is missing or not finite.
    """
    release = limits_of(requirement, evidence).release
    if release is None:
        return None
    if evidence.expect != "ride_through":
        return release.until_s
    end_s = evidence.disturbance.end_s
    return None if evidence.disturbance.is_normal(end_s) else max(release.until_s, end_s)
