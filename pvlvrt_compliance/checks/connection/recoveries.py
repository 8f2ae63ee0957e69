"""The active power comes back after each disturbance of the voltage."""

from itertools import pairwise

from pvlvrt_compliance.checks.check import decisive
from pvlvrt_compliance.checks.limits import of_each
from pvlvrt_compliance.checks.recovery import judge_recovery, recovery_band
from pvlvrt_compliance.data.marks import marks_in
from pvlvrt_compliance.evidence.evidence import Evidence, NotApplicable
from pvlvrt_compliance.profile.requirements import RideThrough
from pvlvrt_compliance.results import Band, Verdict


def judged_recovery(kind: str, requirement: RideThrough, evidence: Evidence) -> Verdict | None:
    """Verdict on P's return after each return of the voltage, the worst; None where nothing demands or can show it.

    Between two disturbances that lie nearer to each other than the time of recovery, only a power that is back is
    judged.
    """
    fraction, time_s = requirement.recovery_fraction, requirement.recovery_time_s
    if fraction is None or time_s is None or evidence.disturbance.leaves_voltage_alone:
        return None
    found, rests_on = [], [number for _, number in marks_in(requirement)]
    for from_s, until_s, name in _returns(evidence):
        try:
            found.append(
                judge_recovery(
                    kind,
                    requirement,
                    evidence,
                    from_s=from_s,
                    until_s=until_s,
                    fraction=fraction,
                    time_s=time_s,
                    rests_on=rests_on,
                    since=name,
                )
            )
        except NotApplicable:
            continue
    return decisive(found) if found else None


def recovery_bands(kind: str, requirement: RideThrough, evidence: Evidence) -> tuple[Band, ...]:
    """The power that must be back after each return of the voltage, as a figure draws it."""
    fraction, time_s = requirement.recovery_fraction, requirement.recovery_time_s
    if fraction is None or time_s is None or evidence.disturbance.leaves_voltage_alone:
        return ()
    return of_each(
        _returns(evidence),
        lambda back: recovery_band(kind, evidence, from_s=back[0], until_s=back[1], fraction=fraction, time_s=time_s),
    )


def _returns(evidence: Evidence) -> list[tuple[float, float | None, str]]:
    """Each return of the voltage to normal, when it leaves again, and its name; the last as the disturbance has it."""
    grid = evidence.disturbance
    parts = grid.voltage_stretches(evidence.waveforms.end_s)
    gaps = [
        (part.begin_s, part.end_s, f"clearing at {part.begin_s:.3f} s")
        for before, part in pairwise(parts)
        if part.kind == "normal" and before.kind != "normal" and part.end_s < grid.end_s + 1e-9
    ]
    return [*gaps, (grid.end_s, None, "clearing")]
