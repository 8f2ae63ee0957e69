"""The inverter takes no more from the grid during a fault than its zones allow."""

from collections.abc import Iterator, Sequence

import numpy as np

from pvlvrt_compliance.checks.check import StretchCheck
from pvlvrt_compliance.checks.limits import level, of_each
from pvlvrt_compliance.checks.parts import Part, judged_by_parts
from pvlvrt_compliance.checks.power.faults import faults, is_cut_by_trip, next_fault_s, window_in
from pvlvrt_compliance.data.marks import Number
from pvlvrt_compliance.disturbance.model import Stretch
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, require_finite
from pvlvrt_compliance.measure.durations import mean_over_time
from pvlvrt_compliance.measure.extremes import largest, smallest
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.profile.requirements import Consumption
from pvlvrt_compliance.profile.requirements.power import ConsumptionZones
from pvlvrt_compliance.results import Band, Verdict
from pvlvrt_compliance.results.band import ACTIVE_POWER, REACTIVE_CURRENT, REACTIVE_POWER
from pvlvrt_compliance.waveforms.container import Samples

KIND = "consumption"


class ConsumptionCheck(StretchCheck):
    """Judges power, energy and reactive current taken from the grid in each fault and after it, zone by zone."""

    kind = KIND
    title = "Consumption during a fault"
    requirement = Consumption
    until = "trip"

    def stretches(self, requirement: Consumption, evidence: Evidence) -> Sequence[Stretch]:  # noqa: ARG002
        """The faults, each from its start to its clearing."""
        return faults(evidence)

    def judge_stretch(self, requirement: Consumption, evidence: Evidence, stretch: Stretch) -> Verdict:
        """Judge power and energy taken from the grid by zone; reports the least margin relative to its limit.

        Powers and the reactive current are one-cycle means and phasors of cycles that lie wholly in the zone. An energy
        adds up what is taken cycle by cycle from the zone's beginning, the last cycle cut where the zone ends; what one
        cycle feeds does not make up for what another takes. A fault is unbalanced when its mean V- in the
        during-window, or without one its highest one-cycle V-, reaches ``unbalanced_from_pu``. A trip and the next
        fault end a zone.

        Raises
        ------
        NotApplicable
            When the profile limits nothing in this fault.
        MeasurementError
            When V-, P, Q or the current cannot be measured in a zone, or the record ends in one.
        """
        zones = _zones(requirement, evidence, stretch)
        return judged_by_parts(KIND, requirement, list(_parts(zones, evidence, stretch)))

    def limits(self, requirement: Consumption, evidence: Evidence) -> tuple[Band, ...]:
        """The most that may be taken in each zone: of powers and of the reactive current; energies are no level."""

        def bands(stretch: Stretch) -> Iterator[Band]:
            zones = _zones(requirement, evidence, stretch)
            a, b, c = _spans(zones, evidence, stretch)
            rated_kva = evidence.nominal.apparent_power_kva
            for name, zone, quantity, limit, times in (
                ("least Q, zone A", a, REACTIVE_POWER, zones.reactive_power_a, rated_kva),
                ("least P, zone B", b, ACTIVE_POWER, zones.active_power_b, rated_kva),
                ("least Q, zone B", b, REACTIVE_POWER, zones.reactive_power_b, rated_kva),
                ("least reactive current, zone C", c, REACTIVE_CURRENT, zones.reactive_current_c_pu, 1.0),
            ):
                span = (zone.start_s + 1 / evidence.frequency_hz, zone.end_s)
                if limit is not None and span[1] > span[0]:
                    yield level(KIND, quantity, name, span, lower=-limit.value * times)

        return of_each(self.stretches(requirement, evidence), bands)


def _zones(requirement: Consumption, evidence: Evidence, fault: Stretch) -> ConsumptionZones:
    negative_pu = _negative_pu(evidence, fault)
    if negative_pu < requirement.unbalanced_from_pu.value:
        return requirement.balanced
    if requirement.unbalanced is None:
        raise NotApplicable(f"the profile limits no consumption in an unbalanced fault (V- = {negative_pu:.3f} pu)")
    return requirement.unbalanced


def _negative_pu(evidence: Evidence, fault: Stretch) -> float:
    during = window_in(fault, evidence)
    inside = evidence.samples(*(during or (fault.begin_s, fault.end_s)))
    negative = require_finite(evidence.voltage_negative_pu[inside], "V-", evidence.t_s[inside])
    return float(negative.max()) if during is None else mean_over_time(negative, evidence.step_s[inside])


def _after(evidence: Evidence, fault: Stretch, transient_s: float) -> Span:
    """Zone C, empty where the inverter trips in the fault."""
    if is_cut_by_trip(fault, evidence):
        return Span(fault.end_s, fault.end_s)
    next_s = next_fault_s(fault, evidence)
    end_s = fault.end_s + transient_s
    return Span(fault.end_s, end_s if next_s is None else min(end_s, next_s))


def _spans(zones: ConsumptionZones, evidence: Evidence, fault: Stretch) -> tuple[Span, Span, Span]:
    """Zones A, B and C."""
    transient_s = zones.transient_s.value
    end_of_a_s = min(fault.begin_s + transient_s, fault.end_s)
    return (
        Span(fault.begin_s, end_of_a_s),
        Span(end_of_a_s, fault.end_s),
        _after(evidence, fault, transient_s),
    )


def _parts(zones: ConsumptionZones, evidence: Evidence, fault: Stretch) -> Iterator[Part]:
    """Every limit that is stated, in the zones that the fault is long enough for."""
    a, b, c = _spans(zones, evidence, fault)
    yield from _power("zone A: reactive power", evidence, a, "Q", zones.reactive_power_a)
    yield from _energy("zone A: reactive energy", evidence, a, "Q", zones.reactive_energy_a_s)
    yield from _power("zone B: active power", evidence, b, "P", zones.active_power_b)
    yield from _power("zone B: reactive power", evidence, b, "Q", zones.reactive_power_b)
    yield from _energy("zone B: active energy", evidence, b, "P", zones.active_energy_b_s)
    yield from _energy("zone B: reactive energy", evidence, b, "Q", zones.reactive_energy_b_s)
    yield from _energy("zone C: reactive energy", evidence, c, "Q", zones.reactive_energy_c_s)
    yield from _reactive_current(evidence, c, zones.reactive_current_c_pu)


def _power(what: str, evidence: Evidence, zone: Span, which: str, limit: Number | None) -> Iterator[Part]:
    """Largest one-cycle mean of what is taken (kW or kvar)."""
    if limit is not None:
        mean = evidence.active_power_kw if which == "P" else evidence.reactive_power_kvar
        limit_kva = limit.value * evidence.nominal.apparent_power_kva
        part = Part(f"{what} taken", 0.0, limit_kva, _unit(which), 0.0, (limit,), evidence.power_uncertainty_kva)
        yield from _largest(part, evidence, zone, mean, evidence.nominal.apparent_power_kva)


def _reactive_current(evidence: Evidence, zone: Span, limit: Number | None) -> Iterator[Part]:
    if limit is not None:
        uncertainty = evidence.thresholds.uncertainty_current_pu.value
        part = Part("zone C: reactive current taken", 0.0, limit.value, "pu", 0.0, (limit,), uncertainty)
        yield from _largest(part, evidence, zone, evidence.current_positive_pu.reactive, 1.0)


def _largest(limited: Part, evidence: Evidence, zone: Span, fed: Samples, rated: float) -> Iterator[Part]:
    """A part with the most that is taken in a zone, by a series of what is fed, and first when."""
    if zone.end_s <= zone.start_s:
        return
    _require_recorded(evidence, zone)
    inside = evidence.samples(zone.start_s + 1 / evidence.frequency_hz, zone.end_s)
    t_s = evidence.t_s[inside]
    if len(t_s):
        values = require_finite(fed[inside], limited.what, t_s)
        least, worst = smallest(values, rated)
        measured = max(-least, 0.0)
        yield limited._replace(what=f"{limited.what} from the grid", measured=measured, at_s=float(t_s[worst]))


def _energy(what: str, evidence: Evidence, zone: Span, which: str, limit: Number | None) -> Iterator[Part]:
    """What is taken in a zone (kW s or kvar s); the worst instant is the end of the cycle that takes most."""
    if limit is None or zone.end_s <= zone.start_s:
        return
    _require_recorded(evidence, zone)
    ends_s, energies = _energies(evidence, zone, which)
    taken = np.maximum(-energies, 0.0)
    rated_kva = evidence.nominal.apparent_power_kva
    limit_kws = limit.value * rated_kva
    at_s = float(ends_s[largest(taken, rated_kva / evidence.frequency_hz).at])
    uncertainty = evidence.power_uncertainty_kva * (zone.end_s - zone.start_s)
    yield Part(
        f"{what} taken from the grid", float(taken.sum()), limit_kws, f"{_unit(which)} s", at_s, (limit,), uncertainty
    )


def _energies(evidence: Evidence, zone: Span, which: str) -> tuple[Samples, Samples]:
    """Ends of the cycles of a zone (s), and what is fed in each (kW s or kvar s)."""
    power = evidence.instantaneous_kva
    values = power.p if which == "P" else power.q
    t_s = evidence.t_s
    # One sample beyond either end, where the record has one: zones begin and end between samples.
    first, last = np.searchsorted(t_s, (zone.start_s, zone.end_s))
    reach = slice(max(first - 1, 0), last + 1)
    require_finite(values[reach], which, t_s[reach])
    steps = np.diff(t_s[reach]) * 0.5 * (values[reach][1:] + values[reach][:-1])
    energy = np.concatenate([[0.0], np.cumsum(steps)])
    edges = np.append(np.arange(zone.start_s, zone.end_s - 1e-9, 1 / evidence.frequency_hz), zone.end_s)
    return edges[1:], np.diff(np.interp(edges, t_s[reach], energy))


def _require_recorded(evidence: Evidence, zone: Span) -> None:
    if evidence.waveforms.end_s + evidence.waveforms.segments[-1].dt_s < zone.end_s:
        raise MeasurementError(
            f"the record ends at {evidence.waveforms.end_s:.3f} s, before the end of a zone at {zone.end_s:.3f} s"
        )


def _unit(which: str) -> str:
    return "kW" if which == "P" else "kvar"
