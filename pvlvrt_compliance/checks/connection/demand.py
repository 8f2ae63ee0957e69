"""A demand to stay connected for a time, and the verdict on how long the inverter stayed."""

from typing import NamedTuple

from pvlvrt_compliance.checks.verdicts import judged
from pvlvrt_compliance.data.marks import Marked
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.results import Status, Verdict


class Demand(NamedTuple):
    """Stay connected for a time from an instant of the record on."""

    since_s: float
    stay_s: float
    by: str  # what demands it, in words
    clause: str
    mark: Marked

    @property
    def until_s(self) -> float:
        """Instant from which the inverter may let go (s)."""
        return self.since_s + self.stay_s


def judged_stay(
    kind: str, requirement: Requirement, status: Status, message: str, demand: Demand, *, stopped_at_s: float
) -> Verdict:
    """Verdict on the time until the inverter let go, against the time demanded.

    Parameters
    ----------
    stopped_at_s : float
        When it let go, or of one that stayed, the end of what was looked at (s, from the start of the record).
    """
    connected_s = stopped_at_s - demand.since_s
    return judged(
        kind,
        requirement,
        status,
        message,
        measured=connected_s,
        limit=demand.stay_s,
        margin=connected_s - demand.stay_s,
        unit="s",
        at_s=stopped_at_s,
        rests_on=[demand.mark],
        clause=demand.clause,
    )
