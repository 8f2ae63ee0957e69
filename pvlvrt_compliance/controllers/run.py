"""One run with a controller from outside, in this process: see `simulator` for one that is safe from it."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.controllers.door import Door, DoorCall, DoorError
from pvlvrt_compliance.controllers.resting import at_rest, unpacked
from pvlvrt_compliance.controllers.sample_time import Rates, not_below, rates_of, with_rates
from pvlvrt_compliance.errors import SimulationError
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation import outcome
from pvlvrt_compliance.simulation.columns import RECORDED
from pvlvrt_compliance.simulation.door.blocks import MODULATING, VOLTAGES, port_table, real_block
from pvlvrt_compliance.simulation.door.exchange import (
    COMMAND,
    COMMANDS,
    IGNORED_AT,
    IGNORED_STATUS,
    LARGEST,
    PROGRESSES,
    SIGNALS,
    SWITCHES,
)
from pvlvrt_compliance.simulation.door.table import HELD_EACH, HELD_ONCE, RUNS_FREE, DoorTable, Timing
from pvlvrt_compliance.simulation.electronics import hardware_of
from pvlvrt_compliance.simulation.loop import run
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.recorder import RecordingPlan, every_period
from pvlvrt_compliance.simulation.settled_run import LoopState, lines_of, state_after, with_lines
from pvlvrt_compliance.simulation.told import Told, told_of
from pvlvrt_compliance.simulation.translate import (
    controller_params,
    nominal_of,
    plant_params,
    plant_tables,
    steady_state,
)

SETTLING_S = 1.0
"""Unrecorded time of a controller from outside, unless it is set (s): it starts at rest."""

_ARMED_AFTER = 0.5  # share of the settling after which the relays trip

IGNORED_WORDS = "ignored, as it came after a trip"
"""How a note begins that tells of a fault which did not end the run."""

_REASONS: Mapping[int, str] = {
    outcome.NOT_FINITE: "a number of the plant stopped being finite",
    outcome.OUTPUT_NOT_FINITE: "a command of the controller is not a finite number",
    outcome.OUTPUT_OUT_OF_RANGE: "a command of the controller is out of range",
    outcome.CONTROLLER_FAILED: "the controller failed",
}


class ForeignRecord(NamedTuple):
    """What a run gives: a column of samples for every channel."""

    channels: tuple[str, ...]
    samples: NDArray[np.float64]
    notes: tuple[str, ...] = ()  # what the controller had to say
    tripped_at_s: float | None = None
    state: bytes | None = None  # where the run was at its end (`resting`), if that is kept
    stateless: str = ""  # why it is not, though it was asked for


def settling_s_of(parameters: Parameters) -> float:
    """How long a controller from outside settles before a record (s)."""
    simulation = parameters.simulation
    return simulation.settling_s if "settling_s" in simulation.model_fields_set else SETTLING_S


def settling_samples(parameters: Parameters, rates: Rates) -> int:
    """Whole sample times in which the controller acts before the record."""
    return not_below(settling_s_of(parameters) / rates.sample_time_s)


_HOLD = {"each": HELD_EACH, "once": HELD_ONCE, "run": RUNS_FREE}


def timing_of(parameters: Parameters, rates: Rates, sample_time_s: float) -> Timing:
    """When the relays are armed and the controller sees something, in whole sample times."""
    return Timing(
        armed=-math.ceil((1 - _ARMED_AFTER) * settling_samples(parameters, rates)) * rates.periods,
        ratio=rates.periods,
        held=not_below(parameters.simulation.synchronising_s / rates.sample_time_s),
        sample_time=sample_time_s,
        hold=_HOLD[parameters.controller.hold],
    )


def run_through(
    door: Door,
    scenario: Scenario,
    parameters: Parameters,
    plan: RecordingPlan,
    progress: NDArray[np.float64],
    *,
    after_trip: bool = True,
    since: bytes | None = None,
    keeps: bool = False,
) -> ForeignRecord:
    """Open a door and run its controller through a scenario.

    Parameters
    ----------
    plan : RecordingPlan
        In periods of `rates_of`.
    progress : array, shape (`exchange.PROGRESSES`,)
        Not a number at first; kept at the simulated time (s), and at what is ignored after a trip.
    after_trip : bool
        Whether the controller is called after a trip, too.
    since : bytes, optional
        Where an earlier run was at its end, to go on from there; the plan begins no earlier.
    keeps : bool
        Whether it is kept where this one is at its end, which has to be a sample of the controller's.

    Raises
    ------
    SimulationError
        When the controller fails or gives what cannot be used, with the simulated time.
    UsageError
        When it cannot be opened, or its sample time cannot be used.
    """
    sample_time_s = door.describe().sample_time_s
    rates = rates_of(sample_time_s, parameters)
    parameters = with_rates(parameters, rates)
    plant, tables = plant_params(parameters, scenario), plant_tables(parameters, scenario)
    first, timing = -settling_samples(parameters, rates) * rates.periods, timing_of(parameters, rates, sample_time_s)
    period_s = plant.ratio * plant.T_S
    controller = controller_params(parameters, scenario)
    start = steady_state(plant, tables.grid, controller, scenario, first * period_s)
    calls = (int(plan.first[-1]) - first) // timing.ratio + 1
    nominal = nominal_of(parameters, scenario)
    state = None if since is None else unpacked(since)
    opened = door.open(nominal) if state is None else door.resume(nominal, state.controller)
    known = len(opened.notes)  # of one that goes on: said before, too
    try:
        table = door_table(opened, told_of(scenario, parameters, tables), timing, progress, after_trip=after_trip)
        samples = np.empty((sum(plan.rows), len(RECORDED) + len(opened.recorded)))
        hardware = hardware_of(parameters, start, calls)
        at = LoopState(start.plant, None, start.m, first, 0, lines_of(hardware))
        if state is not None:
            table.commands[:] = state.commands
            at = state.loop
        of_run = (plant, tables, None, with_lines(hardware, at.lines), table, plan, samples, at.k)
        ended = run(at.plant, None, at.m, at.period, *of_run)
        if ended.status != outcome.COMPLETED:
            raise SimulationError(_explained(ended.status, ended.period * period_s, table, door.message()))
        ignored = _ignored(table, door.message())
        notes = opened.notes if state is None else [*dict.fromkeys((*state.notes, *opened.notes[known:]))]
        kept = _kept(door, table, state_after(ended, at.lines), notes) if keeps else {}
    finally:
        door.close()
    return ForeignRecord(
        (*RECORDED, *opened.recorded),
        samples,
        (*notes, *ignored),
        outcome.tripped_at_s(ended.plant, int(plan.first[-1]) * period_s),
        **kept,
    )


def _kept(door: Door, table: DoorTable, loop: LoopState | None, notes: Sequence[str]) -> Any:
    """Where a run is at its end, or why that cannot be kept, as fields of its record."""
    try:
        return {"state": at_rest(door, table, loop, notes).packed()}
    except DoorError as error:
        return {"stateless": str(error)}


def door_table(
    opened: DoorCall,
    told: Told,
    timing: Timing,
    progress: NDArray[np.float64],
    *,
    after_trip: bool = True,
) -> DoorTable:
    """An open door as the loop has it, told what it is of its plant."""
    signals = np.zeros(len(SIGNALS))
    for name, value in told.fixed.items():
        signals[SIGNALS.index(name)] = value
    given = {element.signal for element in opened.outputs.elements}
    return DoorTable(
        address=opened.address,
        first_address=opened.first_address,
        hold_address=opened.hold_address,
        note_address=opened.note_address,
        argument=opened.argument,
        inputs=port_table(opened.inputs),
        outputs=port_table(opened.outputs),
        in_volts=opened.in_volts,
        in_a_frame=opened.in_a_frame,
        latches=COMMAND.restart in given,
        after_trip=after_trip,
        signals=signals,
        commands=np.zeros(len(COMMANDS) + len(opened.recorded)),
        available=told.available,
        irradiance=told.irradiance,
        timing=timing._replace(every=opened.every),
        progress=progress,
    )


def _ignored(table: DoorTable, said: str) -> tuple[str, ...]:
    """What would have ended the run, had it not come after a trip."""
    status, t = table.progress[IGNORED_STATUS], float(table.progress[IGNORED_AT])
    if math.isnan(status):
        return ()
    return (f"{IGNORED_WORDS}: {_explained(int(status), t, table, said)}",)


def _explained(status: int, t: float, table: DoorTable, said: str) -> str:
    text = f"{_REASONS[status]} at {when(t)}"
    if status in (outcome.OUTPUT_NOT_FINITE, outcome.OUTPUT_OUT_OF_RANGE):
        names = VOLTAGES if table.in_volts else MODULATING
        switches = [name for name in SWITCHES if not math.isfinite(table.commands[COMMANDS.index(name)])]
        names = (*names, *switches)
        text += f": {', '.join(f'{name} = {table.commands[COMMANDS.index(name)]:g}' for name in names)}"
        if status == outcome.OUTPUT_OUT_OF_RANGE:
            text += f" (at most {LARGEST[names[0]]:g})"
    elif status == outcome.CONTROLLER_FAILED:
        text += f": {said}" if said else ""
    return text


def when(t: float) -> str:
    """Simulated time (s) in words."""
    return f"{t:.4f} s" if t >= 0 else f"{t:.4f} s, before the record begins"


def warm_up() -> None:
    """Have the loop compiled, or read from its cache, without a step."""
    scenario, parameters = Scenario(sag=Sag(depth=0.9), duration_s=0.3), Parameters()
    plant, tables = plant_params(parameters, scenario), plant_tables(parameters, scenario)
    start = steady_state(plant, tables.grid, controller_params(parameters, scenario), scenario, 0.0)
    opened = DoorCall(address=0, argument=0, inputs=real_block([]), outputs=real_block([]))
    timing = Timing(armed=0, ratio=1, held=0, sample_time=1.0)
    door = door_table(opened, told_of(scenario, parameters, tables), timing, np.zeros(PROGRESSES))
    samples = np.empty((0, len(RECORDED)))
    run(start.plant, None, start.m, 0, plant, tables, None, None, door, every_period(0), samples)
