"""A demand to stay connected for a time, and the verdict on how long the inverter stayed."""

from typing import NamedTuple

from pvlvrt_compliance.checks.verdicts import judged
from pvlvrt_compliance.data.marks import Marked
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.results import Status, Verdict

_AS_LONG_S = 1e-3  # what lasts as long as is demanded, but for rounding


class Demand(NamedTuple):
    """Stay connected for a time from an instant of the record on."""

    since_s: float
    stay_s: float
    by: str  # what demands it, in words
    clause: str
    mark: Marked
    uncertain_s: float = 0.0  # what is open about the time demanded

    @property
    def until_s(self) -> float:
        """Instant from which the inverter may let go (s)."""
        return self.since_s + self.stay_s

    @property
    def in_words(self) -> str:
        """What demands how much, as a message says it."""
        return f"{self.by} demands {self.stay_s:.3f} s"

    def of_row_alone(self, evidence: Evidence) -> "Demand":
        """The same with clause and mark of the row of the test table, where one demands all of its disturbance."""
        if evidence.expect != "ride_through" or evidence.row is None:
            return self
        return self._replace(clause=evidence.row.clause, mark=evidence.row)

    def at_most(self, until_s: float) -> "Demand":
        """The same, no longer than to an instant of the record (s)."""
        stay_s = min(self.stay_s, until_s - self.since_s)
        cut = self.stay_s - stay_s > _AS_LONG_S
        return self._replace(stay_s=stay_s, by=f"{self.by}, up to clearing," if cut else self.by)


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
        bound="at_least",
        uncertainty=demand.uncertain_s,
    )


def failed_throughout(
    kind: str, requirement: Requirement, message: str, demand: Demand, *, stopped_at_s: float
) -> Verdict:
    """Verdict on an inverter that let go where connection is demanded for ever: there is no time to hold it against."""
    found = judged_stay(kind, requirement, Status.FAIL, message, demand, stopped_at_s=stopped_at_s)
    return found.model_copy(update={"limit": None, "margin": None, "uncertainty": None})
