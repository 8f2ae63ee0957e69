"""The inverter takes no more from the grid during a fault than its zones allow."""

from collections.abc import Iterator

import numpy as np

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.parts import Part, judged_by_parts
from pvlvrt_compliance.data.marks import Number
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, require_finite
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.profile.requirements import Consumption
from pvlvrt_compliance.profile.requirements.power import ConsumptionZones
from pvlvrt_compliance.results import Verdict
from pvlvrt_compliance.waveforms.container import Samples

KIND = "consumption"


class ConsumptionCheck(Check):
    """Judges power, energy and reactive current taken from the grid in a fault and after it, zone by zone."""

    kind = KIND
    title = "Consumption during a fault"
    requirement = Consumption

    def judge(self, requirement: Consumption, evidence: Evidence) -> Verdict:
        """Judge power and energy taken from the grid by zone; reports the least margin relative to its limit.

        Powers and the reactive current are one-cycle means and phasors of cycles that lie wholly in the zone. An energy
        adds up what is taken cycle by cycle from the zone's beginning, the last cycle cut where the zone ends; what one
        cycle feeds does not make up for what another takes. A fault is unbalanced when its mean V- in the
        during-window, or without one its highest one-cycle V-, reaches ``unbalanced_from_pu``.

        Raises
        ------
        NotApplicable
            When the profile limits nothing in this test.
        MeasurementError
            When V-, P, Q or the current cannot be measured in a zone, or the record ends in one.
        """
        zones = _zones(requirement, evidence)
        return judged_by_parts(KIND, requirement, list(_parts(zones, evidence)))


def _zones(requirement: Consumption, evidence: Evidence) -> ConsumptionZones:
    negative_pu = _negative_pu(evidence)
    if negative_pu < requirement.unbalanced_from_pu.value:
        return requirement.balanced
    if requirement.unbalanced is None:
        raise NotApplicable(f"the profile limits no consumption in an unbalanced fault (V- = {negative_pu:.3f} pu)")
    return requirement.unbalanced


def _negative_pu(evidence: Evidence) -> float:
    during = evidence.during_span
    inside = evidence.between(*(during or (evidence.disturbance.start_s, evidence.disturbance.clear_s)))
    negative = require_finite(evidence.voltage_negative_pu[inside], "V-", evidence.t_s[inside])
    return float(negative.max() if during is None else np.average(negative, weights=evidence.step_s[inside]))


def _parts(zones: ConsumptionZones, evidence: Evidence) -> Iterator[Part]:
    """Every limit that is stated, in the zones that the fault is long enough for."""
    start_s, clear_s = evidence.disturbance.start_s, evidence.disturbance.clear_s
    transient_s = zones.transient_s.value
    end_of_a_s = min(start_s + transient_s, clear_s)
    a, b, c = Span(start_s, end_of_a_s), Span(end_of_a_s, clear_s), Span(clear_s, clear_s + transient_s)
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
        yield from _largest(
            f"{what} taken", evidence, zone, -mean, limit, evidence.nominal.apparent_power_kva, _unit(which)
        )


def _reactive_current(evidence: Evidence, zone: Span, limit: Number | None) -> Iterator[Part]:
    if limit is not None:
        taken = -evidence.current_positive_pu.reactive
        yield from _largest("zone C: reactive current taken", evidence, zone, taken, limit, 1.0, "pu")


def _largest(
    what: str, evidence: Evidence, zone: Span, taken: Samples, limit: Number, base: float, unit: str
) -> Iterator[Part]:
    _require_recorded(evidence, zone)
    inside = evidence.between(zone.start_s + 1 / evidence.frequency_hz, zone.end_s)
    t_s = evidence.t_s[inside]
    if len(t_s):
        values = require_finite(taken[inside], what, t_s)
        worst = int(values.argmax())
        measured = max(float(values[worst]), 0.0)
        yield Part(f"{what} from the grid", measured, limit.value * base, unit, float(t_s[worst]), (limit,))


def _energy(what: str, evidence: Evidence, zone: Span, which: str, limit: Number | None) -> Iterator[Part]:
    """What is taken in a zone (kW s or kvar s); the worst instant is the end of the cycle that takes most."""
    if limit is None or zone.end_s <= zone.start_s:
        return
    _require_recorded(evidence, zone)
    ends_s, energies = _energies(evidence, zone, which)
    taken = np.maximum(-energies, 0.0)
    limit_kws = limit.value * evidence.nominal.apparent_power_kva
    at_s = float(ends_s[taken.argmax()])
    yield Part(f"{what} taken from the grid", float(taken.sum()), limit_kws, f"{_unit(which)} s", at_s, (limit,))


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
