"""The active power stays free of ripple at twice the grid frequency during a sag."""

from collections.abc import Sequence

from pvlvrt_compliance.checks.check import StretchCheck
from pvlvrt_compliance.checks.limits import around
from pvlvrt_compliance.checks.verdicts import judged_at_most
from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.evidence.evidence import Evidence, required
from pvlvrt_compliance.profile.requirements import ConstantPower
from pvlvrt_compliance.results import Band, Verdict
from pvlvrt_compliance.results.band import ACTIVE_POWER

KIND = "constant_power"


class ConstantPowerCheck(StretchCheck):
    """Judges the ripple of P at twice the grid frequency in each stretch of a sag, as a fraction of rated power."""

    kind = KIND
    title = "Ripple of the active power"
    requirement = ConstantPower
    until = "trip"

    def stretches(self, requirement: ConstantPower, evidence: Evidence) -> Sequence[Stretch]:  # noqa: ARG002
        """Those at another voltage than before; of a test that leaves the voltage alone, all."""
        return evidence.departed_until(self.until)

    def judge_stretch(self, requirement: ConstantPower, evidence: Evidence, stretch: Stretch) -> Verdict:
        """Judge the amplitude of the double-frequency component of P in the stretch's window.

        A component over a window has no worst instant: the verdict points to where the window begins.

        Raises
        ------
        NotApplicable
            When something moves in the stretch, or it is too short for a window.
        MeasurementError
            When P cannot be measured in it.
        """
        window = evidence.window_of(stretch)
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
            uncertainty=evidence.power_uncertainty_kva,
        )

    def limits(self, requirement: ConstantPower, evidence: Evidence) -> tuple[Band, ...]:
        """The largest ripple about the mean of P, in each window."""
        room = requirement.limit_fraction.value * evidence.nominal.apparent_power_kva
        return tuple(
            around(KIND, ACTIVE_POWER, "ripple of P", (window.start_s, window.end_s), mean, room)
            for window in evidence.windows_of(self.stretches(requirement, evidence))
            if (mean := window.active_power_kw) is not None
        )
