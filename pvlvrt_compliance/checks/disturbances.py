"""When the voltage that was asked of the grid moves: what times of a code count from."""

from itertools import pairwise

import numpy as np

from pvlvrt_compliance.checks.evidence import Evidence
from pvlvrt_compliance.checks.series import Mask
from pvlvrt_compliance.measure.durations import median_over_time
from pvlvrt_compliance.scenario.events import FurtherSag, PhaseJump
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.timeline import Entry, asked_sequences_pu, entries
from pvlvrt_compliance.waveforms.container import Samples

SETTLED_CYCLES = 1.1
"""A one-cycle voltage shows a step within a cycle, and a sample or two."""

NORMAL_PU = (0.9, 1.1)
"""Voltages of normal operation in every code at hand, or nearly."""

_SAME_PU = 1e-9


def voltage_steps_s(scenario: Scenario) -> tuple[float, ...]:
    """Instants at which the voltage asked for jumps, or begins or ends to move (s, from the start of the record)."""
    return tuple(after.t_s for before, after in pairwise(entries(scenario)) if _moves(before, after))


def angle_steps_s(scenario: Scenario) -> tuple[float, ...]:
    """Instants at which an angle of the voltage asked for is meant to jump (s, from the start of the record)."""
    start_s = scenario.start_s
    jumps = [start_s + event.t_s for event in scenario.events if isinstance(event, PhaseJump) and event.angle_deg]
    sags = [(start_s, scenario.clear_s, scenario.sag)]
    for event in scenario.events:
        if isinstance(event, FurtherSag):
            begin_s = start_s + event.t_s  # added up as the timeline does, to the last bit
            sags.append((begin_s, begin_s + event.duration_s, event.sag))
    jumps += [t for begin_s, end_s, sag in sags if sag.angle_deg for t in (begin_s, end_s)]
    return tuple(sorted(set(jumps)))


def last_return_s(scenario: Scenario) -> float:
    """Instant from which the voltage asked for moves no more, the clearing at the earliest (s)."""
    return max((scenario.clear_s, *voltage_steps_s(scenario)))


def is_voltage_normal(scenario: Scenario, t_s: float) -> bool:
    """Whether the voltage asked for is that of normal operation and balanced: what trips then has another cause."""
    asked = asked_sequences_pu(scenario, t_s)
    return NORMAL_PU[0] <= abs(asked.positive) <= NORMAL_PU[1] and abs(asked.negative) <= 1 - NORMAL_PU[0]


def between_steps_s(evidence: Evidence, at_s: float) -> tuple[float, float]:
    """The steps of the voltage next to an instant, or the ends of the record (s)."""
    steps = voltage_steps_s(evidence.scenario)
    before = [t for t in steps if t <= at_s]
    after = [t for t in steps if t > at_s]
    return before[-1] if before else evidence.waveforms.t0_s, after[0] if after else evidence.waveforms.end_s


def settled_pu(evidence: Evidence, voltage_pu: Samples, at_s: float) -> float | None:
    """Median of a voltage between the steps next to an instant, its first cycle left out (pu); None if none is left."""
    begin_s, end_s = between_steps_s(evidence, at_s)
    settled = evidence.between(begin_s + 1 / evidence.frequency_hz, end_s)
    return median_over_time(voltage_pu[settled], evidence.step_s[settled]) if settled.any() else None


def after_each_step(evidence: Evidence, cycles: float, instants_s: tuple[float, ...]) -> Mask:
    """Mask of the samples that lie up to some cycles after one of the instants, shape (n,)."""
    spoiled = np.zeros(len(evidence.t_s), dtype=np.bool_)
    for t in instants_s:
        spoiled |= evidence.between(t, t + cycles / evidence.frequency_hz)
    return spoiled


def _moves(before: Entry, after: Entry) -> bool:
    dt = after.t_s - before.t_s
    return any(
        abs(u + slope * dt - v) > _SAME_PU or abs(slope - rate) > _SAME_PU
        for u, slope, v, rate in zip(
            before.sequences_pu, before.slope_pu_s, after.sequences_pu, after.slope_pu_s, strict=True
        )
    )
