"""The DC voltage stays free of ripple at twice the grid frequency."""

from collections.abc import Iterator, Sequence

from pvlvrt_compliance.checks.check import StretchCheck
from pvlvrt_compliance.checks.limits import about_the_line, of_each
from pvlvrt_compliance.checks.verdicts import judged_at_most
from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.evidence.evidence import Evidence, require_finite, required
from pvlvrt_compliance.measure.quantities import WindowMeasurements
from pvlvrt_compliance.measure.swing import swing
from pvlvrt_compliance.profile.requirements import DcRipple
from pvlvrt_compliance.results import Band, Verdict
from pvlvrt_compliance.results.band import DC_VOLTAGE

KIND = "dc_ripple"


class DcRippleCheck(StretchCheck):
    """Judges the ripple of v_DC at twice the grid frequency in the stretch's window, in percent of its mean."""

    kind = KIND
    title = "Ripple of the DC voltage"
    requirement = DcRipple
    until = "trip"

    def stretches(self, requirement: DcRipple, evidence: Evidence) -> Sequence[Stretch]:  # noqa: ARG002
        """Those at another voltage than before; of a test that leaves the voltage alone, all."""
        return evidence.departed_until(self.until)

    def judge_stretch(self, requirement: DcRipple, evidence: Evidence, stretch: Stretch) -> Verdict:
        """Judge the amplitude of the double-frequency component of v_DC in the stretch's window.

        A component over a window has no worst instant: the verdict points to where the window begins.

        Raises
        ------
        NotApplicable
            When something moves in the stretch, or it is too short for a window.
        MeasurementError
            When v_DC cannot be measured in it.
        """
        window = evidence.window_of(stretch)
        inside = evidence.samples(window.start_s, window.end_s)
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

    def limits(self, requirement: DcRipple, evidence: Evidence) -> tuple[Band, ...]:
        """The largest ripple about the straight line of v_DC, in each window."""

        def bands(window: WindowMeasurements) -> Iterator[Band]:
            inside = evidence.samples(window.start_s, window.end_s)
            mean = required(window.dc_voltage_mean_v, "v_DC")
            room = 2 * requirement.limit_percent.value / 100 * mean
            t_s = evidence.t_s[inside]
            found = swing(t_s, evidence.dc_voltage_v[inside], evidence.step_s[inside])
            yield about_the_line(KIND, DC_VOLTAGE, "ripple", (float(t_s[0]), float(t_s[-1])), found.ends, room)

        return of_each(evidence.windows_of(self.stretches(requirement, evidence)), bands)
