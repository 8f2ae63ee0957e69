"""One check alone on one record: for the tests of whoever writes a check."""

import inspect
from typing import cast

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.judging import judge_safely
from pvlvrt_compliance.checks.registry import FunctionCheck, Judge, find_check
from pvlvrt_compliance.disturbance.asked import Given, as_disturbance
from pvlvrt_compliance.evidence.collect import normal_voltage
from pvlvrt_compliance.evidence.evidence import Evidence, floors_of
from pvlvrt_compliance.measure.summary import measure
from pvlvrt_compliance.measure.windows import STANDARD_RULES, WindowRules
from pvlvrt_compliance.profile.procedure import Detection
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.profile.thresholds import STANDARD_THRESHOLDS, Thresholds
from pvlvrt_compliance.results import Verdict
from pvlvrt_compliance.units import Nominal, nearest_nominal_frequency
from pvlvrt_compliance.waveforms.container import Waveforms

BLOCKED_BELOW_PU = 0.01
"""What the shipped profiles say of a blocked bridge (pu)."""


def judge_alone(
    check: str | type[Check] | Check | Judge,
    requirement: Requirement,
    waveforms: Waveforms,
    disturbance: Given,
    *,
    nominal: Nominal | None = None,
    available_power_w: float | None = None,
    rules: WindowRules = STANDARD_RULES,
    blocked_below_pu: float = BLOCKED_BELOW_PU,
    k_factor: float | None = None,
    detection: Detection | None = None,
    thresholds: Thresholds = STANDARD_THRESHOLDS,
) -> Verdict:
    """Judge a record by one check, without a profile.

    Nothing else is looked at: neither whether the test began as it was meant to, nor whether the inverter stopped.

    Parameters
    ----------
    check : str, class or object
        The requirement's kind (built in, or of an installed package), or the check itself, which needs no entry point
        then; also a function ``(requirement, evidence) -> Verdict``.
    requirement : Requirement
        What is demanded.
    waveforms : Waveforms
        The record, made by hand, simulated or read from a file.
    disturbance : Disturbance or Scenario
        What the grid did, or what it was asked for; times count from the start of the record.
    nominal : Nominal, optional
        Base of the per-unit values; by default 500 kVA, 230 V, and 50 or 60 Hz as the disturbance.
    available_power_w : float, optional
        What the array could give before the disturbance (W); by default the rated power.
    rules, blocked_below_pu, k_factor, detection, thresholds
        What a profile says besides, as in `Evidence`.

    Returns
    -------
    Verdict
        What the check raises becomes one, as in a run.

    Raises
    ------
    LookupError
        When no installed package has a check for the kind.
    """
    disturbance = as_disturbance(disturbance, normal_voltage(thresholds))
    nominal = nominal or Nominal(frequency_hz=nearest_nominal_frequency(disturbance.stretches[0].frequency_hz or 50.0))
    evidence = Evidence(
        waveforms=waveforms,
        nominal=nominal,
        disturbance=disturbance,
        available_power_w=nominal.apparent_power_va if available_power_w is None else available_power_w,
        measurements=measure(
            waveforms, nominal, disturbance.start_s, disturbance.clear_s, rules, floors_of(thresholds)
        ),
        rules=rules,
        blocked_below_pu=blocked_below_pu,
        k_factor=k_factor,
        detection=detection,
        thresholds=thresholds,
    )
    return judge_safely(_check(check), requirement, evidence)


def _check(given: str | type[Check] | Check | Judge) -> Check:
    if isinstance(given, str):
        found = find_check(given)
        if found is None:
            raise LookupError(f"no installed package has a check for the requirement {given!r}")
        return found
    if isinstance(given, Check):
        return given
    if inspect.isclass(given):
        return cast(type[Check], given)()
    return FunctionCheck(getattr(given, "__name__", "check").removeprefix("check_"), given)
