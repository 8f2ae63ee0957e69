"""What tests have made of records, by name: ``Named("makings:length")``."""

import os
import signal
import sys
from contextlib import suppress
from pathlib import Path

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.results import TestResult

SEEN: list[TestResult] = []
"""Results that `seen` was given, in order."""


def length(evidence: Evidence, result: TestResult, *, unit_s: float = 1.0) -> tuple[str, float]:
    """Id of the test and how long its record is."""
    return result.id, (evidence.waveforms.end_s - evidence.waveforms.t0_s) / unit_s


def seen(_evidence: Evidence, result: TestResult) -> int:
    """How many were seen before."""
    SEEN.append(result)
    return len(SEEN) - 1


def killed(evidence: Evidence, result: TestResult, *, tests: dict[str, str]) -> int:
    """Kill the process that makes it of some tests, of one with a file once, which is there then; else give its id."""
    del evidence
    if result.id in tests and not ((mark := tests[result.id]) and Path(mark).exists()):
        if mark:
            Path(mark).touch()
        sys.stderr.write(f"{result.id} is too much\n")
        sys.stderr.flush()
        os.kill(os.getpid(), signal.SIGKILL)
    return os.getpid()


def stopped(evidence: Evidence, result: TestResult, *, tests: list[str]) -> None:
    """Stop the process that makes it of some tests, as nobody does who is to have it go on."""
    del evidence
    if result.id in tests:
        os.kill(os.getpid(), signal.SIGSTOP)


def babbling(evidence: Evidence, result: TestResult, *, tests: list[str]) -> None:
    """Write into all pipes of this process what nobody expects there, as another program of its user can."""
    del evidence
    for file in Path("/proc/self/fd").iterdir() if result.id in tests else ():
        with suppress(OSError):
            if "pipe" in os.readlink(file):  # noqa: PTH115 - a pipe is no path
                os.write(int(file.name), b"what nobody has asked for\n" * 9)


def failing(evidence: Evidence, result: TestResult) -> None:
    """Fail as a bug does."""
    raise ZeroDivisionError(f"{result.id} of {evidence.waveforms.end_s:g} s")
