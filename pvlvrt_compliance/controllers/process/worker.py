"""What runs in the process of a user's controller: a server that does jobs, and the jobs."""

import io
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
from numpy.typing import NDArray

from pvlvrt_compliance.controllers.description import Value
from pvlvrt_compliance.controllers.door import Door, described
from pvlvrt_compliance.controllers.doors import door_to
from pvlvrt_compliance.controllers.limits import Limits, hold_to
from pvlvrt_compliance.controllers.process import command, family
from pvlvrt_compliance.controllers.process.answer import ANSWER, RECORD, write_answer
from pvlvrt_compliance.controllers.process.child import own_pipes
from pvlvrt_compliance.controllers.process.isolation import JOB, PROGRESS, SAID
from pvlvrt_compliance.controllers.process.lines import say
from pvlvrt_compliance.controllers.process.watch import Watch, fence, open_fence
from pvlvrt_compliance.errors import PvlvrtError, SimulationError
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.recorder import RecordingPlan

OWN_FILES = frozenset({JOB, SAID, PROGRESS, ANSWER, f"{ANSWER}.part", RECORD})
"""Files in the folder of a job that are not its controller's."""

_PATIENCE_S = 5.0  # with what a job has left behind


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
    """Serve: a line in, a job, its folder and its limits; lines out (`lines`), what becomes of it.

    Where there are copies, whatever a job leaves behind ends with it: this process is the parent of its orphans.
    """
    told, answered = own_pipes()
    jobs, answers = os.fdopen(told, "rb"), os.fdopen(answered, "w", encoding="utf-8")
    command.become_the_server()
    family.adopt_orphans()
    for stream in (sys.stdout, sys.stderr):  # read as UTF-8, whatever the terminal of the user writes
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    from pvlvrt_compliance.controllers.run import warm_up

    warm_up()
    say(answers, "ready")
    while line := jobs.readline():
        try:
            told_job = json.loads(line)
            job, folder, limits = told_job["job"], Path(told_job["folder"]), Limits(**told_job["limits"])
        except (ValueError, TypeError, KeyError):  # whoever has written that is not the command
            return
        if family.FORKS:
            _fork(job, folder, limits, jobs, answers)
        else:
            say(answers, "started", job, pid=os.getpid())
            _do(job, folder, limits)
            return


def _fork(job: str, folder: Path, limits: Limits, jobs: IO[bytes], answers: IO[str]) -> None:
    """Do a job in a copy of this process, which ends with it; and with the last reader of the answers."""

    def work() -> None:
        os.close(jobs.fileno())
        os.close(answers.fileno())
        _do(job, folder, limits)

    def begun(pid: int) -> None:
        say(answers, "started", job, pid=pid)

    watch = Watch(limits, folder / SAID, folder, OWN_FILES)
    try:
        # The other side sends no job before it has heard of the last: what ends is the other side.
        end = family.in_a_copy(work, begun, jobs.fileno(), watch.look)
        why = watch.at_end(end)
    finally:
        watch.close()
        family.end_descendants(patience_s=_PATIENCE_S)
    with suppress(BrokenPipeError):  # it has gone
        say(answers, "ended", job, status=end.status, why=why)


def _do(job_id: str, folder: Path, limits: Limits) -> None:
    said = os.open(folder / SAID, os.O_WRONLY | os.O_APPEND)
    os.dup2(said, 1)
    os.dup2(said, 2)
    job, process = pickle.loads((folder / JOB).read_bytes()), os.getpid()
    os.chdir(job.beside)
    tempfile.tempdir = str(folder)  # removed with the job, however it ends
    os.environ.update(dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(folder)))  # of programs, too
    hold_to(limits)
    fence(limits)
    samples = None
    try:
        answer, samples = _answer(job, folder)
    except PvlvrtError as error:
        answer = {"error": str(error)}
    if os.getpid() != process:  # the controller has made a copy of this process, which has come here, too
        os._exit(0)
    sys.stdout.flush()
    sys.stderr.flush()
    open_fence()
    try:
        write_answer(folder, job_id, answer, samples)
    except FileNotFoundError:  # its folder has been removed, which is seen there
        os._exit(1)


def _answer(job: DescribeJob, folder: Path) -> tuple[dict[str, Any], NDArray[np.float64] | None]:
    door = door_to(job.spec, job.given, job.mapping)
    try:
        return _use(door, job, folder)
    finally:
        door.close()


def _use(door: Door, job: DescribeJob, folder: Path) -> tuple[dict[str, Any], NDArray[np.float64] | None]:
    if not isinstance(job, RunJob):
        return {"description": described(door).to_json()}, None
    from pvlvrt_compliance.controllers.run import run_through

    if door.describe().digest != job.digest:
        raise SimulationError("the controller's file has changed since the first test; its verdicts would be mixed")
    with (folder / PROGRESS).open("r+b") as file:
        progress: Any = np.frombuffer(mmap.mmap(file.fileno(), 0), dtype=np.float64)
    record = run_through(door, job.scenario, job.parameters, job.plan, progress, after_trip=job.after_trip)
    return {"channels": record.channels, "notes": record.notes, "tripped_at_s": record.tripped_at_s}, record.samples
