"""Has cases run by workers, looks after these, and tells what came."""

import contextlib
import json
import os
import pickle
import select
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.controllers.process.family import descendants
from tests.hostile.worker import CASE, ended, told

ROOT = Path(__file__).parents[2]
LOOK_S = 0.25
"""How often a worker is looked at (s)."""

PROCESSOR_S, SIMULATING_S = 10.0, 20.0
"""Processor time of a case (s): beyond it what only reads fails; what simulates is interrupted, which it must obey."""

STILL_LOOKS = 240
"""So many looks without any processor time are one too many: a minute."""

_AT_ONCE = 2000
_TICKS_A_SECOND = os.sysconf("SC_CLK_TCK")


class Outcome(NamedTuple):
    """What came of a case."""

    number: int
    kind: str
    status: int
    wrong: tuple[str, ...]
    arguments: tuple[str, ...]
    reached: bool = False
    peak: int = 0


def outcomes(seed: int, numbers: Sequence[int], place: Path, keep: Path) -> Iterator[Outcome]:
    """Run cases in their order; a worker that is lost is replaced by another."""
    left = list(numbers)
    while left:
        at_once = left[:_AT_ONCE]
        with _Worker(seed, at_once, place, keep) as worker:
            for outcome in worker.outcomes():
                left.remove(outcome.number)
                yield outcome
            assert len(left) < len(numbers), "a worker does not even begin"
            numbers = list(left)


class _Worker:
    """A process that runs cases."""

    def __init__(self, seed: int, numbers: Sequence[int], place: Path, keep: Path) -> None:
        place.mkdir(parents=True, exist_ok=True)
        self.seed, self.place, self.keep = seed, place, keep
        words = [
            sys.executable,
            "-m",
            "tests.hostile.worker",
            str(seed),
            str(place),
            str(keep),
            ",".join(map(str, numbers)),
        ]
        path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
        self.process = subprocess.Popen(
            words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, cwd=ROOT, env=os.environ | {"PYTHONPATH": path}
        )
        self.begun: int | None = None
        self.simulates = False
        self.interrupted = False

    def __enter__(self) -> "_Worker":
        return self

    def __exit__(self, *_: object) -> None:
        self._kill()
        self.process.stdout.close()

    def outcomes(self) -> Iterator[Outcome]:
        """What comes of its cases, until it ends."""
        rest = b""
        self._begin(None)
        while True:
            if not select.select([self.process.stdout], [], [], LOOK_S)[0]:
                if said := self._overdue():
                    yield self._lost(said)
                    return
                continue
            more = os.read(self.process.stdout.fileno(), 1 << 16)
            *lines, rest = (rest + more).split(b"\n")
            for line in map(json.loads, lines):
                if "begins" in line:
                    self._begin(line["begins"])
                    self.simulates = line["simulates"]
                else:
                    self.begun = None
                    wrong = [*line["wrong"], *([] if self.simulates or not self.interrupted else [_TOO_LONG])]
                    yield Outcome(
                        line["ends"], line["kind"], line["status"], tuple(wrong), tuple(line["arguments"]),
                        line["reached"], line["peak"],
                    )  # fmt: skip
            if not more:
                if self.begun is not None:
                    yield self._lost("")
                return

    def _begin(self, number: int | None) -> None:
        self.begun, self.interrupted, self.still, self.from_s = number, False, 0, self._processor_s()
        self.last_s = self.from_s

    def _processor_s(self) -> float:
        """Processor time of the worker and of all that it has started (s)."""
        found = 0
        for pid in [self.process.pid, *(child.pid for child in descendants(self.process.pid))]:
            with contextlib.suppress(OSError, IndexError):
                fields = Path(f"/proc/{pid}/stat").read_text("ascii", "replace").rpartition(")")[2].split()
                found += sum(map(int, fields[11:15]))
        return found / _TICKS_A_SECOND

    def _overdue(self) -> str:
        """Why a case is given up; one that simulates is asked to end first."""
        now_s = self._processor_s()
        self.still = self.still + 1 if now_s == self.last_s else 0
        self.last_s = now_s
        if self.still > STILL_LOOKS:
            return "stands still"
        spent_s = now_s - self.from_s
        if self.begun is None or spent_s < (SIMULATING_S if self.simulates else PROCESSOR_S):
            return ""
        if not self.interrupted:
            self.interrupted = True
            os.kill(self.process.pid, signal.SIGINT)
        return "does not end when it is interrupted" if spent_s > 2 * SIMULATING_S else ""

    def _lost(self, said: str) -> Outcome:
        """What is to be told of the case at which a worker has ended, or is ended here."""
        number = self.begun if self.begun is not None else -1
        self._kill()
        case = pickle.loads((self.place / CASE).read_bytes())
        keep = self.keep / f"{self.seed}-{number}"
        how = ended(self.process.returncode, self.place)
        found = told(case, how, self.place, keep)
        wrong = [*found["wrong"], *([said] if said else [])]
        if self.interrupted and not self.simulates:
            wrong.append(_TOO_LONG)
        return Outcome(number, case.kind, how.status, tuple(wrong), case.arguments, found["reached"])

    def _kill(self) -> None:
        if self.process.poll() is None:
            family = descendants(self.process.pid)
            for pid in [self.process.pid, *(child.pid for child in family)]:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
        self.process.wait()


_TOO_LONG = f"takes more than {PROCESSOR_S:g} s of processor time"
