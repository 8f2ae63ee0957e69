"""At the end of the record the inverter feeds what it fed before the disturbance."""

import math
from typing import NamedTuple

from pvlvrt_compliance.checks.disturbances import is_voltage_normal
from pvlvrt_compliance.checks.evidence import Evidence, NotApplicable, required
from pvlvrt_compliance.checks.frequency_series import DEVIATION_HZ
from pvlvrt_compliance.checks.results import Check
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.profile.provenance import Number
from pvlvrt_compliance.profile.requirements import ReturnToPrefault
from pvlvrt_compliance.scenario.timeline import irradiance_points

KIND = "return_to_prefault"


class _Part(NamedTuple):
    """Active or reactive power, before and after (kW or kvar)."""

    name: str
    unit: str
    before: float
    after: float
    limit: Number

    def distance_pu(self, rated_kva: float) -> float:
        return abs(self.after - self.before) / rated_kva

    def margin_pu(self, rated_kva: float) -> float:
        return self.limit.value - self.distance_pu(rated_kva)


def check_return_to_prefault(requirement: ReturnToPrefault, evidence: Evidence) -> Check:
    """Judge mean P and Q of the window `after` against the window `before`; reports the one with the least margin.

    Raises
    ------
    NotApplicable
        When the test itself ends elsewhere: another irradiance, voltage or frequency.
    MeasurementError
        When P or Q cannot be measured, or the record has no window after the disturbance.
    """
    _require_same_conditions(evidence)
    rated_kva = evidence.nominal.apparent_power_va / 1e3
    part = min(_parts(requirement, evidence), key=lambda part: part.margin_pu(rated_kva))
    distance_pu, margin_pu = part.distance_pu(rated_kva), part.margin_pu(rated_kva)
    after = evidence.measurements.after
    return judged(
        KIND,
        requirement,
        pass_or_fail(margin_pu >= 0),
        f"{part.name} is {part.after:.1f} {part.unit} at the end and was {part.before:.1f} {part.unit} before the "
        f"disturbance, {100 * distance_pu:.2f} % of rated power apart; {100 * part.limit.value:g} % is allowed",
        measured=distance_pu,
        limit=part.limit.value,
        margin=margin_pu,
        unit="pu",
        at_s=after.start_s if after else evidence.waveforms.end_s,
        rests_on=(part.limit,),
    )


def _parts(requirement: ReturnToPrefault, evidence: Evidence) -> list[_Part]:
    return [
        _Part("P", "kW", *_before_and_after(evidence, "active_power_kw"), requirement.active_fraction),
        _Part("Q", "kvar", *_before_and_after(evidence, "reactive_power_kvar"), requirement.reactive_fraction),
    ]


def _before_and_after(evidence: Evidence, name: str) -> tuple[float, float]:
    before, after = evidence.measurements.before, evidence.measurements.after
    what = "P" if name.startswith("active") else "Q"
    return (
        required(getattr(before, name, None), f"{what} before the disturbance"),
        required(getattr(after, name, None), f"{what} at the end of the record"),
    )


def _require_same_conditions(evidence: Evidence) -> None:
    scenario = evidence.scenario
    irradiance = irradiance_points(scenario)
    if not math.isclose(irradiance[-1][1], irradiance[0][1]):
        raise NotApplicable("the irradiance at the end is not that of the beginning")
    if not is_voltage_normal(scenario, scenario.end_s):
        raise NotApplicable("the voltage does not come back in this test")
    before, after = evidence.measurements.before, evidence.measurements.after
    first, last = (window.frequency_hz if window else None for window in (before, after))
    if first is not None and last is not None and abs(last - first) > DEVIATION_HZ:
        raise NotApplicable(f"the frequency ends at {last:.2f} Hz and began at {first:.2f} Hz")
