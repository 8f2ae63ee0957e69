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
from typing import IO, TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.controllers.description import Value
from pvlvrt_compliance.controllers.door import Door, described
from pvlvrt_compliance.controllers.doors import door_to
from pvlvrt_compliance.controllers.faults import Faults
from pvlvrt_compliance.controllers.limits import Limits, hold_to
from pvlvrt_compliance.controllers.process import command, family
from pvlvrt_compliance.controllers.process.answer import ANSWER, RECORD, STATE, write_answer
from pvlvrt_compliance.controllers.process.child import own_pipes
from pvlvrt_compliance.controllers.process.isolation import JOB, PROGRESS, SAID
from pvlvrt_compliance.controllers.process.lines import say
from pvlvrt_compliance.controllers.process.watch import Watch, fence, open_fence
from pvlvrt_compliance.controllers.replay.feed import Feed
from pvlvrt_compliance.controllers.trial import try_out
from pvlvrt_compliance.errors import PvlvrtError, SimulationError
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.recorder import RecordingPlan
from pvlvrt_compliance.units import Nominal

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.run import ForeignRecord

OWN_FILES = frozenset({JOB, SAID, PROGRESS, ANSWER, f"{ANSWER}.part", RECORD, STATE})
"""Files in the folder of a job that are not its controller's."""

_PATIENCE_S = 5.0  # with what a job has left behind

_Given = tuple[dict[str, Any], NDArray[np.float64] | None, bytes | None]  # head of an answer, record, and state


@dataclass(frozen=True)
class DescribeJob:
    """Ask a controller for its description."""

    spec: str
    given: Mapping[str, Value] = field(default_factory=dict)
    mapping: str | None = None  # file
    beside: str = field(default_factory=os.getcwd)  # folder that relative names in ``spec`` start from
    allow_out_of_range: bool = False  # of the ranges that the controller states for its parameters
    bare: bool = field(default=False, kw_only=True)  # see `Door.bare`


@dataclass(frozen=True)
class LookJob(DescribeJob):
    """See what can be known of a controller, whatever is wrong with it."""


@dataclass(frozen=True)
class TrialJob(DescribeJob):
    """Open a controller as a run would, and see what it says."""

    parameters: Parameters = field(kw_only=True)


@dataclass(frozen=True)
class RunJob(DescribeJob):
    """Run a controller through a scenario."""

    scenario: Scenario = field(kw_only=True)
    parameters: Parameters = field(kw_only=True)
    plan: RecordingPlan = field(kw_only=True)
    digest: str = field(kw_only=True)  # of the controller that was described
    after_trip: bool = field(default=True, kw_only=True)  # whether it is called after a trip, too
    since: bytes | None = field(default=None, kw_only=True)  # where an earlier run was at its end
    keeps: bool = field(default=False, kw_only=True)  # whether it is kept where this one is then


@dataclass(frozen=True)
class ReplayJob(DescribeJob):
    """Feed numbers to a controller, without a plant."""

    feed: Feed = field(kw_only=True)
    nominal: Nominal = field(kw_only=True)
    digest: str = field(kw_only=True)  # of the controller that was described
    bare: bool = field(default=True, kw_only=True)


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
    samples = state = None
    try:
        answer, samples, state = _answer(job, folder)
    except PvlvrtError as error:
        answer = {"error": str(error)}
    if os.getpid() != process:  # the controller has made a copy of this process, which has come here, too
        os._exit(0)
    sys.stdout.flush()
    sys.stderr.flush()
    open_fence()
    try:
        write_answer(folder, job_id, answer, samples, state)
    except FileNotFoundError:  # its folder has been removed, which is seen there
        os._exit(1)


def record_of(door: Door, job: RunJob, progress: NDArray[np.float64]) -> "ForeignRecord":
    """Run a job by its door, in this process; ``progress`` as of `run_through`.

    Raises
    ------
    SimulationError
        When the controller is another than was described, fails, or gives what cannot be used.
    UsageError
        When it cannot be opened.
    """
    from pvlvrt_compliance.controllers.run import run_through

    _refuse_another(door, job.digest)
    how: dict[str, Any] = {"after_trip": job.after_trip, "since": job.since, "keeps": job.keeps}
    return run_through(door, job.scenario, job.parameters, job.plan, progress, **how)


def _refuse_another(door: Door, digest: str) -> None:
    if door.describe().digest != digest:
        raise SimulationError("the controller's file has changed since the first test; its verdicts would be mixed")


def _answer(job: DescribeJob, folder: Path) -> _Given:
    if isinstance(job, (LookJob, TrialJob)):
        return _looked_at(job), None, None
    door = door_to(job.spec, job.given, job.mapping, allow_out_of_range=job.allow_out_of_range)
    door.bare = job.bare
    try:
        return _use(door, job, folder)
    finally:
        door.close()


def _looked_at(job: LookJob | TrialJob) -> dict[str, Any]:
    """What is wrong with a controller, and what it says of itself all the same."""
    faults, description = Faults(kept=True), None
    with faults.told():
        door = door_to(job.spec, job.given, job.mapping, faults, allow_out_of_range=job.allow_out_of_range)
        try:
            if isinstance(job, TrialJob):
                try_out(door, job.parameters)
            else:
                description = described(door).to_json()
        finally:
            door.close()
    return {"faults": faults.texts, "description": description}


def _use(door: Door, job: DescribeJob, folder: Path) -> _Given:
    if not isinstance(job, RunJob | ReplayJob):
        return {"description": described(door).to_json()}, None, None
    with (folder / PROGRESS).open("r+b") as file:
        progress: Any = np.frombuffer(mmap.mmap(file.fileno(), 0), dtype=np.float64)
    if isinstance(job, ReplayJob):
        from pvlvrt_compliance.controllers.replay.through import replay_through

        _refuse_another(door, job.digest)
        given = replay_through(door, job.feed, job.nominal, progress)
        return {"channels": given.further, "notes": given.notes, "missing": given.missing}, given.samples, None
    record = record_of(door, job, progress)
    head = {"channels": record.channels, "notes": record.notes, "tripped_at_s": record.tripped_at_s}
    return head | {"stateless": record.stateless}, record.samples, record.state
