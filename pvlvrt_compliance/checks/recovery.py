"""How long the active power takes to come back."""

from collections.abc import Iterable

from pvlvrt_compliance.checks.limits import level
from pvlvrt_compliance.checks.verdicts import judged_at_most
from pvlvrt_compliance.data.marks import Marked, Number
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable, require_finite
from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.measure.response import settled_from
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.results import Band, Verdict
from pvlvrt_compliance.results.band import ACTIVE_POWER
from pvlvrt_compliance.waveforms.container import Samples


def recovered_after_s(
    evidence: Evidence, from_s: float, target_kw: float, until_s: float | None = None
) -> float | None:
    """Time from an instant until the one-cycle mean of P stays at or above a power.

    Parameters
    ----------
    evidence : Evidence
        The record.
    from_s : float
        The instant that the time counts from (s, from the start of the record).
    target_kw : float
        The power (kW).
    until_s : float, optional
        The instant that ends what is looked at (s), by default the end of the record.

    Returns
    -------
    float or None
        Seconds; 0 when P is never below the power from the instant on, None when what is looked at ends below it.

    Raises
    ------
    MeasurementError
        When the record ends before the instant, or P is not finite somewhere from it on.
    """
    after = part_after(evidence, from_s, until_s)
    t_s = evidence.t_s[after]
    if not len(t_s):
        raise MeasurementError(f"the record ends at {evidence.waveforms.end_s:.3f} s, before {from_s:.3f} s")
    active_power = require_finite(evidence.active_power_kw[after], "P", t_s)
    return settled_after_s(t_s, active_power < target_kw, from_s)


def part_after(evidence: Evidence, from_s: float, until_s: float | None) -> slice:
    """Samples from an instant to before another (s), or to the end of the record."""
    end_s = evidence.waveforms.end_s
    return evidence.samples(from_s, end_s) if until_s is None else evidence.samples_before(from_s, until_s)


def settled_after_s(t_s: Samples, outside: Mask, from_s: float) -> float | None:
    """Time from an instant until nothing lies outside any more (s): 0 where nothing does, None where it never ends.

    Parameters
    ----------
    t_s : array, shape (n,)
        Instants of the samples from that instant on (s).
    outside : array of bool, shape (n,)
    """
    first = settled_from(outside)
    if not first:
        return None if first is None else 0.0
    return float(t_s[first] - from_s)


def judge_recovery(
    kind: str,
    requirement: Requirement,
    evidence: Evidence,
    *,
    from_s: float,
    fraction: Number,
    time_s: Number,
    rests_on: Iterable[Marked],
    since: str,
    until_s: float | None = None,
) -> Verdict:
    """Verdict on the time that an inverter which stayed connected takes to be back at a share of its power.

    Parameters
    ----------
    from_s : float
        The instant that the time counts from (s, from the start of the record); ``since`` names it.
    fraction, time_s : Number
        The share of P before the disturbance, and the time allowed.
    until_s : float, optional
        When the next disturbance begins (s); by default there is none.

    Raises
    ------
    NotApplicable
        When there was no active power before, or the next disturbance comes before the time is over, and P is not
        back.
    MeasurementError
        When P cannot be measured, or the record ends before the time is over and P is not back.
    """
    before_kw, allowed_s = evidence.starting_power_kw, time_s.value
    target = f"{100 * fraction.value:g} % of the {before_kw:.1f} kW before the sag"
    back_s = recovered_after_s(evidence, from_s, fraction.value * before_kw, until_s)
    observed_s = (evidence.waveforms.end_s if until_s is None else until_s) - from_s
    if back_s is None and observed_s < allowed_s:
        if until_s is not None:
            raise NotApplicable(f"the next disturbance begins {observed_s:.3f} s after {since}, before P must be back")
        raise MeasurementError(f"the record ends {observed_s:.3f} s after {since}, before P is back at {target}")
    recovered_s = observed_s if back_s is None else back_s
    came = f"P was {'not ' if back_s is None else ''}back at {target}"
    return judged_at_most(
        kind,
        requirement,
        f"connected throughout; {came} {recovered_s:.3f} s after {since}",
        measured=recovered_s,
        limit=allowed_s,
        unit="s",
        at_s=from_s + recovered_s,
        rests_on=rests_on,
        uncertainty=evidence.half_cycle_s,
    )


def recovery_band(
    kind: str, evidence: Evidence, *, from_s: float, fraction: Number, time_s: Number, until_s: float | None = None
) -> tuple[Band, ...]:
    """The same as a figure draws it: the least P from the time on, none where the record ends before."""
    begin_s, end_s = from_s + time_s.value, evidence.waveforms.end_s if until_s is None else until_s
    if begin_s >= end_s:
        return ()
    least_kw = fraction.value * evidence.starting_power_kw
    return (level(kind, ACTIVE_POWER, "P back", (begin_s, end_s), lower=least_kw),)
