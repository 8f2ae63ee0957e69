"""Controllers that do harm, run by the command: each costs its own test, and every other one stays in the report."""

import json
import os
import shlex
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from evil import Evil
from tests.hostile import seeds, soundness
from tests.hostile.damage import of_text
from tests.hostile.folder import clear
from tests.hostile.sweeps import Surroundings
from tests.hostile.trees import to_toml
from waiting import PATIENCE_S

WELL, DEEP = "T1", "T2"
"""Tests: a sag in which nothing is done, and the one of the deed."""

LONGEST_MESSAGE = 10_000
"""Characters, chosen: a page of a report."""


def profile() -> bytes:
    """A grid code with these two tests."""
    row = seeds.PROFILE["tests"][0] | {"before_s": 0.3, "after_s": 0.1}
    tests = [row | {"id": name, "sag": {"depth": depth}} for name, depth in ((WELL, 0.2), (DEEP, 0.7))]
    return of_text(to_toml(seeds.PROFILE | {"tests": tests})).content


class EvilSweep:
    """A folder in which one controller after the other is built and run."""

    def __init__(self, place: Path) -> None:
        self.place = place
        self.around = Surroundings(place)

    def wrong(self, name: str, evil: Evil, jobs: str = "1") -> list[str]:
        """What does not hold of a controller."""
        files = self.place / "files"
        clear(files)
        (own := files / "own").mkdir()
        (files / "ours.toml").write_bytes(profile())
        spec = evil.build(own)
        before = {path for path in files.rglob("*") if "__pycache__" not in path.parts}
        settings = [word for each in evil.settings for word in ("--set", each)]
        words = [
            "--profile",
            "ours.toml",
            "--isolated",
            "--controller",
            spec,
            "--jobs",
            jobs,
            "--output",
            "out",
            "--waveforms",
            "none",
            *settings,
        ]
        done = subprocess.run(
            [sys.executable, "-m", "pvlvrt_compliance", *words],
            cwd=files, env=self.around.environment, stdin=subprocess.DEVNULL, capture_output=True,
            timeout=PATIENCE_S, check=False,
        )  # fmt: skip
        said = (done.stdout + done.stderr).decode("utf-8", "replace")
        found = [*self._judged(evil, done.returncode, files / "out", said), *self._clean(files, before, said)]
        return [f"{name}: {each} ({shlex.join(words)})" for each in found]

    def _judged(self, evil: Evil, status: int, out: Path, said: str) -> Iterator[str]:
        if evil.at_opening:
            if status != 2 or evil.expected not in said:
                yield f"status {status}, not 2 with {evil.expected!r}: {said[-300:]!r}"
            return
        if status not in (0, 1, 3) or not (out / "results.json").exists():
            yield f"status {status}: {said[-500:]!r}"
            return
        yield from soundness.unsound(out)
        tests = {test["id"]: test for test in json.loads((out / "results.json").read_bytes())["tests"]}
        if set(tests) != {WELL, DEEP}:
            yield f"the report has {sorted(tests)}"
            return
        if tests[WELL]["status"] == "error":
            yield f"the other test is lost, too: {_message(tests[WELL])[:300]}"
        message = _message(tests[DEEP])
        if evil.expected and (tests[DEEP]["status"] != "error" or status != 3):
            yield f"no error: {tests[DEEP]['status']}, status {status}"
        if evil.expected not in message:
            yield f"without {evil.expected!r}: {message[:400]}"
        if len(message) > LONGEST_MESSAGE:
            yield f"a message of {len(message)} characters"

    def _clean(self, files: Path, before: set[Path], said: str) -> Iterator[str]:
        if "Traceback" in said and "pvlvrt_compliance/cli" in said:
            yield f"a traceback: {said[-500:]!r}"
        if (control := soundness.control_in(said)) is not None:
            yield f"says the control character {control!r}"
        if any(line.lstrip().startswith("::") for line in said.splitlines()):
            yield "commands the runner"
        allowed = {files / "out", files / "own" / "__pycache__"}
        for path in set(files.rglob("*")) - before:
            if not allowed & {path, *path.parents}:
                yield f"{path.relative_to(files)} was written"
        yield from self.around.left()
        yield from self.around.remains()


def _message(test: dict[str, Any]) -> str:
    return max((str(check.get("message")) for check in test["checks"]), key=len, default="")


def is_usable() -> bool:
    """Whether the system can hold a controller to its limits."""
    return sys.platform == "linux" and os.name == "posix"
