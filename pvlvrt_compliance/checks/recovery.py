"""How long the active power takes to come back."""

from collections.abc import Iterable

from pvlvrt_compliance.checks.verdicts import judged_at_most
from pvlvrt_compliance.data.marks import Marked, Number
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence, require_finite
from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.measure.response import settled_from
from pvlvrt_compliance.profile.requirements import Requirement
from pvlvrt_compliance.results import Verdict
from pvlvrt_compliance.waveforms.container import Samples


def recovered_after_s(evidence: Evidence, from_s: float, target_kw: float) -> float | None:
    """Time from an instant until the one-cycle mean of P stays at or above a power.

    Parameters
    ----------
    evidence : Evidence
        The record.
    from_s : float
        The instant that the time counts from (s, from the start of the record).
    target_kw : float
        The power (kW).

    Returns
    -------
    float or None
        Seconds; 0 when P is never below the power from the instant on, None when the record ends below it.

    Raises
    ------
    MeasurementError
        When the record ends before the instant, or P is not finite somewhere from it on.
    """
    after = evidence.between(from_s, evidence.waveforms.end_s)
    t_s = evidence.t_s[after]
    if not len(t_s):
        raise MeasurementError(f"the record ends at {evidence.waveforms.end_s:.3f} s, before {from_s:.3f} s")
    active_power = require_finite(evidence.active_power_kw[after], "P", t_s)
    return settled_after_s(t_s, active_power < target_kw, from_s)


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
) -> Verdict:
    """Verdict on the time that an inverter which stayed connected takes to be back at a share of its power.

    Parameters
    ----------
    from_s : float
        The instant that the time counts from (s, from the start of the record); ``since`` names it.
    fraction, time_s : Number
        The share of P before the disturbance, and the time allowed.

    Raises
    ------
    MeasurementError
        When P cannot be measured, or the record ends before the time is over and P is not back.
    """
    before_kw, allowed_s = evidence.power_before_kw, time_s.value
    target = f"{100 * fraction.value:g} % of the {before_kw:.1f} kW before the sag"
    back_s = recovered_after_s(evidence, from_s, fraction.value * before_kw)
    observed_s = evidence.waveforms.end_s - from_s
    if back_s is None and observed_s < allowed_s:
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
    )
