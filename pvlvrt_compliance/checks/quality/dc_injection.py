"""The inverter feeds no direct current into the grid."""

import numpy as np

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.quality.steady import steady_currents
from pvlvrt_compliance.checks.verdicts import judged_at_most
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.measure.extremes import largest
from pvlvrt_compliance.measure.groups import dc_component
from pvlvrt_compliance.profile.requirements import DcInjection
from pvlvrt_compliance.results import Verdict

KIND = "dc_injection"


class DcInjectionCheck(Check):
    """Judges the direct current that each phase feeds before the disturbance, in percent of the rated current."""

    kind = KIND
    title = "Direct current into the grid"
    requirement = DcInjection
    judges_up_to_trip = True

    def judge(self, requirement: DcInjection, evidence: Evidence) -> Verdict:
        """Judge the mean of each phase current over ten or twelve cycles before the disturbance, in percent of rated.

        Raises
        ------
        MeasurementError
            When the window is shorter than that, or a current cannot be measured.
        """
        window = steady_currents(evidence)[0]
        found = np.abs(dc_component(window.current, window.dt_s, window.frequency_hz))
        most, phase = largest(found, 1.0)
        measured, limit = 100 * most, requirement.limit_percent.value
        return judged_at_most(
            KIND,
            requirement,
            f"direct current of phase {'abc'[phase]} over {window.start_s:.3f} s to {window.end_s:.3f} s is "
            f"{measured:.3f} % of the rated current; the limit is {limit:g} %",
            measured=measured,
            limit=limit,
            unit="%",
            at_s=window.start_s,
            rests_on=(requirement.limit_percent,),
        )
