"""The active power stays free of ripple at twice the grid frequency during a sag."""

from pvlvrt_compliance.checks.evidence import Evidence, required
from pvlvrt_compliance.checks.results import Check
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.profile.requirements import ConstantPower

KIND = "constant_power"


def check_constant_power(requirement: ConstantPower, evidence: Evidence) -> Check:
    """Judge the amplitude of the double-frequency component of P during the sag, in fractions of rated power.

    A component over a window has no worst instant: the verdict points to where the window begins.

    Raises
    ------
    NotApplicable
        When the sag is too short for a window.
    MeasurementError
        When P cannot be measured in it.
    """
    window = evidence.during()
    rated_kw = evidence.nominal.apparent_power_va / 1e3
    measured = required(window.active_power_2f_kw, "the ripple of P")
    limit = requirement.limit_fraction.value * rated_kw
    return judged(
        KIND,
        requirement,
        pass_or_fail(measured <= limit),
        f"double-frequency ripple of P over {window.start_s:.3f} s to {window.end_s:.3f} s has an amplitude of "
        f"{measured:.2f} kW; the limit is {limit:.2f} kW",
        measured=measured,
        limit=limit,
        margin=limit - measured,
        unit="kW",
        at_s=window.start_s,
        rests_on=(requirement.limit_fraction,),
    )
