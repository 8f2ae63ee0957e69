"""What runs on a worker of a scheduler: functions that tasks call, by their names."""

import threading
import traceback
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.results.files import WAVEFORMS
from pvlvrt_compliance.study.executors.cluster.identity import differences, identity
from pvlvrt_compliance.study.executors.cluster.luggage import Parcel, digest_of
from pvlvrt_compliance.study.executors.cluster.unpacking import RefusedError, Unpacked
from pvlvrt_compliance.study.executors.executor import Finished
from pvlvrt_compliance.study.executors.here import run_alone

_MOST_JOBS = 4  # that a worker has at a time: of a client that was killed it never hears again
_QUICK = 1  # level of compression: records shrink to half, in less time than a network takes


class Ran(NamedTuple):
    """What a unit gives."""

    finished: tuple[Finished, ...] = ()  # with their files compressed
    ended: bool = False  # whether the run ends with it
    failed: str = ""  # why it could not be run; empty: it was
    is_unknown: bool = False  # whether the process has no such job: another than the one that was given it


_jobs: dict[str, Unpacked] = {}  # by the id of the run, the latest last
_busy = threading.RLock()  # one test at a time: processes share a machine's cores, threads only one interpreter


def receive(run: str, parcel: Parcel) -> str:
    """Take a job, if this process is such that its results are those of the one that asks.

    Returns
    -------
    str
        Why it is not taken; empty where it is.
    """
    if said := differences(parcel.needed, identity(parcel.kinds)):
        return said
    if digest_of(parcel.content) != parcel.digest:
        return "the job has not arrived as it was sent"
    with _busy:
        for old in (run, *list(_jobs)[: 1 - _MOST_JOBS]):
            forget(old)
        try:
            _jobs[run] = Unpacked(parcel.content)
        except RefusedError as refusal:
            return str(refusal)
    return ""


def run_unit(run: str, number: int) -> Ran:
    """Run a unit of a job that was received."""
    with _busy:
        job = _jobs.get(run)
        if job is None:
            return Ran(is_unknown=True)
        try:
            return _ran(job, number)
        except Exception as error:  # as words: not every error can be sent
            return Ran(failed="".join(traceback.format_exception_only(error)).strip())


def forget(run: str) -> None:
    """Remove what is here of a job."""
    with _busy:
        job = _jobs.pop(run, None)
        if job is not None:
            job.close()


def unpressed(files: Mapping[str, bytes]) -> dict[str, bytes]:
    """Files as they were before they were sent."""
    return {name: zlib.decompress(content) for name, content in files.items()}


def _ran(job: Unpacked, number: int) -> Ran:
    (job.staging / WAVEFORMS).mkdir(parents=True, exist_ok=True)
    running = run_alone(job.work, job.units, number, job.controller, lambda _: None, job.simulator)
    finished: list[Finished] = []
    while True:
        try:
            one = next(running)
        except StopIteration as end:
            return Ran(tuple(finished), bool(end.value))
        finished.append(one._replace(files=dict(_taken(job.staging))))


def _taken(staging: Path) -> Iterator[tuple[str, bytes]]:
    """Records that were written since the last time, by their names in the output folder; they are not kept here."""
    for file in sorted((staging / WAVEFORMS).iterdir()):
        yield f"{WAVEFORMS}/{file.name}", zlib.compress(file.read_bytes(), _QUICK)
        file.unlink()
