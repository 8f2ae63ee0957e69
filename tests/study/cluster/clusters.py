"""A scheduler and workers in processes of their own, as somebody starts them by hand."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import pvlvrt_compliance
from waiting import wait_until

ROOT = Path(pvlvrt_compliance.__file__).parent.parent
TESTS = Path(__file__).parents[2]
SEEN_BY_WORKERS = (ROOT, TESTS / "support", Path(__file__).parent)


class Cluster:
    """A scheduler, and the workers that were started for it.

    Parameters
    ----------
    folder : Path
        For files that they write.
    options : sequence of str
        Of all commands.
    """

    def __init__(self, folder: Path, options: Sequence[str] = ()) -> None:
        self._folder = folder
        self._options = options
        self._file = folder / "scheduler.json"
        host = "--host", "tls://127.0.0.1" if options else "tcp://127.0.0.1"
        named = "--port", "0", "--scheduler-file", str(self._file)
        self.scheduler = self._started("scheduler", *host, *named, *options)
        self.workers: list[subprocess.Popen[bytes]] = []
        wait_until(self._is_up, "the scheduler")
        self.address = str(json.loads(self._file.read_text("utf-8"))["address"])

    def have(self, count: int, beside: Sequence[Path] = SEEN_BY_WORKERS) -> None:
        """Start workers until so many are alive, whose modules are found in these folders."""
        self.workers = [worker for worker in self.workers if worker.poll() is None]
        for _ in range(count - len(self.workers)):
            self.workers.append(self.worker(beside))

    def worker(self, beside: Sequence[Path]) -> "subprocess.Popen[bytes]":
        """Start a worker."""
        where = "--nthreads", "1", "--no-nanny", "--local-directory", str(self._folder)
        return self._started("worker", self.address, *where, *self._options, beside=beside)

    def end(self) -> None:
        """Kill all of them."""
        for process in (*self.workers, self.scheduler):
            process.kill()
        for process in (*self.workers, self.scheduler):
            process.wait()

    def _started(self, what: str, *arguments: str, beside: Sequence[Path] = ()) -> "subprocess.Popen[bytes]":
        # The environment of a worker is the user's own, but for where its modules are.
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(map(str, beside))}
        environment = {name: value for name, value in environment.items() if name != "SOURCE_DATE_EPOCH"}
        with (self._folder / f"{what}.log").open("ab") as log:
            return subprocess.Popen(
                [sys.executable, "-m", f"distributed.cli.dask_{what}", *arguments, "--no-dashboard"],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                env=environment,
                cwd=self._folder,
            )

    def _is_up(self) -> bool:
        assert self.scheduler.poll() is None, (self._folder / "scheduler.log").read_text("utf-8")
        return self._file.is_file() and self._file.stat().st_size > 0


@contextmanager
def cluster(folder: Path, options: Sequence[str] = ()) -> Iterator[Cluster]:
    """A cluster that is gone at the end."""
    found = Cluster(folder, options)
    try:
        yield found
    finally:
        found.end()
