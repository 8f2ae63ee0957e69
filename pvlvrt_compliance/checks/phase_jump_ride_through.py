"""The inverter stays connected through jumps of the voltage's angle, and its active power comes back."""

import math
from itertools import zip_longest
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.checks.disturbances import SETTLED_CYCLES, angle_steps_s, between_steps_s, is_voltage_normal
from pvlvrt_compliance.checks.evidence import Evidence, NotApplicable
from pvlvrt_compliance.checks.recovery import judge_recovery
from pvlvrt_compliance.checks.results import Check, Status
from pvlvrt_compliance.checks.verdicts import judged
from pvlvrt_compliance.measure.fourier import ComplexSamples
from pvlvrt_compliance.profile.provenance import marks_in
from pvlvrt_compliance.profile.requirements import PhaseJumpRideThrough
from pvlvrt_compliance.scenario.timeline import entries
from pvlvrt_compliance.space_vectors import fortescue, phases

KIND = "phase_jump_ride_through"

ACCURACY_DEG = 0.1
"""How well a jump is known: nearer to a limit is on it."""


class Jump(NamedTuple):
    """One jump of the angle of the voltage without the inverter's current."""

    at_s: float
    positive_deg: float  # of the positive sequence
    phase_deg: float  # of the phase that jumps the furthest
    seen: str  # measured, or asked for

    @property
    def in_words(self) -> str:
        """The jump as a message names it."""
        words = f"{self.positive_deg:.1f} deg of the positive sequence"
        alone = abs(self.phase_deg - self.positive_deg) > ACCURACY_DEG
        return f"{words} ({self.phase_deg:.1f} deg of one phase)" if alone else words


def check_phase_jump_ride_through(requirement: PhaseJumpRideThrough, evidence: Evidence) -> Check:
    """Judge connection through every jump that the scenario has, and the power after the last one.

    Raises
    ------
    NotApplicable
        When no angle jumps, a jump is beyond what the code names, or the inverter tripped before the first one or while
        the voltage was not normal.
    MeasurementError
        When a voltage or P is missing, or the record does not say whether the breaker is closed.
    """
    jumps = [jump_at(evidence, t) for t in angle_steps_s(evidence.scenario)]
    if not jumps:
        raise NotApplicable("no angle of the voltage jumps in this test")
    for jump in jumps:
        if (beyond := _beyond(requirement, jump)) is not None:
            raise NotApplicable(f"the jump at {jump.at_s:.3f} s, {jump.seen}, of {jump.in_words} is beyond {beyond}")
    if evidence.disconnected_at_s is not None:
        return _judge_trip(requirement, evidence, jumps, evidence.disconnected_at_s)
    largest = max(jumps, key=lambda jump: abs(jump.positive_deg))
    return judge_recovery(
        KIND,
        requirement,
        evidence,
        from_s=jumps[-1].at_s,
        fraction=requirement.recovery_fraction,
        time_s=requirement.recovery_time_s,
        rests_on=[number for _, number in marks_in(requirement)],
        since=f"the last jump (largest: {largest.in_words}, {largest.seen})",
    )


def jump_at(evidence: Evidence, at_s: float) -> Jump:
    """The jump at an instant: measured over the cycles before and after it, less what the frequency turns in a cycle.

    Where the voltage is not steady for so long, or where it vanishes, it is the jump asked for.
    """
    phasors = evidence.no_load_phasors_pu if evidence.no_load_phasors_pu is not None else evidence.voltage_phasors_pu
    cycle_s = SETTLED_CYCLES / evidence.frequency_hz
    before_s, _ = between_steps_s(evidence, at_s - 1e-6)
    _, after_s = between_steps_s(evidence, at_s)
    others = [t for t in angle_steps_s(evidence.scenario) if t != at_s]
    alone = all(abs(t - at_s) > 2 * cycle_s for t in others)
    alone = alone and _is_steady(evidence, at_s - 2 * cycle_s, at_s + 2 * cycle_s)
    if alone and at_s - before_s > 2 * cycle_s and after_s - at_s > cycle_s:
        before = evidence.t_s[max(int(np.searchsorted(evidence.t_s, at_s - 1e-9)) - 1, 0)]  # the last sample
        first, last, then = (_at(phasors, evidence, t) for t in (before - cycle_s, before, before + 2 * cycle_s))
        drift = np.angle(_positive(last) * np.conj(_positive(first)))
        jump = _jump(at_s, last, then * np.exp(-1j * drift), "measured")
        if math.isfinite(jump.positive_deg) and math.isfinite(jump.phase_deg):
            return jump
    return _asked(evidence, at_s)


def _is_steady(evidence: Evidence, begin_s: float, end_s: float) -> bool:
    """Whether the frequency asked for stays the same: what it moves by would be taken for a jump of the angle."""
    table = entries(evidence.scenario)
    inside = [entry for entry, after in zip_longest(table, table[1:]) if after is None or after.t_s > begin_s]
    seen = [entry for entry in inside if entry.t_s <= end_s]
    return len({entry.frequency_hz for entry in seen}) == 1 and not any(entry.rocof_hz_s for entry in seen)


def _asked(evidence: Evidence, at_s: float) -> Jump:
    table = entries(evidence.scenario)
    after = next(k for k, entry in enumerate(table) if entry.t_s == at_s)
    before = table[after - 1]
    dt = at_s - before.t_s
    turned = 2 * math.pi * (before.frequency_hz * dt + 0.5 * before.rocof_hz_s * dt**2)
    jumped = table[after].angle_rad - before.angle_rad - turned
    last = np.array(phases(*(u + slope * dt for u, slope in zip(before.sequences_pu, before.slope_pu_s, strict=True))))
    then = np.array(phases(*table[after].sequences_pu))
    return _jump(at_s, last, then * np.exp(1j * jumped), "asked for")


def _jump(at_s: float, last: ComplexSamples, then: ComplexSamples, seen: str) -> Jump:
    ratios = then * np.conj(last)
    of_phases = np.degrees(np.angle(ratios))
    positive = np.degrees(np.angle(_positive(then) * np.conj(_positive(last))))
    return Jump(at_s, float(positive), float(of_phases[np.abs(of_phases).argmax()]), seen)


def _positive(phasors: ComplexSamples) -> complex:
    return complex(fortescue(*phasors)[0])


def _at(phasors: ComplexSamples, evidence: Evidence, t_s: float) -> ComplexSamples:
    index = min(int(np.searchsorted(evidence.t_s, t_s)), len(evidence.t_s) - 1)
    found: ComplexSamples = phasors[:, index]
    return found


def _beyond(requirement: PhaseJumpRideThrough, jump: Jump) -> str | None:
    """The limit that a jump is beyond, in words; None when the code demands to ride through it."""
    if abs(jump.positive_deg) > requirement.all_phases_deg.value + ACCURACY_DEG:
        return f"the {requirement.all_phases_deg.value:g} deg of the code"
    single = requirement.single_phase_deg
    if single is not None and abs(jump.phase_deg) > single.value + ACCURACY_DEG:
        return f"the {single.value:g} deg of one phase of the code"
    return None


def _judge_trip(requirement: PhaseJumpRideThrough, evidence: Evidence, jumps: list[Jump], tripped_at_s: float) -> Check:
    if tripped_at_s < jumps[0].at_s:
        raise NotApplicable("tripped before the first jump")
    if not is_voltage_normal(evidence.scenario, tripped_at_s):
        raise NotApplicable("tripped while the voltage was not normal, which is judged by ride_through")
    jump = next(jump for jump in reversed(jumps) if jump.at_s <= tripped_at_s)
    connected_s, demanded_s = tripped_at_s - jump.at_s, evidence.waveforms.end_s - jump.at_s
    return judged(
        KIND,
        requirement,
        Status.FAIL,
        f"tripped {connected_s:.3f} s after a jump of {jump.in_words} ({jump.seen}); the code demands connection",
        measured=connected_s,
        limit=demanded_s,
        margin=connected_s - demanded_s,
        unit="s",
        at_s=tripped_at_s,
        rests_on=[requirement.all_phases_deg],
    )
