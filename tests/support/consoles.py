"""What a page has a reader type, and what it says that comes back."""

import io
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import chdir, redirect_stderr, redirect_stdout
from pathlib import Path
from typing import NamedTuple
from unittest import mock

from pvlvrt_compliance.cli.main import run
from waiting import PATIENCE_S

PROGRAM = "pvlvrt-check"
LEFT_OUT = "..."
DEBUG = "--debug"  # what is looked at is the process itself, to its end

# What a terminal or a CI service sets, and the command would rightly follow.
_SURROUNDINGS = (
    *("COLUMNS", "FORCE_COLOR", "NO_COLOR", "TTY_COMPATIBLE", "SOURCE_DATE_EPOCH"),
    *("GITHUB_ACTIONS", "GITHUB_STEP_SUMMARY"),
)
_SHELLS = {"sh", "bash", "shell"}
_BLOCK = re.compile(r"^( *)```(\w+)\n(.*?)^\1```$", re.MULTILINE | re.DOTALL)
_SHIM = '#!/bin/sh\nexec "{python}" -m pvlvrt_compliance "$@"\n'


class Step(NamedTuple):
    """One command of a page."""

    command: str
    output: str | None  # as the page shows it; none: the page does not say

    def is_met_by(self, said: str) -> bool:
        """Whether this is what the page shows; there ``...`` stands for any lines, or for any part of a line."""
        if self.output is None:
            return True
        pattern = "".join(map(_pattern, self.output.splitlines()))
        lines = "".join(f"{line.rstrip()}\n" for line in said.splitlines())
        return re.fullmatch(pattern, lines) is not None


class Ended(NamedTuple):
    """How a command ended."""

    status: int
    said: str  # on either stream


def steps(text: str) -> Iterator[Step]:
    """Commands of a page, in order.

    In a block ``sh`` each line is one; in a block ``console`` those behind ``$ ``, and what follows is what they print.
    """
    for _, language, block in _BLOCK.findall(text):
        if language in _SHELLS:
            yield from (Step(line, None) for line in _joined(block).splitlines() if line and not line.startswith("#"))
        elif language == "console":
            for part in re.split(r"^\$ ", _joined(block), flags=re.MULTILINE)[1:]:
                command, _, output = part.partition("\n")
                yield Step(command, output)


def _pattern(line: str) -> str:
    if line.strip() == LEFT_OUT:
        return r"(?:.*\n)*?"
    return ".*".join(re.escape(part) for part in line.rstrip().split(LEFT_OUT)) + r"\n"


def _joined(block: str) -> str:
    """A block with the lines joined that end with a backslash."""
    return block.replace("\\\n", "")


class Shell:
    """Runs the commands of one page, one after the other, in one folder.

    The command itself runs in this process, which saves its start; whatever else is asked for, in a shell of its own.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        own = folder.parent / f"{folder.name}-programs"
        own.mkdir()
        self._programs = (str(own), str(Path(sys.executable).parent))
        shim = own / PROGRAM
        shim.write_text(_SHIM.format(python=sys.executable), "utf-8")
        shim.chmod(0o755)
        self._last = 0

    def do(self, command: str) -> Ended:
        """Do one line; of commands joined by ``&&`` the first that does not end with 0 is the last."""
        if command == "echo $?":
            return Ended(0, f"{self._last}\n")
        ended = Ended(0, "")
        for part in [command] if "|" in command else command.split(" && "):
            ended = self._one(part)
            if ended.status:
                break
        self._last = ended.status
        return ended

    def _one(self, command: str) -> Ended:
        words = shlex.split(command, comments=True)
        if words[0] == "cd":
            self.folder = self.folder / words[1]
            assert self.folder.is_dir(), command
            return Ended(0, "")
        if words[0] != PROGRAM or "|" in command or DEBUG in words:
            return self._in_a_shell(command)
        if ">" not in words:
            return self._in_this_process(words[1:])
        ended = self._in_this_process(words[1 : words.index(">")])
        (self.folder / words[-1]).write_text(ended.said, "utf-8")
        return Ended(ended.status, "")

    def _in_this_process(self, arguments: list[str]) -> Ended:
        said = io.StringIO()
        with (
            mock.patch.dict(os.environ, surroundings({}), clear=True),
            chdir(self.folder),
            redirect_stdout(said),
            redirect_stderr(said),
        ):
            status = run(arguments)
        return Ended(status, said.getvalue())

    def _in_a_shell(self, command: str) -> Ended:
        done = subprocess.run(
            ["sh", "-c", command],
            cwd=self.folder,
            env=surroundings({"PATH": os.pathsep.join([*self._programs, os.environ["PATH"]])}),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=PATIENCE_S,
            check=False,
        )
        return Ended(done.returncode, done.stdout.decode("utf-8"))


def surroundings(more: Mapping[str, str]) -> dict[str, str]:
    """Environment of a command that is not run from a terminal."""
    return {name: value for name, value in os.environ.items() if name not in _SURROUNDINGS} | dict(more)
