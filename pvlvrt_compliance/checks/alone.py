"""One check alone on one record: for the tests of whoever writes a check."""

from pvlvrt_compliance.checks.evidence import Evidence
from pvlvrt_compliance.checks.judging import judge_safely
from pvlvrt_compliance.checks.registry import Judge, find_judge
from pvlvrt_compliance.checks.results import Check
from pvlvrt_compliance.measure.summary import measure
from pvlvrt_compliance.measure.windows import STANDARD_RULES, WindowRules
from pvlvrt_compliance.profile.procedure import Detection
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Waveforms

BLOCKED_BELOW_PU = 0.01
"""What the shipped profiles say of a blocked bridge (pu)."""


def judge_alone(
    judge: str | Judge,
    requirement: Requirement,
    waveforms: Waveforms,
    scenario: Scenario,
    *,
    nominal: Nominal | None = None,
    available_power_w: float | None = None,
    rules: WindowRules = STANDARD_RULES,
    blocked_below_pu: float = BLOCKED_BELOW_PU,
    k_factor: float | None = None,
    detection: Detection | None = None,
) -> Check:
    """Judge a record by one check, without a profile.

    Nothing else is looked at: neither whether the test began as it was meant to, nor whether the inverter stopped.

    Parameters
    ----------
    judge : str or callable
        The requirement's kind (built in, or of an installed package), or the function itself,
        ``(requirement, evidence) -> Check``, which needs no entry point then.
    requirement : Requirement
        What is demanded; a `CustomRequirement` for a check of another package.
    waveforms : Waveforms
        The record, made by hand, simulated or read from a file.
    scenario : Scenario
        What was applied; its times count from the start of the record.
    nominal : Nominal, optional
        Base of the per-unit values; by default 500 kVA, 230 V, and 50 or 60 Hz as the scenario.
    available_power_w : float, optional
        What the array could give before the sag (W); by default the rated power.
    rules, blocked_below_pu, k_factor, detection
        What a profile says besides, as in `Evidence`.

    Returns
    -------
    Check
        The verdict; what the judge raises becomes one, as in a run.

    Raises
    ------
    LookupError
        When no installed package has a check for the kind.
    """
    kind = judge if isinstance(judge, str) else getattr(judge, "__name__", "check").removeprefix("check_")
    found = find_judge(judge) if isinstance(judge, str) else judge
    if found is None:
        raise LookupError(f"no installed package has a check for the requirement {kind!r}")
    nominal = nominal or Nominal(frequency_hz=scenario.nominal_frequency_hz)
    evidence = Evidence(
        waveforms=waveforms,
        nominal=nominal,
        scenario=scenario,
        available_power_w=nominal.apparent_power_va if available_power_w is None else available_power_w,
        measurements=measure(waveforms, nominal, scenario.start_s, scenario.clear_s, rules),
        rules=rules,
        blocked_below_pu=blocked_below_pu,
        k_factor=k_factor,
        detection=detection,
    )
    return judge_safely(kind, found, requirement, evidence)
