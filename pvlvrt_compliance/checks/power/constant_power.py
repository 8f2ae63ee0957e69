"""The active power stays free of ripple at twice the grid frequency during a sag."""

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.verdicts import judged_at_most
from pvlvrt_compliance.evidence.evidence import Evidence, required
from pvlvrt_compliance.profile.requirements import ConstantPower
from pvlvrt_compliance.results import Verdict

KIND = "constant_power"


class ConstantPowerCheck(Check):
    """Judges the ripple of P at twice the grid frequency during the sag, as a fraction of rated power."""

    kind = KIND
    title = "Ripple of the active power"
    requirement = ConstantPower

    def judge(self, requirement: ConstantPower, evidence: Evidence) -> Verdict:
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
        measured = required(window.active_power_2f_kw, "the ripple of P")
        limit = requirement.limit_fraction.value * evidence.nominal.apparent_power_kva
        return judged_at_most(
            KIND,
            requirement,
            f"double-frequency ripple of P over {window.start_s:.3f} s to {window.end_s:.3f} s has an amplitude of "
            f"{measured:.2f} kW; the limit is {limit:.2f} kW",
            measured=measured,
            limit=limit,
            unit="kW",
            at_s=window.start_s,
            rests_on=(requirement.limit_fraction,),
        )
