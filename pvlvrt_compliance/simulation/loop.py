"""The only loop over time: plant, hardware and controller, one control period after another."""

import math

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.controller import ControllerParams, ControllerSignals, ControllerState
from pvlvrt_compliance.hardware.hardware import Hardware, acting_as_sampled, acting_from
from pvlvrt_compliance.kernel import cached_kernel, kernel
from pvlvrt_compliance.plant.grid import source_at
from pvlvrt_compliance.plant.plant import PlantParams, PlantState, PlantTables, advance, as_at, observe
from pvlvrt_compliance.plant.protection import NO_TRIP
from pvlvrt_compliance.simulation.columns import record_controller, record_plant
from pvlvrt_compliance.simulation.controlling import commanding, controlled
from pvlvrt_compliance.simulation.door.call import IGNORED, call_or_ignore, commanded
from pvlvrt_compliance.simulation.door.controller import (
    put_sample,
    record_foreign,
    synchronised_controller,
    untripped,
)
from pvlvrt_compliance.simulation.door.switches import all_off, switched_by, switches_of
from pvlvrt_compliance.simulation.door.table import DoorTable
from pvlvrt_compliance.simulation.outcome import COMPLETED, NOT_FINITE, Onward, Outcome
from pvlvrt_compliance.simulation.recorder import RecordingPlan, next_row
from pvlvrt_compliance.simulation.sample import sampled


@kernel
def is_finite(x: PlantState, s: ControllerSignals) -> bool:
    """Whether every number that the next sample depends on is one: a sum is finite only if all its terms are.

    After a trip the bridge is blocked, and none depends on the controller.
    """
    plant = x.v_dc + x.i.real + x.i.imag + x.i_pv
    if x.trip != NO_TRIP:
        return math.isfinite(plant)
    return math.isfinite(plant + s.m.real + s.m.imag + s.w + s.P_ref + s.v_ref)


@kernel
def ended(status: int, period: int, plant: PlantState, x: ControllerState | None, m: complex, k: int) -> Outcome:
    """How a run ends, with what another needs to go on."""
    return Outcome(status=status, period=period, plant=plant, onward=Onward(controller=x, m=m, k=k))


@cached_kernel
def run(  # noqa: PLR0912 - one for all that may be none; those cost nothing, and to hand a door on does
    plant: PlantState,
    controller: ControllerState | None,
    m: complex,
    first: int,
    plant_params: PlantParams,
    tables: PlantTables,
    controller_params: ControllerParams | None,
    hardware: Hardware | None,
    door: DoorTable | None,
    plan: RecordingPlan,
    samples: NDArray[np.float64],
    k: int = 0,
) -> Outcome:
    """Simulate from control period ``first`` (negative: unrecorded settling) to the end of the plan.

    The controller samples at the beginning of a period; what it computes acts from its next sample on, held in between:
    1.5 periods in all, unless ``hardware`` says otherwise. Period n begins at n T_reg.

    The bundled controller samples in every period. One behind a ``door`` first sees the steady state that the plant is
    in, turned back in time, and its commands do not act; then it samples in every ``door.timing.ratio``-th period.

    Parameters
    ----------
    plant : PlantState
        State at the beginning.
    controller, controller_params : ControllerState and ControllerParams, or None
        The bundled controller; none where there is a door.
    m : complex
        Modulating signal of the first period (-).
    hardware : Hardware or None
        Sensors and delays; none: they are ideal, and of one sample.
    door : DoorTable or None
        A controller from outside in place of the bundled one.
    plan : RecordingPlan
        Which periods are recorded.
    samples : array, shape (n, len(columns.CHANNELS))
        Filled with the record, a row for every period of the plan; with a door of shape (n, len(columns.RECORDED) +
        further signals).
    k : int
        Samples that the controller has taken before: of a run that goes on where another has ended, with plant,
        controller, ``m`` and hardware as they were then, no switch on, and ``first`` a period in which it samples.
    """
    T_reg = plant_params.ratio * plant_params.T_S
    if door is not None:
        status, period = synchronised_controller(plant, m, first, plant_params, tables, door, k == 0)
        if status != COMPLETED:
            return ended(status, period, plant, controller, m, k)
    relay, signals, switches, sampling = plant.relay, commanding(m), all_off(), True
    # A literal would have whatever it is handed to compiled twice: for it, and for the number that it becomes.
    zero: int = np.int64(0)  # type: ignore[assignment]
    k_grid = zero
    row, stretch, due = zero, zero, plan.first[0]
    for n in range(first, plan.first[-1]):
        t = n * T_reg
        source = source_at(t, k_grid, tables.grid)
        k_grid = source.k
        if door is not None:
            sampling = (n - first) % door.timing.ratio == 0
            if sampling:
                plant = switched_by(plant, switches, door)
        if sampling:
            m = acting_as_sampled(signals.m, k, hardware)
        now = as_at(t, k_grid, plant_params, tables)
        y = observe(plant, m, source, t, now, tables)
        if sampling:
            sample = sampled(plant, y, m, now.G, t, k, hardware)
            if controller_params is not None:
                controller, signals = controlled(controller, sample.seen, controller_params)
            if door is not None:
                put_sample(door, sample, plant)
                status = call_or_ignore(door, t, plant.trip != NO_TRIP)
                if status == COMPLETED:
                    signals = commanding(commanded(door, sample.seen.v_dc))
                    switches = switches_of(door)
                elif status != IGNORED:
                    return ended(status, n, plant, controller, signals.m, k)
        if not is_finite(plant, signals):
            return ended(NOT_FINITE, n, plant, controller, signals.m, k)
        if n == due:
            record_plant(samples[row], plant, y, now.G)
            if controller_params is not None:
                record_controller(samples[row], signals)
            if door is not None:
                record_foreign(samples[row], signals.m, door.commands)
            row += 1
            stretch, due = next_row(stretch, n, plan)
        if sampling:
            m = acting_from(m, signals.m, k, hardware)
            k += 1
        plant = advance(plant, m, source, t, now, tables)
        if door is not None and n < door.timing.armed:
            plant = untripped(plant, relay)
    return ended(COMPLETED, plan.first[-1], plant, controller, signals.m, k)
