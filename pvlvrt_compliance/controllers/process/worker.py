"""What runs in the process of a user's controller: a server that does jobs, and the jobs."""

import json
import mmap
import os
import pickle
import sys
import tempfile
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

import numpy as np

from pvlvrt_compliance.controllers.description import Value
from pvlvrt_compliance.controllers.door import Door, described
from pvlvrt_compliance.controllers.doors import door_to
from pvlvrt_compliance.controllers.process import command, family
from pvlvrt_compliance.controllers.process.child import own_pipes
from pvlvrt_compliance.controllers.process.isolation import ANSWER, JOB, PROGRESS, RECORD, SAID
from pvlvrt_compliance.errors import PvlvrtError, SimulationError
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.recorder import RecordingPlan


@dataclass(frozen=True)
class DescribeJob:
    """Ask a controller for its description."""

    spec: str
    given: Mapping[str, Value] = field(default_factory=dict)
    mapping: str | None = None  # file
    beside: str = field(default_factory=os.getcwd)  # folder that relative names in ``spec`` start from


@dataclass(frozen=True)
class RunJob(DescribeJob):
    """Run a controller through a scenario."""

    scenario: Scenario = field(kw_only=True)
    parameters: Parameters = field(kw_only=True)
    plan: RecordingPlan = field(kw_only=True)
    digest: str = field(kw_only=True)  # of the controller that was described
    after_trip: bool = field(default=True, kw_only=True)  # whether it is called after a trip, too


def main() -> None:
    """Serve: a line in, the folder of a job; lines out, `ready`, then `started PID` and `ended STATUS` for each."""
    told, answered = own_pipes()
    jobs = os.fdopen(told, encoding="utf-8", errors="surrogateescape")
    answers = os.fdopen(answered, "w", encoding="utf-8")
    command.become_the_server()
    from pvlvrt_compliance.controllers.run import warm_up

    warm_up()
    _say(answers, "ready")
    while line := jobs.readline():
        folder = Path(line.rstrip("\n"))
        if family.FORKS:
            _fork(folder, jobs, answers)
        else:
            _say(answers, f"started {os.getpid()}")
            _do(folder)
            return


def _say(answers: IO[str], line: str) -> None:
    print(line, file=answers, flush=True)


def _fork(folder: Path, jobs: IO[str], answers: IO[str]) -> None:
    """Do a job in a copy of this process, which ends with it; and with the last reader of the answers."""

    def work() -> None:
        os.close(jobs.fileno())
        os.close(answers.fileno())
        _do(folder)

    # The other side sends no job before it has heard of the last: what ends is the other side.
    status = family.in_a_copy(work, lambda pid: _say(answers, f"started {pid}"), jobs.fileno())
    with suppress(BrokenPipeError):  # it has gone
        _say(answers, f"ended {status}")


def _do(folder: Path) -> None:
    said = os.open(folder / SAID, os.O_WRONLY | os.O_APPEND)
    os.dup2(said, 1)
    os.dup2(said, 2)
    job = pickle.loads((folder / JOB).read_bytes())
    os.chdir(job.beside)
    tempfile.tempdir = str(folder)  # removed with the job, however it ends
    try:
        answer = _answer(job, folder)
    except PvlvrtError as error:
        answer = {"error": str(error)}
    sys.stdout.flush()
    sys.stderr.flush()
    unfinished = folder / f"{ANSWER}.part"
    unfinished.write_text(json.dumps(answer), "utf-8")
    unfinished.rename(folder / ANSWER)


def _answer(job: DescribeJob, folder: Path) -> dict[str, Any]:
    door = door_to(job.spec, job.given, job.mapping)
    try:
        return _use(door, job, folder)
    finally:
        door.close()


def _use(door: Door, job: DescribeJob, folder: Path) -> dict[str, Any]:
    if not isinstance(job, RunJob):
        return {"description": described(door).to_json()}
    from pvlvrt_compliance.controllers.run import run_through

    if door.describe().digest != job.digest:
        raise SimulationError("the controller's file has changed since the first test; its verdicts would be mixed")
    with (folder / PROGRESS).open("r+b") as file:
        progress: Any = np.frombuffer(mmap.mmap(file.fileno(), 0), dtype=np.float64)
    record = run_through(door, job.scenario, job.parameters, job.plan, progress, after_trip=job.after_trip)
    try:
        np.save(folder / RECORD, record.samples)
    except OSError as error:
        (folder / RECORD).unlink()  # room for the answer
        raise SimulationError(f"{folder / RECORD} cannot be written: {error.strerror or error}") from None
    return {"channels": record.channels, "notes": record.notes, "tripped_at_s": record.tripped_at_s}
