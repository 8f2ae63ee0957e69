"""At the end of the record the inverter feeds what it fed before the disturbance."""

import math
from collections.abc import Iterator
from typing import NamedTuple

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.limits import around
from pvlvrt_compliance.checks.parts import Part, judged_by_parts
from pvlvrt_compliance.data.marks import Number
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, required
from pvlvrt_compliance.evidence.frequency import ends_at_another_frequency
from pvlvrt_compliance.profile.requirements import ReturnToPrefault
from pvlvrt_compliance.results import Band, Verdict
from pvlvrt_compliance.results.band import ACTIVE_POWER, REACTIVE_POWER

KIND = "return_to_prefault"


class ReturnToPrefaultCheck(Check):
    """Judges how far P and Q at the end of the record are from what they were before the disturbance."""

    kind = KIND
    title = "Return to the power before the fault"
    requirement = ReturnToPrefault

    def judge(self, requirement: ReturnToPrefault, evidence: Evidence) -> Verdict:
        """Judge mean P and Q of the window `after` against the window `before`; reports the one with the least margin.

        Whichever of the two the profile limits; Q also against a fraction of V+ S, with the V+ of the window `after`.

        Raises
        ------
        NotApplicable
            When the test itself ends elsewhere: another irradiance, voltage or frequency.
        MeasurementError
            When P or Q cannot be measured, or the record has no window after the disturbance.
        """
        _require_same_conditions(evidence)
        return judged_by_parts(KIND, requirement, _parts(requirement, evidence), one_unit=True)

    def limits(self, requirement: ReturnToPrefault, evidence: Evidence) -> tuple[Band, ...]:
        """P and Q of before, with the limits on either side, over the window `after`."""
        return tuple(_bands(requirement, evidence))


class _Stated(NamedTuple):
    """A limit that the profile states, in fractions of rated power."""

    name: str
    unit: str
    quantity: str  # of a window, and of a band
    limit: Number
    times: float


def _stated(requirement: ReturnToPrefault, evidence: Evidence) -> Iterator[_Stated]:
    if requirement.active_fraction is not None:
        yield _Stated("P", "kW", ACTIVE_POWER, requirement.active_fraction, 1.0)
    if requirement.reactive_fraction is not None:
        yield _Stated("Q", "kvar", REACTIVE_POWER, requirement.reactive_fraction, 1.0)
    if requirement.reactive_pu is not None:
        yield _Stated("Q", "kvar", REACTIVE_POWER, requirement.reactive_pu, _voltage_pu(evidence))


def _parts(requirement: ReturnToPrefault, evidence: Evidence) -> list[Part]:
    return [
        _part(of.name, of.unit, *_before_and_after(evidence, of.quantity), of.limit, of.times, evidence)
        for of in _stated(requirement, evidence)
    ]


def _bands(requirement: ReturnToPrefault, evidence: Evidence) -> Iterator[Band]:
    window = evidence.measurements.after
    if window is None:
        return
    for of in _stated(requirement, evidence):
        before, _ = _before_and_after(evidence, of.quantity)
        room, span = of.limit.value * of.times * evidence.nominal.apparent_power_kva, (window.start_s, window.end_s)
        yield around(KIND, of.quantity, f"{of.name} as before", span, before, room)


def _voltage_pu(evidence: Evidence) -> float:
    after = evidence.measurements.after
    return required(after.voltage_positive_pu if after else None, "V+ at the end of the record")


def _part(name: str, unit: str, before: float, after: float, limit: Number, times: float, evidence: Evidence) -> Part:
    window = evidence.measurements.after
    return Part(
        what=f"{name} is {after:.1f} {unit} at the end and was {before:.1f} {unit} before the disturbance, distance in "
        "fractions of rated power",
        measured=abs(after - before) / evidence.nominal.apparent_power_kva,
        limit=limit.value * times,
        unit="pu",
        at_s=window.start_s if window else evidence.waveforms.end_s,
        rests_on=(limit,),
        uncertainty=evidence.thresholds.uncertainty_power_pu.value,
    )


def _before_and_after(evidence: Evidence, name: str) -> tuple[float, float]:
    before, after = evidence.measurements.before, evidence.measurements.after
    what = "P" if name.startswith("active") else "Q"
    return (
        required(getattr(before, name, None), f"{what} before the disturbance"),
        required(getattr(after, name, None), f"{what} at the end of the record"),
    )


def _require_same_conditions(evidence: Evidence) -> None:
    grid = evidence.disturbance
    if grid.irradiance_w_m2 is not None and not math.isclose(*grid.irradiance_w_m2):
        raise NotApplicable("the irradiance at the end is not that of the beginning")
    if not grid.is_normal(evidence.waveforms.end_s if grid.record_end_s is None else grid.record_end_s):
        raise NotApplicable("the voltage does not come back in this test")
    if (found := ends_at_another_frequency(evidence)) is not None:
        raise NotApplicable(f"the frequency ends at {found[1]:.2f} Hz and began at {found[0]:.2f} Hz")
