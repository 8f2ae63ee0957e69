"""From a scenario and parameters to waveforms."""

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.precision import in_single_precision
from pvlvrt_compliance.errors import SimulationError
from pvlvrt_compliance.plant import pv_array
from pvlvrt_compliance.plant.grid import PlaybackTable
from pvlvrt_compliance.plant.plant import PlantTables
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.timeline import busy_stretches
from pvlvrt_compliance.simulation.columns import CHANNELS
from pvlvrt_compliance.simulation.common_start import CommonStarts
from pvlvrt_compliance.simulation.electronics import hardware_of
from pvlvrt_compliance.simulation.loop import run
from pvlvrt_compliance.simulation.outcome import COMPLETED, Outcome, tripped_at_s
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.recorder import RecordingPlan, every_period, plan_of, with_settling
from pvlvrt_compliance.simulation.settled_run import (
    LoopState,
    SettledRun,
    lines_of,
    settling_periods,
    start_of,
    through,
    with_lines,
)
from pvlvrt_compliance.simulation.thinning import Busy, too_much
from pvlvrt_compliance.simulation.translate import (
    control_period_s,
    controller_params,
    plant_params,
    plant_tables,
    pv_params,
    steady_state,
)
from pvlvrt_compliance.waveforms import Segment, Waveforms
from pvlvrt_compliance.waveforms.breaker import opened_at_s

_ROWS_AT_ONCE = 512


def simulate(  # type: ignore[no-untyped-def]
    scenario: Scenario,
    parameters: Parameters,
    run=run,
    *,
    thin: bool = True,
    starts: CommonStarts[SettledRun] | None = None,
) -> Waveforms:
    """Run plant and controller through a scenario, from the steady state of normal operation.

    A record of 5 s and more holds every control period around whatever happens, and fewer elsewhere (`recorder`). Where
    the inverter trips there, the run is made once more with its trip among what happens.

    Parameters
    ----------
    scenario : Scenario
        Grid, weather and sag.
    parameters : Parameters
        Everything else.
    run : compiled function, optional
        Loop over time with the signature of `loop.run`; the bundled controller's by default.
    thin : bool
        Whether long records are thinned out.
    starts : CommonStarts, optional
        Settled states that several runs go on from; the record is the same to the bit.

    Raises
    ------
    SimulationError
        When a number stops being finite, with the simulated time.
    """
    tables = plant_tables(parameters, scenario)

    def make(plan: RecordingPlan) -> Waveforms:
        return _run(scenario, parameters, tables, plan, run, starts)

    T_reg, simulation = control_period_s(parameters), parameters.simulation
    settling = math.floor(simulation.settling_s / T_reg) if simulation.record_settling else 0
    return recorded(scenario, tables.playback, T_reg, make, thin=thin, settling=settling)


def recorded(
    scenario: Scenario,
    playback: PlaybackTable | None,
    T_reg: float,
    make: Callable[[RecordingPlan], Waveforms],
    *,
    thin: bool = True,
    settling: int = 0,
) -> Waveforms:
    """Record of a scenario that holds every period (of ``T_reg``, s) where something happens, as `simulate` says.

    ``make`` runs the scenario by a plan; it is called again where the inverter has tripped while the record was thin.
    So many periods of ``settling`` are recorded before it.

    Raises
    ------
    SimulationError
        When the record takes more memory than one may.
    """
    periods = math.floor(scenario.end_s / T_reg) + 1
    busy = [*busy_stretches(scenario), *_played(playback)]
    plan = plan_of(busy, periods, T_reg) if thin else every_period(periods)
    waveforms = make(_affordable(with_settling(plan, settling, T_reg)))
    opened_s = _opened_while_thin_s(waveforms)
    if opened_s is None:
        return waveforms
    del waveforms  # the second record takes its place
    return make(_affordable(with_settling(plan_of([*busy, (opened_s, opened_s)], periods, T_reg), settling, T_reg)))


def _affordable(plan: RecordingPlan) -> RecordingPlan:
    """A plan whose record fits into the memory that one may take; what a recording adds is not known before a run."""
    if (said := too_much(sum(plan.rows))) is not None:
        raise SimulationError(said)
    return plan


def _played(playback: PlaybackTable | None) -> list[Busy]:
    """When a recording is played back, during which anything may happen."""
    return [] if playback is None else [(playback.t, playback.t + len(playback.u) * playback.dt)]


def _opened_while_thin_s(waveforms: Waveforms) -> float | None:
    """First sample with the breaker open (s), where not every control period was recorded; None otherwise."""
    opened_s = opened_at_s(waveforms)
    if opened_s is None:
        return None
    step = min(segment.dt_s for segment in waveforms)
    here = next(segment for segment in reversed(waveforms.segments) if segment.t0_s <= opened_s)
    return opened_s if here.dt_s > 1.5 * step else None


def _run(  # type: ignore[no-untyped-def]
    scenario: Scenario,
    parameters: Parameters,
    tables: PlantTables,
    plan: RecordingPlan,
    run,
    starts: CommonStarts[SettledRun] | None,
) -> Waveforms:
    plant = plant_params(parameters, scenario)
    controller = controller_params(parameters, scenario)
    T_reg = control_period_s(parameters)
    settling = settling_periods(parameters)
    start = steady_state(plant, tables.grid, controller, scenario, -settling * T_reg)
    hardware = hardware_of(parameters, start, settling + int(plan.first[-1]))
    state = start.controller
    if parameters.controller.precision == "single":
        state, controller = in_single_precision(state, controller)

    def go_on(x: LoopState, plan: RecordingPlan) -> tuple[Outcome, NDArray[np.float64]]:
        samples = np.empty((len(CHANNELS), sum(plan.rows))).T  # a channel lies in one piece, as a record has it
        of_run = (plant, tables, controller, with_lines(hardware, x.lines), None, plan, samples, x.k)
        return run(x.plant, x.controller, x.m, x.period, *of_run), samples

    first = LoopState(start.plant, state, start.m, -settling, 0, lines_of(hardware))
    common = start_of(scenario, parameters) if starts is not None else None
    outcome, samples = through(first, plan, go_on, starts, common)
    if outcome.status != COMPLETED:
        raise SimulationError(f"a number stopped being finite at {max(outcome.period, 0) * T_reg:.4f} s")
    return record_of(samples, plan, T_reg, tripped_at_s=tripped_at_s(outcome.plant, int(plan.first[-1]) * T_reg))


def record_of(
    samples: NDArray[np.float64],
    plan: RecordingPlan,
    T_reg: float,
    channels: Sequence[str] = CHANNELS,
    *,
    tripped_at_s: float | None = None,
) -> Waveforms:
    """Rows as segments, one a stretch, those before 0 as settling; columns as channels."""
    segments = []
    row = 0
    for first, step, rows in zip(plan.first.tolist(), plan.step.tolist(), plan.rows, strict=False):
        columns = _columns(samples[row : row + rows])
        segments.append(Segment(first * T_reg, step * T_reg, dict(zip(channels, columns, strict=True))))
        row += rows
    settling = tuple(segment for segment in segments if segment.t0_s < 0)
    return Waveforms(tuple(segments[len(settling) :]), settling, tripped_at_s)


def _columns(samples: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rows turned into columns, some at a time: so many stay in the fast memory while they are turned.

    What already has its columns in one piece each stays where it is.
    """
    if samples.strides[0] == samples.itemsize:
        return samples.T
    columns = np.empty(samples.shape[::-1])
    for first in range(0, len(samples), _ROWS_AT_ONCE):
        columns[:, first : first + _ROWS_AT_ONCE] = samples[first : first + _ROWS_AT_ONCE].T
    return columns


def available_power_w(scenario: Scenario, parameters: Parameters) -> float:
    """Most that the array can give in this scenario (W)."""
    return pv_array.maximum_power_point(scenario.irradiance_w_m2, pv_params(parameters, scenario)).p
