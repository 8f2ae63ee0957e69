"""An inverter that feeds nothing does not ride through: no current, or too little, where some is due."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.checks.connection.regions import Visit
from pvlvrt_compliance.checks.verdicts import judged, judged_at_most
from pvlvrt_compliance.evidence.evidence import Evidence, require_finite
from pvlvrt_compliance.evidence.excursions import excursions, inside_of
from pvlvrt_compliance.evidence.no_load import no_load_series_pu
from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.evidence.stretches import settling_s
from pvlvrt_compliance.measure.extremes import first_most, smallest
from pvlvrt_compliance.measure.windows import Span
from pvlvrt_compliance.profile.regions import RegionTable
from pvlvrt_compliance.profile.requirements import RideThrough
from pvlvrt_compliance.results import Status, Verdict
from pvlvrt_compliance.waveforms.container import Samples

_KIND = "ride_through"
_SUPPORT = ("reactive_support", "reactive_current", "reactive_ratio")

_Places = NDArray[np.intp]
"""Numbers of samples of a record, rising."""


def without_current(
    requirement: RideThrough, found: list[Visit], evidence: Evidence, until_s: float
) -> Iterator[Verdict]:
    """A failed verdict on the longest time without current, where connection and current are due for more than a cycle.

    No current is due where the array gives none and no support is asked for, where the voltage leaves room for none
    (V+ - V- without the inverter's current below ``least_difference_pu``), where a region lets feeding pause and for
    the time of recovery after it, and where the code allows blocking.

    Parameters
    ----------
    found : list of Visit
        Regions that the voltage is in, at the terminals and without the inverter's current.
    until_s : float
        When the demand ends (s): the inverter lets go, or may.

    Raises
    ------
    MeasurementError
        When a current or a voltage is missing or not finite.
    """
    here = evidence.samples(evidence.disturbance.start_s, until_s)
    t_s = evidence.t_s[here]
    if not len(t_s):
        return
    idle = ~flowing(here, evidence)
    without = here.start + np.flatnonzero(idle)
    due = _capable(evidence, without) & _due(evidence, without)
    idle[idle] = due & ~_may_pause(requirement, found, evidence, without)
    gaps = excursions(idle, t_s)
    allowed_s = 1 / evidence.frequency_hz
    longest = first_most(gaps or [Span(0.0, 0.0)], lambda gap: gap.end_s - gap.start_s, allowed_s)
    lasted_s = longest.end_s - longest.start_s
    if lasted_s > allowed_s:
        level = evidence.disturbance.no_load(longest.start_s).positive_pu
        yield judged_at_most(
            _KIND,
            requirement,
            f"no current from {longest.start_s:.3f} s to {longest.end_s:.3f} s, at V+ = {level:.3f} pu without the"
            f" inverter's current, where feeding is due; it may pause for {allowed_s:.3f} s",
            measured=lasted_s,
            limit=allowed_s,
            unit="s",
            at_s=longest.start_s,
            rests_on=(evidence.thresholds.least_difference_pu,),
            uncertainty=evidence.thresholds.uncertainty_instant_s.value,
        )


def flowing(here: slice, evidence: Evidence) -> Mask:
    """Whether any phase carries current at each of some samples."""
    current = require_finite(evidence.largest_instantaneous_pu[here], "the current", evidence.t_s[here])
    found: Mask = current >= evidence.blocked_below_pu
    return found


def least_current(
    requirement: RideThrough,
    table: RegionTable,
    at_terminals: list[Visit],
    no_load: list[Visit],
    evidence: Evidence,
    until_s: float,
) -> Iterator[Verdict]:
    """A verdict on the least current in mandatory operation, against a share of the current before.

    Counts from when one-cycle quantities have settled after a step, or from when the profile says, and after a region
    in which feeding may pause from its time of recovery on. Where the voltages at the terminals and without the
    inverter's current lie in different regions, only what both call mandatory counts.
    """
    if table.least_current_fraction is None:
        return
    before = _before(table, evidence)
    asked = _inside(at_terminals, {"mandatory"}, evidence) & _inside(no_load, {"mandatory"}, evidence)
    demanded = evidence.samples(evidence.disturbance.start_s, until_s)
    asked[: demanded.start] = asked[demanded.stop :] = False
    for step in evidence.disturbance.steps:
        asked[evidence.samples(step.at_s, step.at_s + _settling_s(table, evidence))] = False
    here = np.flatnonzero(asked)
    here = here[_due(evidence, here) & ~_may_pause(requirement, [*at_terminals, *no_load], evidence, here)]
    if not len(here) or before < evidence.blocked_below_pu:
        return
    t_s = evidence.t_s[here]
    current = require_finite(_current(table, evidence.current_phase_pu[:, here]), "the current", t_s)
    least, worst = smallest(current, 1.0)
    limit = table.least_current_fraction.value * before
    what = "apparent current" if table.least_current_of == "apparent" else "current of the largest phase"
    yield judged(
        _KIND,
        requirement,
        Status.PASS if least >= limit else Status.FAIL,
        f"least {what} in mandatory operation {least:.3f} pu, at {t_s[worst]:.3f} s; "
        f"{table.least_current_fraction.value:g} of the {before:.3f} pu before are demanded",
        measured=least,
        limit=limit,
        margin=least - limit,
        unit="pu",
        at_s=t_s[worst],
        rests_on=tuple(filter(None, (table.least_current_fraction, table.least_current_settling_s))),
        clause=table.clause,
        bound="at_least",
        uncertainty=evidence.thresholds.uncertainty_current_pu.value,
    )


def _settling_s(table: RegionTable, evidence: Evidence) -> float:
    own = table.least_current_settling_s
    return settling_s(evidence) if own is None else max(own.value, settling_s(evidence))


def _current(table: RegionTable, phases: Samples) -> Samples:
    """The current that counts, of phase currents of the shape (3, n)."""
    now: Samples = np.sqrt((phases**2).mean(axis=0)) if table.least_current_of == "apparent" else phases.max(axis=0)
    return now


def _before(table: RegionTable, evidence: Evidence) -> float:
    """Mean of the same over the window before (pu)."""
    window = evidence.before()
    inside = evidence.samples(window.start_s, window.end_s)
    current = _current(table, evidence.current_phase_pu[:, inside])
    return float(np.average(require_finite(current, "the current", evidence.t_s[inside])))


def _capable(evidence: Evidence, at: _Places) -> Mask:
    """Where the voltage without the inverter's current leaves room for a current: V+ - V-."""
    room = no_load_series_pu(evidence, 0)[at] - no_load_series_pu(evidence, 1)[at]
    thresholds = evidence.thresholds
    found: Mask = np.nan_to_num(room) >= thresholds.least_difference_pu.value - thresholds.voltage_tolerance_pu.value
    return found


def _due(evidence: Evidence, at: _Places) -> Mask:
    """Where a current is due: the array gives some, or support is asked for."""
    power = np.full(len(at), evidence.available_power_w / evidence.nominal.apparent_power_va)
    first = evidence.disturbance.irradiance_w_m2
    for part in evidence.disturbance.stretches:
        if first is not None and first[0] > 0 and part.irradiance_w_m2 is not None and part.begin_s > 0:
            here = _among(at, evidence.samples(part.begin_s, part.end_s))
            power[here] *= 0.0 if "irradiance" in part.ramps else part.irradiance_w_m2 / first[0]
    supports = evidence.requirements is not None and any(evidence.requirements.of_kind(kind) for kind in _SUPPORT)
    due: Mask = power >= evidence.blocked_below_pu
    if supports and evidence.detection is not None:
        due |= evidence.is_event(evidence.voltage_positive_pu[at])
    return due


def _may_pause(requirement: RideThrough, found: list[Visit], evidence: Evidence, at: _Places) -> Mask:
    """Where feeding may pause: in a region that says so, for the recovery after it, or where blocking may be."""
    recovery_s = 0.0 if requirement.recovery_time_s is None else requirement.recovery_time_s.value
    free = np.zeros(len(at), dtype=np.bool_)
    for visit in found:
        if visit.region.mode != "mandatory":
            for begin_s, end_s in visit.within:
                free[_among(at, evidence.samples(begin_s, end_s + recovery_s))] = True
    support = None if evidence.requirements is None else evidence.requirements.of_kind("reactive_current")
    if support is not None:
        free |= np.nan_to_num(evidence.voltage_positive_pu[at]) < support.blocking_allowed_below_pu.value
    return free


def _among(at: _Places, samples: slice) -> slice:
    """Which of some samples lie in a stretch of them."""
    first, end = np.searchsorted(at, (samples.start, samples.stop)).tolist()
    return slice(first, end)


def _inside(found: list[Visit], modes: set[str], evidence: Evidence) -> Mask:
    inside = np.zeros(len(evidence.t_s), dtype=np.bool_)
    for visit in found:
        if visit.region.mode in modes:
            inside |= inside_of(list(visit.within), evidence.t_s)
    return inside
