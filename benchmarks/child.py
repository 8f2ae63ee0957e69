"""Runs a command to its end: its status, its time, its peak memory.

Imports nothing but the standard library: on Linux a child's peak memory is at least that of the process starting it.
"""

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

COMMAND = "pvlvrt-check"
EVALUATED = (0, 1)
"""Exit statuses of a job that ran to its verdicts."""


class Run(NamedTuple):
    """One run of a command."""

    status: int  # exit status
    wall_s: float
    processor_s: float | None  # of it and of those that it has waited for; None where the system does not tell
    peak_mb: float | None  # peak resident memory


def run(command: Sequence[str], environment: Mapping[str, str] | None = None) -> Run:
    """Run a command to its end and throw its output away."""
    start = time.perf_counter()
    child = subprocess.Popen(
        command, env=dict(environment or os.environ), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    if not hasattr(os, "wait4"):  # Windows
        return Run(status=child.wait(), wall_s=time.perf_counter() - start, processor_s=None, peak_mb=None)
    _, status, usage = os.wait4(child.pid, 0)
    wall_s = time.perf_counter() - start
    child.returncode = os.waitstatus_to_exitcode(status)
    bytes_a_unit = 1 if sys.platform == "darwin" else 1024
    return Run(
        status=child.returncode,
        wall_s=wall_s,
        processor_s=usage.ru_utime + usage.ru_stime,
        peak_mb=usage.ru_maxrss * bytes_a_unit / 1e6,
    )


def evaluated(command: Sequence[str], environment: Mapping[str, str] | None = None) -> Run:
    """Run a command that must come to its verdicts.

    Raises
    ------
    RuntimeError
        When it does not: its time says nothing then.
    """
    ended = run(command, environment)
    if ended.status not in EVALUATED:
        raise RuntimeError(f"{' '.join(command)} ended with status {ended.status}")
    return ended


def program_path() -> str:
    """Path of the command that belongs to this Python, else of the one on the search path.

    Raises
    ------
    RuntimeError
        When there is none, or it does not start.
    """
    program = shutil.which(COMMAND, path=str(Path(sys.executable).parent)) or shutil.which(COMMAND)
    if program is None or run([program, "--version"]).status != 0:
        raise RuntimeError(f"{COMMAND} is missing or does not start")
    return program
