"""What workers make of records: ``Named("cluster_makings:dies_once")``; they have this folder on their path."""

import os
import signal
from pathlib import Path

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.results import TestResult
from waiting import wait_until


def dies(_evidence: Evidence, result: TestResult, *, at: str, marks: str, times: int) -> str:
    """Kill the process that judges the test ``at``, so many times in all; else the id of the test.

    Each death leaves a file in the folder ``marks``.
    """
    if result.id == at and len(list(Path(marks).iterdir())) < times:
        Path(marks, str(os.getpid())).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return result.id


def waits(_evidence: Evidence, result: TestResult, *, at: str) -> str:
    """Wait at the test ``at`` until the process is killed, as its cluster is at the end of a test."""
    if result.id == at:
        wait_until(lambda: False, "the end")
    return result.id
