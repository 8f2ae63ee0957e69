"""During a sag the inverter feeds the active power that its reactive power leaves room for."""

from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.checks.check import StretchCheck
from pvlvrt_compliance.checks.current.reactive_support import KIND as REACTIVE_SUPPORT
from pvlvrt_compliance.checks.current.reactive_support import demanded_at_pu
from pvlvrt_compliance.checks.limits import along, of_each
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, require_finite
from pvlvrt_compliance.measure.extremes import smallest
from pvlvrt_compliance.profile.requirements import ActivePowerSupport, ReactiveSupport
from pvlvrt_compliance.results import Band, Verdict
from pvlvrt_compliance.results.band import ACTIVE_POWER
from pvlvrt_compliance.waveforms.container import Samples

KIND = "active_power_support"

_STEPS = 11  # voltages at which the least of eq (10) is looked for, the two ends and the middle among them


class _Cycles(NamedTuple):
    """One-cycle quantities at each instant of a stretch."""

    t_s: Samples
    power_kw: Samples
    v_positive_pu: Samples
    v_negative_pu: Samples


_AN_INSTANT_S = 1e-6


class ActivePowerSupportCheck(StretchCheck):
    """Judges P in each sag and swell, shallow ones too, against what eq (10) leaves room for and P before."""

    kind = KIND
    title = "Active power during a sag"
    requirement = ActivePowerSupport

    def judge_stretch(self, requirement: ActivePowerSupport, evidence: Evidence, stretch: Stretch) -> Verdict:
        """Judge the one-cycle mean of P at every instant of a stretch that has settled; reports the worst.

        V+ and V- are those of the same cycle at the terminals.

        Raises
        ------
        NotApplicable
            When the voltage is normal (recovery judges that), something moves in the stretch, or it is too short.
        MeasurementError
            When P, V+ or V- cannot be measured.
        """
        settled = _settled(requirement, evidence, stretch)
        seen = _cycles(evidence, settled)
        support = _support(evidence)
        rated_kva = evidence.nominal.apparent_power_kva
        room_kw = _room_kw(requirement, evidence, settled)
        most_kw, words = min((evidence.power_before_kw, "fed before"), (_available_kw(evidence, stretch), "available"))
        due_kw = np.minimum(room_kw, most_kw)
        above_kw, worst = smallest(seen.power_kw - due_kw, rated_kva)
        limit = float(due_kw[worst])
        measured = limit + above_kw
        tolerance = requirement.tolerance_fraction.value * rated_kva
        margin = measured - (limit - tolerance)
        if room_kw[worst] <= most_kw:
            words = f"left by eq (10) within {requirement.voltage_pu.value:g} pu"
        numbers = (requirement.tolerance_fraction, requirement.voltage_pu, requirement.settling_s)
        return judged(
            KIND,
            requirement,
            pass_or_fail(margin >= 0),
            f"P over a cycle was {measured:.1f} kW at {seen.t_s[worst]:.3f} s, at V+ = {seen.v_positive_pu[worst]:.3f} "
            f"pu and V- = {seen.v_negative_pu[worst]:.3f} pu; {limit:.1f} kW are due ({words}), with a tolerance of "
            f"{tolerance:.1f} kW",
            measured=measured,
            limit=limit,
            margin=margin,
            unit="kW",
            at_s=seen.t_s[worst],
            rests_on=numbers if support is None else (*numbers, support.curve, support.no_support_from_pu),
            bound="at_least",
            tolerance=tolerance,
            uncertainty=evidence.power_uncertainty_kva,
        )

    def limits(self, requirement: ActivePowerSupport, evidence: Evidence) -> tuple[Band, ...]:
        """What is due at each instant, and the same less the tolerance."""
        tolerance = requirement.tolerance_fraction.value * evidence.nominal.apparent_power_kva

        def bands(stretch: Stretch) -> Iterator[Band]:
            settled = _settled(requirement, evidence, stretch)
            most_kw = min(evidence.power_before_kw, _available_kw(evidence, stretch))
            due_kw = np.minimum(_room_kw(requirement, evidence, settled), most_kw)
            draw = partial(along, KIND, ACTIVE_POWER, "limit of P", evidence.t_s[settled])
            yield draw(lower=due_kw)
            yield draw(lower=due_kw - tolerance, widened=True)

        return of_each(self.stretches(requirement, evidence), bands)


def _support(evidence: Evidence) -> ReactiveSupport | None:
    if evidence.requirements is None:
        return None
    found: ReactiveSupport | None = evidence.requirements.of_kind(REACTIVE_SUPPORT)
    return found


def _room_kw(requirement: ActivePowerSupport, evidence: Evidence, settled: slice) -> Samples:
    def made() -> Samples:
        seen, around_pu = _cycles(evidence, settled), requirement.voltage_pu.value
        room = room_pu(_support(evidence), seen.v_positive_pu, seen.v_negative_pu, around_pu)
        return evidence.nominal.apparent_power_kva * room

    return evidence.once_for(requirement, (KIND, settled.start, settled.stop), made)


def room_pu(
    support: ReactiveSupport | None, v_positive_pu: Samples, v_negative_pu: Samples, around_pu: float
) -> Samples:
    """Active power that the reactive power leaves room for at V+ and V- (pu), shape (n,).

    In a sag the least of sqrt(S_fault^2 - Q^2) where V+ and V- are off by ``around_pu`` together, 0 where Q takes all
    of it; from the no-support voltage on S_fault. S_fault falls with V-, and Q by no more: what V+ is not off
    by, V- is off by upwards.
    """
    capability = np.maximum(v_positive_pu - v_negative_pu, 0.0)
    if support is None:
        return capability
    off = np.linspace(-around_pu, around_pu, _STEPS)
    least = np.minimum.reduce(
        [_square_by_eq_10(support, v_positive_pu + x, v_negative_pu + around_pu - abs(x)) for x in off]
    )
    return np.where(v_positive_pu >= support.no_support_from_pu.value, capability, np.sqrt(np.maximum(least, 0.0)))


def _square_by_eq_10(support: ReactiveSupport, v_positive_pu: Samples, v_negative_pu: Samples) -> Samples:
    """Square of the active power (pu), below 0 where Q takes more than all of S_fault."""
    capability = np.maximum(v_positive_pu - v_negative_pu, 0.0)
    q = demanded_at_pu(support, v_positive_pu, v_negative_pu)
    square: Samples = capability**2 - q**2
    return square


def _settled(requirement: ActivePowerSupport, evidence: Evidence, stretch: Stretch) -> slice:
    """The samples of a stretch that are looked at.

    Raises
    ------
    NotApplicable
        When there is none, or nothing to be held against a curve.
    """
    if stretch.kind == "normal" and not _is_shallow_sag(evidence, stretch):
        raise NotApplicable(f"the voltage is normal from {stretch.begin_s:.3f} s on")
    if stretch.ramps:
        raise NotApplicable(f"the {' and the '.join(stretch.ramps)} moves from {stretch.begin_s:.3f} s on")
    begin_s = stretch.begin_s + requirement.settling_s.value
    settled = evidence.samples_before(begin_s, stretch.end_s)
    if settled.start == settled.stop:
        raise NotApplicable(
            f"the stretch from {stretch.begin_s:.3f} s to {stretch.end_s:.3f} s is over before the "
            f"{requirement.settling_s.value:g} s from which active power is due"
        )
    return settled


def _is_shallow_sag(evidence: Evidence, stretch: Stretch) -> bool:
    """Whether a voltage within what is normal has left that of before; after a deeper sag recovery judges it."""
    grid = evidence.disturbance
    before = grid.stretch_at(stretch.begin_s - _AN_INSTANT_S)
    at_first, rounding_pu = grid.no_load(evidence.waveforms.t0_s), evidence.thresholds.voltage_tolerance_pu.value
    moved_pu = max(
        abs(stretch.voltage.positive_pu - at_first.positive_pu),
        abs(stretch.voltage.negative_pu - at_first.negative_pu),
    )
    return moved_pu > rounding_pu and before.kind == "normal"


def _cycles(evidence: Evidence, settled: slice) -> _Cycles:
    t_s = evidence.t_s[settled]
    series = (
        ("P", evidence.active_power_kw),
        ("V+", evidence.voltage_positive_pu),
        ("V-", evidence.voltage_negative_pu),
    )
    return _Cycles(t_s, *(require_finite(x[settled], name, t_s) for name, x in series))


def _available_kw(evidence: Evidence, stretch: Stretch) -> float:
    """What the array gives at the irradiance of the stretch, in proportion to that before (kW)."""
    before_kw, first = evidence.available_power_w / 1e3, evidence.disturbance.irradiance_w_m2
    if first is None or stretch.irradiance_w_m2 is None or first[0] <= 0:
        return before_kw
    return before_kw * stretch.irradiance_w_m2 / first[0]
