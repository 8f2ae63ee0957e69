"""A run that is ended at any moment, or whose disk is full: the folder holds an old run, a new one, or no verdict."""

import contextlib
import json
import os
import re
import resource
import signal
import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from random import Random
from typing import NamedTuple

from lxml import etree

from tests.hostile import seeds, soundness
from tests.hostile.driver import ROOT
from tests.hostile.folder import clear
from waiting import PATIENCE_S

SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
_STATUSES = {signal.SIGKILL: {-9}, signal.SIGTERM: {143, -15}, signal.SIGINT: {130, -2}}
_RUN = ("--profile", "ours.toml", "--set", "simulation.settling_s=0.2", "--output", "out")
_ID = "run_id"
_MARK = "PVLVRT_HOSTILE_SWEEP"


class Moment(NamedTuple):
    """When a run is ended, and by which signal; or how large its files may become."""

    name: str
    jobs: str
    number: signal.Signals | None = None
    after_s: float = 0.0
    largest_bytes: int = -1


def moments(seed: int, kills: int, full: int, length_s: float) -> Iterator[Moment]:
    """Moments of a run of some length (s), and sizes up to that of the largest file."""
    rng = Random(f"sweep:{seed}")
    for k in range(kills):
        number, at_s = SIGNALS[k % len(SIGNALS)], rng.uniform(0.2, 1.05) * length_s
        yield Moment(f"{number.name} after {at_s:.2f} s", rng.choice("12"), number, at_s)
    for _ in range(full):
        size = round(rng.choice((rng.uniform(0, 2.4e6), 10 ** rng.uniform(1, 6))))
        yield Moment(f"files of at most {size} bytes", rng.choice("12"), largest_bytes=size)


class Surroundings:
    """Environment of runs, by which their processes are known, and a temporary folder that is watched."""

    def __init__(self, place: Path) -> None:
        self.temporary = place / "tmp"
        clear(self.temporary)
        found = {name: value for name, value in os.environ.items() if not name.startswith(("PVLVRT_", "GITHUB_"))}
        path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
        self.mark = f"{_MARK}={os.getpid()}-{place.name}"
        self.environment = found | {"PYTHONPATH": path, "TMPDIR": str(self.temporary)} | dict([self.mark.split("=")])

    def left(self) -> Iterator[str]:
        """Processes that are left; they are ended."""
        for folder in Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                if self.mark.encode() in (folder / "environ").read_bytes():
                    yield f"process {folder.name} is left: {(folder / 'cmdline').read_bytes()[:100]!r}"
                    os.kill(int(folder.name), signal.SIGKILL)

    def remains(self) -> Iterator[str]:
        """Temporary files that are left; they are removed."""
        yield from (f"{path.name} is left in the temporary folder" for path in self.temporary.iterdir())
        clear(self.temporary)


class Sweep:
    """Runs in a folder of their own, one after the other."""

    def __init__(self, place: Path) -> None:
        self.files, self.around = place / "files", Surroundings(place)
        clear(self.files)
        (self.files / "ours.toml").write_bytes(seeds.made()["ours.toml"].content)

    def start(self, jobs: str, largest_bytes: int = -1) -> subprocess.Popen[bytes]:
        """Begin a run."""
        words = [sys.executable, "-m", "pvlvrt_compliance", *_RUN, "--isolated", "--jobs", jobs]
        limit = partial(resource.setrlimit, resource.RLIMIT_FSIZE, (largest_bytes, largest_bytes))
        return subprocess.Popen(
            words,
            cwd=self.files,
            env=self.around.environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            preexec_fn=limit if largest_bytes >= 0 else None,  # noqa: PLW1509 - nothing else runs here
        )

    def wrong(self, moment: Moment) -> list[str]:
        """Run to a moment; what does not hold then, and after a run that is left alone."""
        process = self.start(moment.jobs, moment.largest_bytes)
        if moment.number is not None:
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(moment.after_s)
            process.send_signal(moment.number)
        out, err = process.communicate(timeout=PATIENCE_S)
        found = [*self._ended(moment, process.returncode, out + err), *self.around.left(), *self._folder()]
        if moment.number != signal.SIGKILL:  # which leaves nobody to clean up
            found += [*self._unfinished(), *self.around.remains()]
        if moment.number == signal.SIGKILL:
            again = self.start(moment.jobs)
            again.communicate(timeout=PATIENCE_S)
            if again.returncode not in (0, 1, 3):
                found.append(f"the run after it ends with {again.returncode}")
            found += [f"after another run, {said}" for said in (*self._folder(), *self._unfinished())]
            clear(self.around.temporary)
        return [f"{moment.name}, --jobs {moment.jobs}: {said}" for said in found]

    def _ended(self, moment: Moment, status: int, said: bytes) -> Iterator[str]:
        expected = {0, 1, 3} if moment.number is None else {0, 1, 3} | _STATUSES[moment.number]
        if moment.number is None and status not in {2, *expected}:
            yield f"status {status}"
        elif moment.number is not None and status not in expected:
            yield f"status {status}: {said[-300:]!r}"
        # Before the command is the command, Python has not even read it.
        if b"Traceback" in said and status >= 0 and not re.search(rb"KeyboardInterrupt\s*$", said):
            yield f"a traceback: {said[-300:]!r}"

    def _folder(self) -> Iterator[str]:
        """What is wrong with the files of verdicts: each is whole, and all are of one run."""
        out = self.files / "out"
        ids = set()
        for name in ("results.json", "junit.xml", "report.html"):
            if (out / name).exists():
                said = list(soundness.unsound(out / name))
                yield from said
                ids.add("" if said else _id_in(out / name))
        if len(ids) > 1:
            yield f"files of several runs beside each other: {ids}"

    def _unfinished(self) -> Iterator[str]:
        for path in self.files.rglob(".*"):
            yield f"{path.relative_to(self.files)} is left"


def _id_in(file: Path) -> str:
    """The run that a file is of."""
    if file.suffix == ".json":
        return str(json.loads(file.read_bytes())[_ID])
    if file.suffix == ".xml":
        found = etree.parse(file).xpath(f"//property[@name='{_ID}']/@value")
        return str(found[0]) if found else "none"
    match = re.search(r'run-id" content="(\w+)"', file.read_text("utf-8"))
    return match.group(1) if match else "none"
