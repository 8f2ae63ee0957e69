"""Times the compiled loop of the package beside a C twin of the same equations.

The twin is built into a temporary folder and must first give the package's waveforms. Exit status 1 when it does not,
or when a limit is given and exceeded; 2 without a C compiler.
"""

import argparse
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from agreement import TOLERANCE, differences
from row import Row
from twin import SCENARIOS, Arguments, Twin, arguments_of, compiler

from pvlvrt_compliance.simulation import loop

_PAIRS_MIN = 10


class Timing(NamedTuple):
    """Time a plant step of package and twin, pair by pair (ns)."""

    package: list[float]
    twin: list[float]

    @property
    def ratio_of_medians(self) -> float:
        """Median of the package over that of the twin."""
        return statistics.median(self.package) / statistics.median(self.twin)

    @property
    def median_ratio(self) -> float:
        """Median of the pairwise ratios: what a machine whose clock wanders says best."""
        return statistics.median(a / b for a, b in zip(self.package, self.twin, strict=True))


def unequal_waveforms(twin: Twin) -> Iterator[str]:
    """Run every scenario both ways, print the largest difference, and yield what is wrong."""
    for name, scenario in SCENARIOS.items():
        mine, theirs = arguments_of(scenario), arguments_of(scenario)
        outcome, other = loop.run(*mine), twin.run(theirs)
        apart = differences(mine.samples, theirs.samples)
        channel = max(apart, key=apart.__getitem__)
        print(f"  {name}: at most {apart[channel]:.1e} of nominal ({channel})")
        if apart[channel] > TOLERANCE:
            yield f"{name}: {channel} differs by {apart[channel]:.1e} of nominal"
        if (outcome.status, outcome.period, outcome.plant.trip) != (other.status, other.period, other.plant.trip):
            yield f"{name}: the runs end differently"


def cpu_ns_a_step(call: Callable[[], Any], arguments: Arguments) -> float:
    """Processor time of one call by the number of plant steps (ns)."""
    start = time.process_time()
    call()
    return 1e9 * (time.process_time() - start) / arguments.plant_steps


def time_pairs(twin: Twin, pairs: int) -> Timing:
    """Time package and twin in turn on the three-phase 90 % sag, after a run of each to warm up."""
    arguments = arguments_of(next(iter(SCENARIOS.values())))
    arguments.samples.fill(0.0)  # pages in the memory that both write
    calls = (lambda: loop.run(*arguments), twin.prepare(arguments))
    for call in calls:
        call()
    rows = np.array([[cpu_ns_a_step(call, arguments) for call in calls] for _ in range(pairs)])
    return Timing(package=rows[:, 0].tolist(), twin=rows[:, 1].tolist())


def print_timing(timing: Timing) -> None:
    """Print a line each, and the ratios."""
    for name, ns in (("package", timing.package), ("C twin", timing.twin)):
        print(f"  {name:8} {min(ns):6.1f} ns at least, {statistics.median(ns):6.1f} ns median")
    print(f"  ratio of the medians {timing.ratio_of_medians:.2f}, median of the ratios {timing.median_ratio:.2f}")


def rows(pairs: int) -> Iterator[Row]:
    """Row of the table; none without a C compiler.

    Raises
    ------
    RuntimeError
        When package and twin do not give the same waveforms: their times say nothing then.
    """
    if compiler() is None:
        return
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        twin = Twin(Path(folder))
        if problems := list(unequal_waveforms(twin)):
            raise RuntimeError("; ".join(problems))
        timing = time_pairs(twin, pairs)
    yield Row(
        "compiled loop against its C twin, a plant step",
        [a / b for a, b in zip(timing.package, timing.twin, strict=True)],
        "x",
        must=1.1,
        stretch=1.0,
        reference="C twin, gcc -O3 -march=native",
        reference_values=timing.twin,
        reference_unit="ns",
    )


def options(arguments: Sequence[str] | None) -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(
        description=(__doc__ or "").strip(),
        epilog="example: python benchmarks/speed.py --pairs 40 --limit 2.0",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--pairs", type=int, default=20, help="timed runs of each, in turn (default 20, at least 10)")
    parser.add_argument("--limit", type=float, help="exit with status 1 when the median of the ratios is above it")
    chosen = parser.parse_args(arguments)
    if chosen.pairs < _PAIRS_MIN:
        parser.error(f"--pairs must be at least {_PAIRS_MIN}")
    return chosen


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the benchmark; return its exit status."""
    chosen = options(arguments)
    if compiler() is None:
        print("gcc is missing: there is nothing to compare with", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:  # a loaded library stays where it is
        twin = Twin(Path(folder))
        print("Waveforms of the package and of the C twin:")
        problems = list(unequal_waveforms(twin))
        timing = time_pairs(twin, chosen.pairs)
    print(f"Processor time of a plant step, {chosen.pairs} runs of each in turn:")
    print_timing(timing)
    if chosen.limit is not None and timing.median_ratio > chosen.limit:
        problems.append(f"the package takes {timing.median_ratio:.2f} times as long as C, more than {chosen.limit:g}")
    for problem in problems:
        print(problem, file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
