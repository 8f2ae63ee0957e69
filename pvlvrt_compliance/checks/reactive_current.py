"""The inverter adds reactive current of the positive sequence in proportion to the change of its voltage."""

from pvlvrt_compliance.checks.evidence import Evidence
from pvlvrt_compliance.checks.k_factor import POSITIVE, check_k_factor
from pvlvrt_compliance.checks.results import Check
from pvlvrt_compliance.profile.requirements import ReactiveCurrent


def check_reactive_current(requirement: ReactiveCurrent, evidence: Evidence) -> Check:
    """Judge the positive sequence; see `check_k_factor`."""
    return check_k_factor(POSITIVE, requirement, evidence)
