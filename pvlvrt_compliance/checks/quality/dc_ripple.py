"""The DC voltage stays free of ripple at twice the grid frequency."""

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.verdicts import judged_at_most
from pvlvrt_compliance.evidence.evidence import Evidence, require_finite, required
from pvlvrt_compliance.profile.requirements import DcRipple
from pvlvrt_compliance.results import Verdict

KIND = "dc_ripple"


class DcRippleCheck(Check):
    """Judges the ripple of v_DC at twice the grid frequency during the sag, in percent of its mean."""

    kind = KIND
    title = "Ripple of the DC voltage"
    requirement = DcRipple

    def judge(self, requirement: DcRipple, evidence: Evidence) -> Verdict:
        """Judge the amplitude of the double-frequency component of v_DC during the sag, in percent of its mean.

        A component over a window has no worst instant: the verdict points to where the window begins.

        Raises
        ------
        NotApplicable
            When the sag is too short for a window.
        MeasurementError
            When v_DC cannot be measured in it.
        """
        window = evidence.during()
        inside = evidence.between(window.start_s, window.end_s)
        require_finite(evidence.dc_voltage_v[inside], "v_DC", evidence.t_s[inside])
        measured = required(window.dc_voltage_2f_percent, "the ripple of the DC voltage")
        limit = requirement.limit_percent.value
        return judged_at_most(
            KIND,
            requirement,
            f"double-frequency ripple of the DC voltage over {window.start_s:.3f} s to {window.end_s:.3f} s has an "
            f"amplitude of {measured:.3f} % of the mean; the limit is {limit:g} %",
            measured=measured,
            limit=limit,
            unit="%",
            at_s=window.start_s,
            rests_on=(requirement.limit_percent,),
        )
