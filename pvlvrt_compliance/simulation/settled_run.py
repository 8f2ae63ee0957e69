"""The bundled controller's runs that go on from where one of them has settled."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.controller import ControllerState, joined
from pvlvrt_compliance.hardware.delays import DelayLines
from pvlvrt_compliance.hardware.hardware import Hardware
from pvlvrt_compliance.kernel import single
from pvlvrt_compliance.plant.plant import PlantState
from pvlvrt_compliance.plant.protection import NO_TRIP
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.common_start import CommonStart, CommonStarts, common_start, parted
from pvlvrt_compliance.simulation.outcome import COMPLETED, Outcome
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.recorder import RecordingPlan
from pvlvrt_compliance.simulation.translate import control_period_s


class LoopState(NamedTuple):
    """All that the loop over time remembers from one control period to the next. Its arrays are written in place."""

    plant: PlantState
    controller: ControllerState | None  # the bundled one; one from outside remembers for itself
    m: complex  # modulating signal that the controller gave last (-)
    period: int  # that comes next
    k: int  # samples that the controller has taken
    lines: DelayLines | None  # what is under way in the hardware; none: it is ideal


class SettledRun(NamedTuple):
    """Where a run was as it parted from others, and all that it could have recorded before."""

    state: LoopState
    samples: NDArray[np.float64]  # a row for every period from ``start.begin`` on, a channel in one piece
    start: CommonStart


Loop = Callable[[LoopState, RecordingPlan], tuple[Outcome, NDArray[np.float64]]]
"""Runs on from a state to the end of a plan; how it ends, and its rows. It writes in the arrays of the state."""


def settling_periods(parameters: Parameters) -> int:
    """Control periods of the settling."""
    return math.ceil(parameters.simulation.settling_s / control_period_s(parameters))


def start_of(scenario: Scenario, parameters: Parameters) -> CommonStart | None:
    """Where a run of the bundled controller parts from others."""
    return common_start(scenario, parameters, control_period_s(parameters), settling_periods(parameters))


def through(
    first: LoopState,
    plan: RecordingPlan,
    loop: Loop,
    starts: CommonStarts[SettledRun] | None = None,
    start: CommonStart | None = None,
) -> tuple[Outcome, NDArray[np.float64]]:
    """Run from a first state to the end of a plan, from a settled one where there is one; how it ends, and the rows.

    Parameters
    ----------
    first : LoopState
    plan : RecordingPlan
    loop : callable
    starts : CommonStarts, optional
        What there is to go on from; a run of which nothing is in common with others begins with ``first``.
    start : CommonStart, optional
        Where this run parts from others.
    """
    kept = starts.of(start, lambda start: _settled(first, start, loop)) if starts is not None else None
    if kept is None:
        return loop(copied(first), plan)
    here = parted(plan, kept.start.period)
    outcome, samples = loop(copied(kept.state), here.rest)
    rows = np.empty((samples.shape[1], here.rows + len(samples))).T
    here.put(kept.samples, kept.start.begin, rows)
    rows.T[:, here.rows :] = samples.T
    return outcome, rows


def lines_of(hardware: Hardware | None) -> DelayLines | None:
    """What is under way in the hardware, if that is not ideal."""
    return None if hardware is None else hardware.lines


def state_after(
    ended: Outcome, lines: DelayLines | None, controller: ControllerState | None = None
) -> LoopState | None:
    """State at the end of a run; none of one whose inverter does not run any more as it settles."""
    onward = ended.onward
    if ended.status != COMPLETED or ended.plant.trip != NO_TRIP or ended.plant.blocked or onward is None:
        return None
    return LoopState(ended.plant, controller, onward.m, ended.period, onward.k, lines)


def with_lines(hardware: Hardware | None, lines: DelayLines | None) -> Hardware | None:
    """Hardware in which something else is under way."""
    return None if hardware is None or lines is None else hardware._replace(lines=lines)


def copied(x: Any) -> Any:
    """The same with arrays of its own."""
    if isinstance(x, np.ndarray):
        return x.copy()
    if isinstance(x, tuple):
        parts = [copied(part) for part in x]
        return type(x)(*parts) if hasattr(x, "_fields") else tuple(parts)
    return x


def _settled(first: LoopState, start: CommonStart, loop: Loop) -> SettledRun | None:
    """Where a run is as it parts from others; none of one that does not get there, whose tests each say why."""
    x = copied(first)
    outcome, samples = loop(x, start.plan)
    given = None if outcome.onward is None else outcome.onward.controller
    if given is None or x.controller is None:
        return None
    controller = joined(x.controller, given)
    if _is_single(first.controller):
        controller = single(controller)  # the same numbers: compiled code gives them back in 64 bits
    state = state_after(outcome, x.lines, controller)
    return None if state is None else SettledRun(copied(state), samples, start)


def _is_single(x: Any) -> bool:
    """Whether there are numbers of 32 bits in it."""
    if isinstance(x, tuple):
        return any(_is_single(part) for part in x)
    return isinstance(x, np.float32 | np.complex64) or (isinstance(x, np.ndarray) and x.dtype == np.complex64)
