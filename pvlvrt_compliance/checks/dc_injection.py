"""The inverter feeds no direct current into the grid."""

import numpy as np

from pvlvrt_compliance.checks.evidence import Evidence
from pvlvrt_compliance.checks.results import Check
from pvlvrt_compliance.checks.steady import steady_currents
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.measure.groups import dc_component
from pvlvrt_compliance.profile.requirements import DcInjection

KIND = "dc_injection"


def check_dc_injection(requirement: DcInjection, evidence: Evidence) -> Check:
    """Judge the mean of each phase current over ten or twelve cycles before the sag, in percent of the rated current.

    Raises
    ------
    MeasurementError
        When the window is shorter than that, or a current cannot be measured.
    """
    window = steady_currents(evidence)[0]
    found = np.abs(dc_component(window.current, window.dt_s, window.frequency_hz))
    phase = int(found.argmax())
    measured, limit = 100 * float(found[phase]), requirement.limit_percent.value
    return judged(
        KIND,
        requirement,
        pass_or_fail(measured <= limit),
        f"direct current of phase {'abc'[phase]} over {window.start_s:.3f} s to {window.end_s:.3f} s is "
        f"{measured:.3f} % of the rated current; the limit is {limit:g} %",
        measured=measured,
        limit=limit,
        margin=limit - measured,
        unit="%",
        at_s=window.start_s,
        rests_on=(requirement.limit_percent,),
    )
