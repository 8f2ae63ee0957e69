"""What one model costs by three doors: the same law in C, as an FMU and in Python, microseconds a control step.

    python benchmarks/vendor_doors.py [--pairs 15] [--calls 20000]

The model is examples/vendor-model. A control step is everything that the loop over time does for a controller in one
sample; its reference, in turn with it in the same process, is the model's code in C called bare. Needs the extra fmi,
gcc and make. Processor time.
"""

import argparse
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
from callback_doors import ROOT, call_often
from doors import _TEST, begin, repeat_by_door

from pvlvrt_compliance.controllers.doors import door_to
from pvlvrt_compliance.controllers.library import HEADER
from pvlvrt_compliance.controllers.run import door_table
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.simulation.door.exchange import PROGRESSES
from pvlvrt_compliance.simulation.door.table import Timing
from pvlvrt_compliance.simulation.outcome import COMPLETED
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.told import told_of
from pvlvrt_compliance.simulation.translate import controller_params, plant_params, plant_tables, steady_state
from pvlvrt_compliance.units import Nominal

FORMS = {"C": "liblcl1000.so", "FMI 2": "LCL1000.fmu", "Python": "lcl1000.py:LCL1000"}
GIVEN = {"VLLbase": 398.37, "Sbase": 500.0, "UV1_level": 0.0, "UV2_level": 0.0}
"""Bases of the plant; its voltage stands still here, which no protection is to mind."""


def build(folder: Path) -> Path:
    """Build a copy of the example."""
    copy = folder / "vendor-model"
    shutil.copytree(ROOT / "examples" / "vendor-model", copy, ignore=shutil.ignore_patterns("*.so", "*.fmu"))
    subprocess.run(["make", "-s", f"INTERFACE={HEADER.parent}", f"PYTHON={sys.executable}"], cwd=copy, check=True)
    return copy


def steps(door: Any) -> tuple[Callable[[int], object], Callable[[int], object]]:
    """So many control steps by a door in the steady state, and so many calls of what lies behind it."""
    parameters = Parameters()
    plant = plant_params(parameters, _TEST)
    tables = plant_tables(parameters, _TEST)
    start = steady_state(plant, tables.grid, controller_params(parameters, _TEST), _TEST, 0.0)
    seen = Measured(u_g_ab=start.u_g_ab, i_ab=start.plant.i, v_dc=start.plant.v_dc, i_pv=start.plant.i_pv)
    opened = door.open(Nominal())
    timing = Timing(armed=0, ratio=1, held=0, sample_time=1e-4)
    table = door_table(opened, told_of(_TEST, parameters, tables), timing, np.full(PROGRESSES, np.nan))
    if begin(table, seen, start.plant, start.m) != COMPLETED:
        raise RuntimeError(door.message())

    def by_door(count: int) -> object:
        if not np.isfinite(found := repeat_by_door(table, seen, start.plant, start.m, count)):
            raise RuntimeError(door.message())
        return found

    return by_door, lambda count: call_often(opened.address, opened.argument, count)


def us_a_step(run: Callable[[int], object], count: int) -> float:
    """Processor time of one of so many (us)."""
    begun = time.process_time()
    run(count)
    return 1e6 * (time.process_time() - begun) / count


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=15, help="timed repetitions of each (default 15)")
    parser.add_argument("--calls", type=int, default=20_000)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:  # a loaded library stays where it is
        folder = build(Path(name))
        for form, spec in FORMS.items():
            with (
                closing(door_to(str(folder / spec), GIVEN)) as door,
                closing(door_to(str(folder / FORMS["C"]), GIVEN)) as own,
            ):
                by_door, _ = steps(door)
                feed, bare = steps(own)
                feed(1)  # the inputs that it is called with are those of a step
                rows = [(us_a_step(by_door, given.calls), us_a_step(bare, given.calls)) for _ in range(given.pairs + 1)]
            found, reference = (statistics.median(column) for column in zip(*rows[1:], strict=True))
            ratio = statistics.median(a / b for a, b in rows[1:])
            print(f"{form:7} {found:7.2f} us a control step, {reference:.2f} us its code in C alone: {ratio:.1f} times")


if __name__ == "__main__":
    main()
