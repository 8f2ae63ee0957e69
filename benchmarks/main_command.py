"""Times the main command and its peak memory: warm, with an empty cache of compiled code, and its help.

Imports nothing but the standard library: on Linux a child's peak memory is at least that of the process starting it.
"""

import argparse
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

_COMMAND = "pvlvrt-check"
_MAIN_JOB = ("--profile", "iec61400-21", "--sag", "90%")
_EVALUATED = (0, 1)  # exit statuses of a job that ran to its verdicts


class Run(NamedTuple):
    """One run of a command."""

    status: int  # exit status
    wall_s: float
    peak_mb: float | None  # peak resident memory; None where the system does not tell


def run(command: Sequence[str], environment: Mapping[str, str]) -> Run:
    """Run a command to its end and throw its output away."""
    start = time.perf_counter()
    child = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    if not hasattr(os, "wait4"):  # Windows
        return Run(status=child.wait(), wall_s=time.perf_counter() - start, peak_mb=None)
    _, status, usage = os.wait4(child.pid, 0)
    wall_s = time.perf_counter() - start
    child.returncode = os.waitstatus_to_exitcode(status)
    bytes_a_unit = 1 if sys.platform == "darwin" else 1024
    return Run(status=child.returncode, wall_s=wall_s, peak_mb=usage.ru_maxrss * bytes_a_unit / 1e6)


def main_job(program: str, *, cold: bool) -> Run:
    """Run the main job into a folder that goes away; cold: without any compiled code."""
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ)
        if cold:
            environment["NUMBA_CACHE_DIR"] = str(Path(folder) / "cache")
        return run([program, *_MAIN_JOB, "--output", str(Path(folder) / "report")], environment)


def print_line(name: str, runs: Sequence[Run]) -> None:
    """Print the medians of some runs."""
    wall = statistics.median(r.wall_s for r in runs)
    peaks = [r.peak_mb for r in runs if r.peak_mb is not None]
    memory = f", {statistics.median(peaks):4.0f} MB" if peaks else ""
    statuses = ", ".join(str(status) for status in sorted({r.status for r in runs}))
    print(f"  {name:6} {wall:6.2f} s{memory}, exit status {statuses}, median of {len(runs)}")


def program_path() -> str | None:
    """Path of the command that belongs to this Python, else of the one on the search path."""
    return shutil.which(_COMMAND, path=str(Path(sys.executable).parent)) or shutil.which(_COMMAND)


def measure(program: str, runs: int, cold_runs: int) -> int:
    """Measure and print; return 0, or 1 when the main job did not run to its verdicts."""
    main_job(program, cold=False)  # leaves bytecode and compiled code behind
    jobs = {
        "warm": [main_job(program, cold=False) for _ in range(runs)],
        "cold": [main_job(program, cold=True) for _ in range(cold_runs)],
        "--help": [run([program, "--help"], os.environ) for _ in range(runs)],
    }
    print(f"{_COMMAND} {' '.join(_MAIN_JOB)}, wall time and peak memory:")
    for name, measured in jobs.items():
        print_line(name, measured)
    return 0 if all(r.status in _EVALUATED for measured in jobs.values() for r in measured) else 1


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the benchmark; return its exit status."""
    parser = argparse.ArgumentParser(
        description=(__doc__ or "").strip(),
        epilog="example: python benchmarks/main_command.py --runs 9 --cold-runs 1",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--runs", type=int, default=5, help="warm runs, and runs of --help (default 5)")
    parser.add_argument("--cold-runs", type=int, default=3, help="runs that compile anew (default 3)")
    chosen = parser.parse_args(arguments)
    if min(chosen.runs, chosen.cold_runs) < 1:
        parser.error("--runs and --cold-runs must be at least 1")
    program = program_path()
    if program is None or run([program, "--help"], os.environ).status != 0:
        print(f"{_COMMAND} is missing or does not start: the main command is left out")
        return 0
    return measure(program, chosen.runs, chosen.cold_runs)


if __name__ == "__main__":
    sys.exit(main())
