"""Active power falls with the frequency above a threshold: LFSM-O."""

import numpy as np

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.limits import along, stretches_of
from pvlvrt_compliance.checks.verdicts import judged_at_most
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, require_finite
from pvlvrt_compliance.evidence.excursions import excursions
from pvlvrt_compliance.evidence.frequency import frequency_hz
from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.measure.extremes import largest
from pvlvrt_compliance.profile.requirements import OverfrequencyPower
from pvlvrt_compliance.results import Characteristic, Drawn, Verdict
from pvlvrt_compliance.results.band import ACTIVE_POWER, FREQUENCY
from pvlvrt_compliance.waveforms.container import Samples

KIND = "overfrequency_power"


class OverfrequencyPowerCheck(Check):
    """Judges how far P is from the droop that it must follow while the frequency is above a threshold."""

    kind = KIND
    title = "Active power at over-frequency"
    requirement = OverfrequencyPower
    judges_up_to_trip = True

    def judge(self, requirement: OverfrequencyPower, evidence: Evidence) -> Verdict:
        """Judge the one-cycle mean of P wherever the frequency has been above the threshold for the time of activation.

        P must be P_before (1 - (f - threshold) / (droop f_nominal)), not below 0, within the tolerance on either side.
        Up to a trip. Reports the instant that lies furthest off.

        Raises
        ------
        NotApplicable
            When the frequency never exceeds the threshold, or not for long enough before a trip.
        MeasurementError
            When P or the frequency cannot be measured.
        """
        frequency = frequency_hz(evidence)
        active = _active(requirement, evidence, frequency)
        t_s = evidence.t_s[active]
        power_kw = require_finite(evidence.active_power_kw[active], "P", t_s)
        wanted_kw = demanded_kw(requirement, evidence, frequency[active])
        off_kw = np.abs(power_kw - wanted_kw)
        rated_kva = evidence.nominal.apparent_power_kva
        furthest_kw, worst = largest(off_kw, rated_kva)
        limit_kw = requirement.tolerance_fraction.value * rated_kva
        return judged_at_most(
            KIND,
            requirement,
            f"P is {power_kw[worst]:.1f} kW at {frequency[active][worst]:.3f} Hz, {furthest_kw:.1f} kW from the "
            f"{wanted_kw[worst]:.1f} kW that the droop asks for; {limit_kw:.1f} kW is allowed",
            measured=furthest_kw,
            limit=limit_kw,
            unit="kW",
            at_s=t_s[worst],
            rests_on=(
                requirement.threshold_hz,
                requirement.droop_fraction,
                requirement.activation_s,
                requirement.tolerance_fraction,
            ),
            uncertainty=evidence.power_uncertainty_kva,
        )

    def limits(self, requirement: OverfrequencyPower, evidence: Evidence) -> tuple[Drawn, ...]:
        """What the droop asks for, less and more the tolerance: wherever P has to follow it, and over the frequency."""
        frequency = frequency_hz(evidence)
        wanted_kw = demanded_kw(requirement, evidence, frequency)
        room_kw = requirement.tolerance_fraction.value * evidence.nominal.apparent_power_kva
        active = _active(requirement, evidence, frequency)
        over_time = (
            along(
                KIND,
                ACTIVE_POWER,
                "P by the droop",
                evidence.t_s[part],
                lower=wanted_kw[part] - room_kw,
                upper=wanted_kw[part] + room_kw,
            )
            for part in stretches_of(active)
        )
        return (*over_time, _droop(requirement, evidence, float(frequency[active].max()), room_kw))


def _droop(requirement: OverfrequencyPower, evidence: Evidence, highest_hz: float, room_kw: float) -> Characteristic:
    """The droop from its threshold up to the highest frequency that P had to follow."""
    threshold_hz = requirement.threshold_hz.value
    none_left_hz = threshold_hz + requirement.droop_fraction.value * evidence.nominal.frequency_hz
    x = np.unique(np.minimum((threshold_hz, none_left_hz, highest_hz), highest_hz))
    wanted_kw = demanded_kw(requirement, evidence, x)
    return Characteristic(
        check=KIND,
        over=FREQUENCY,
        quantity=ACTIVE_POWER,
        name="P by the droop",
        x=tuple(x.tolist()),
        lower=tuple((wanted_kw - room_kw).tolist()),
        upper=tuple((wanted_kw + room_kw).tolist()),
    )


def demanded_kw(requirement: OverfrequencyPower, evidence: Evidence, frequency: Samples) -> Samples:
    """Power that the droop asks for at frequencies above the threshold (kW), shape of ``frequency`` (Hz)."""
    above_hz = frequency - requirement.threshold_hz.value
    share = 1 - above_hz / (requirement.droop_fraction.value * evidence.nominal.frequency_hz)
    demanded: Samples = evidence.starting_power_kw * np.maximum(share, 0.0)
    return demanded


def _active(requirement: OverfrequencyPower, evidence: Evidence, frequency: Samples) -> Mask:
    threshold, activation_s = requirement.threshold_hz.value, requirement.activation_s.value
    tripped_s = evidence.known_opening_s
    above = frequency > threshold
    if tripped_s is not None:
        above[int(np.searchsorted(evidence.t_s, tripped_s)) :] = False
    found = excursions(above, evidence.t_s)
    if not found:
        when = "" if tripped_s is None else f" before the trip at {tripped_s:.3f} s"
        raise NotApplicable(f"the frequency never exceeds {threshold:g} Hz{when}")
    active = np.zeros(len(evidence.t_s), dtype=np.bool_)
    for begin_s, end_s in found:
        first = int(np.searchsorted(evidence.t_s, begin_s + activation_s, "right"))
        active[first : int(np.searchsorted(evidence.t_s, end_s))] = True
    if tripped_s is not None:
        active[int(np.searchsorted(evidence.t_s, tripped_s)) :] = False
    if not active.any():
        raise NotApplicable(
            f"the frequency exceeds {threshold:g} Hz for less than the {activation_s:g} s of activation"
            + ("" if tripped_s is None else f" before the trip at {tripped_s:.3f} s")
        )
    return active
