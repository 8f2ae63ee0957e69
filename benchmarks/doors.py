"""Times a control step through the door for C over the C code itself, and a whole test with a controller in C.

The controller is examples/bundled-controller-c. Its Model_Outputs is called from a loop in C, then from the compiled
loop of the package with everything that the door adds, on the same inputs in the same process, in turn. Exit status 1
when a limit is given and exceeded; 2 without a C compiler.
"""

import argparse
import ctypes
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numba
import numpy as np
from twin import CONTROLLER, compiler

import pvlvrt_compliance
from pvlvrt_compliance.controllers.door import DoorCall
from pvlvrt_compliance.controllers.library.door import LibraryDoor
from pvlvrt_compliance.controllers.run import door_table
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.plant.plant import PlantState
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.door.call import call, commanded, hold, put_powers, put_signals
from pvlvrt_compliance.simulation.door.exchange import PROGRESSES
from pvlvrt_compliance.simulation.door.table import DoorTable, Timing
from pvlvrt_compliance.simulation.outcome import COMPLETED
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.simulation.told import told_of
from pvlvrt_compliance.simulation.translate import controller_params, plant_params, plant_tables, steady_state
from pvlvrt_compliance.units import Nominal

_STEPS = 100_000
_TEST = Scenario(sag=Sag(depth=0.9), duration_s=0.309, after_s=1.5 - 0.3 - 0.309)
_LOOP_IN_C = """
#include <stdint.h>
int32_t repeat(int32_t (*outputs)(void *), void *instance, int64_t count)
{
    int32_t answers = 0;
    for (int64_t n = 0; n < count; n++)
        answers |= outputs(instance);
    return answers;
}
"""


class Step(NamedTuple):
    """Time of a control step, pair by pair (us)."""

    in_c: list[float]
    by_door: list[float]

    @property
    def over_c(self) -> float:
        """Median of what the door adds (us)."""
        return statistics.median(b - a for a, b in zip(self.in_c, self.by_door, strict=True))


def build(folder: Path) -> tuple[Path, Any]:
    """Build the controller, and a loop in C that calls it."""
    interface = Path(pvlvrt_compliance.__file__).parent / "controllers" / "library"
    gcc = compiler() or "gcc"
    flags = ["-std=c99", "-O2", "-shared", "-fPIC"]
    library, loop = folder / "libcontroller.so", folder / "loop.so"
    subprocess.run([gcc, *flags, "-I", interface, CONTROLLER / "controller.c", "-o", library, "-lm"], check=True)
    (folder / "loop.c").write_text(_LOOP_IN_C, encoding="utf-8")
    subprocess.run([gcc, *flags, folder / "loop.c", "-o", loop], check=True)
    repeat = ctypes.CDLL(str(loop)).repeat
    repeat.argtypes = (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64)
    return library, repeat


@numba.njit(error_model="numpy")
def repeat_by_door(door: DoorTable, seen: Measured, plant: PlantState, m: complex, count: int) -> float:
    """What the loop does for the controller in one sample, so many times."""
    total = 0.0
    for n in range(count):
        put_powers(door, 1.0)
        put_signals(door.signals, 1e-4 * n, seen, 0.0, plant, m, 1.0, 1.0)
        if call(door) != COMPLETED:
            return np.nan
        total += abs(commanded(door, seen.v_dc))
    return total


@numba.njit(error_model="numpy")
def begin(door: DoorTable, seen: Measured, plant: PlantState, m: complex) -> int:
    """Start the controller in this state of the plant."""
    put_powers(door, 1.0)
    put_signals(door.signals, 0.0, seen, 0.0, plant, m, 1.0, 0.0)
    return hold(door, True)


def time_step(library: Path, repeat: Any, pairs: int) -> Step:
    """Time a control step in a loop in C and through the door, in turn, after one of each to warm up."""
    parameters = Parameters()
    plant = plant_params(parameters, _TEST)
    tables = plant_tables(parameters, _TEST)
    start = steady_state(plant, tables.grid, controller_params(parameters, _TEST), _TEST, 0.0)
    seen = Measured(u_g_ab=start.u_g_ab, i_ab=start.plant.i, v_dc=start.plant.v_dc, i_pv=start.plant.i_pv)
    door = LibraryDoor(str(library), {})
    opened: DoorCall = door.open(Nominal())
    timing = Timing(armed=0, ratio=1, held=0, sample_time=1e-4)
    table = door_table(opened, told_of(_TEST, parameters, tables), timing, np.full(PROGRESSES, np.nan))
    if begin(table, seen, start.plant, start.m) != COMPLETED:
        raise RuntimeError(door.message())
    rows = [
        (
            _us_a_step(lambda: repeat(opened.address, opened.argument, _STEPS)),
            _us_a_step(lambda: repeat_by_door(table, seen, start.plant, start.m, _STEPS)),
        )
        for _ in range(pairs + 1)
    ]
    door.close()
    return Step(*(list(column) for column in zip(*rows[1:], strict=True)))


def _us_a_step(run: Any) -> float:
    start = time.process_time()
    result = run()
    spent = time.process_time() - start
    if not np.isfinite(result):
        raise RuntimeError("the controller failed")
    return 1e6 * spent / _STEPS


def time_tests(library: Path, runs: int) -> tuple[list[float], list[float]]:
    """Wall time of a test of 1.5 s with the controller in C and with the bundled one (s), after one of each."""
    parameters = Parameters()
    in_c = ForeignSimulator(str(library))
    return _wall_s(partial(in_c, _TEST, parameters), runs), _wall_s(partial(simulate, _TEST, parameters), runs)


def _wall_s(run: Any, runs: int) -> list[float]:
    times = []
    for _ in range(runs + 1):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return times[1:]


def options(arguments: Sequence[str] | None) -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").strip())
    parser.add_argument("--pairs", type=int, default=15, help="timed repetitions of each (default 15)")
    parser.add_argument("--step-limit", type=float, help="exit with status 1 when the door adds more (us)")
    parser.add_argument("--test-limit", type=float, help="exit with status 1 when a test takes longer (s)")
    return parser.parse_args(arguments)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the benchmark; return its exit status."""
    chosen = options(arguments)
    if compiler() is None:
        print("gcc is missing: there is nothing to compare with", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:  # a loaded library stays where it is
        library, repeat = build(Path(folder))
        step = time_step(library, repeat, chosen.pairs)
        in_c, bundled = time_tests(library, chosen.pairs)
    print(f"Processor time of a control step, {_STEPS} at a time, {chosen.pairs} of each in turn:")
    for name, us in (("loop in C", step.in_c), ("by the door", step.by_door)):
        print(f"  {name:11} {min(us):.3f} us at least, {statistics.median(us):.3f} us median")
    print(f"  the door adds {step.over_c:.3f} us (median of the differences)")
    print(f"Wall time of a test of {_TEST.end_s:g} s in a worker that is warm, {chosen.pairs} runs:")
    for name, s in (("controller in C", in_c), ("bundled", bundled)):
        print(f"  {name:15} {min(s):.3f} s at least, {statistics.median(s):.3f} s median")
    slow = chosen.step_limit is not None and step.over_c > chosen.step_limit
    long = chosen.test_limit is not None and statistics.median(in_c) > chosen.test_limit
    return 1 if slow or long else 0


if __name__ == "__main__":
    sys.exit(main())
