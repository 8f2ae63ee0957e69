"""The command, run inside this process or as a program of its own, and what it wrote; what a comparison wrote."""

import io
import json
import math
import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any, NamedTuple
from unittest import mock

import lxml.html
import pytest

from consoles import surroundings
from profile_files import HEAD
from pvlvrt_compliance import Comparison
from pvlvrt_compliance.cli.main import run
from waiting import PATIENCE_S

PROGRAM = (sys.executable, "-m", "pvlvrt_compliance.cli.main")


class Ended(NamedTuple):
    """How a command ended, and what it said."""

    status: int
    out: str
    err: str


class Reports:
    """The files in an output folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    @property
    def json(self) -> dict[str, Any]:
        """`results.json`; a number that is not finite is refused."""
        return json.loads((self.folder / "results.json").read_text("utf-8"), parse_constant=_refuse)

    @property
    def test(self) -> dict[str, Any]:
        """The only test."""
        (test,) = self.json["tests"]
        return test

    @property
    def verdicts(self) -> dict[str, dict[str, str]]:
        """Verdicts of `results.json` by test and check."""
        return {test["id"]: {c["check"]: c["status"] for c in test["checks"]} for test in self.json["tests"]}

    @property
    def junit(self) -> ET.Element:
        """`junit.xml`."""
        return ET.parse(self.folder / "junit.xml").getroot()

    @property
    def page(self) -> Any:
        """`report.html`."""
        return lxml.html.document_fromstring((self.folder / "report.html").read_bytes())

    @property
    def files(self) -> set[str]:
        """Names of all files, with their folders."""
        return {p.relative_to(self.folder).as_posix() for p in self.folder.rglob("*") if p.is_file()}


def _refuse(constant: str) -> None:
    raise AssertionError(f"results.json holds {constant}")


def _command(*arguments: str | Path, **environment: str) -> Ended:
    out, err = io.StringIO(), io.StringIO()
    with (
        mock.patch.dict(os.environ, surroundings(environment), clear=True),
        mock.patch("pvlvrt_compliance.study.executors.choosing.PAYS_FROM_S", math.inf),  # what is patched is here alone
        redirect_stdout(out),
        redirect_stderr(err),
    ):
        status = run([str(argument) for argument in arguments])
    return Ended(status, out.getvalue(), err.getvalue())


def _program(*arguments: str | Path, cwd: Path | None = None, **environment: str) -> Ended:
    done = subprocess.run(
        [*PROGRAM, *map(str, arguments)],
        cwd=cwd,
        env=surroundings(environment),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        timeout=PATIENCE_S,
        check=False,
    )
    return Ended(done.returncode, done.stdout.decode("utf-8"), done.stderr.decode("utf-8"))


@pytest.fixture(scope="session")
def command() -> Callable[..., Ended]:
    """Run the command in this process: ``command(*arguments, **environment) -> (status, out, err)``."""
    return _command


@pytest.fixture(scope="session")
def program() -> Callable[..., Ended]:
    """Run the command as a program: ``program(*arguments, cwd=None, **environment) -> (status, out, err)``."""
    return _program


@pytest.fixture(scope="session")
def start_program() -> Callable[..., subprocess.Popen[bytes]]:
    """Start the command as a program and leave it running."""

    def start(*arguments: str | Path) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            [*PROGRAM, *map(str, arguments)],
            env=surroundings({}),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )

    return start


@pytest.fixture(scope="session")
def reports() -> type[Reports]:
    """Look into an output folder: ``reports(folder)``."""
    return Reports


@pytest.fixture
def judge(tmp_path: Path) -> Callable[..., tuple[Ended, Reports]]:
    """Judge against the shipped profile: ``judge(*arguments, **environment) -> (how it ended, its reports)``."""

    def judge(*arguments: str, **environment: str) -> tuple[Ended, Reports]:
        folder = tmp_path / "out"
        ended = _command("--profile", "iec61400-21", "--output", folder, *arguments, **environment)
        return ended, Reports(folder)

    return judge


class Compared(NamedTuple):
    """How a comparison ended, and the folder that it was written into."""

    status: int
    out: str
    err: str
    folder: Path

    @property
    def comparison(self) -> Comparison:
        """What it found."""
        return Comparison.model_validate_json((self.folder / "comparison.json").read_bytes())

    @property
    def page(self) -> Any:
        """Its page."""
        return lxml.html.document_fromstring((self.folder / "comparison.html").read_bytes())


@pytest.fixture
def beside(tmp_path: Path) -> Callable[..., Compared]:
    """Compare: ``beside(old, new, *options)``."""

    def run(old: str | Path, new: str | Path, *options: str | Path) -> Compared:
        return Compared(*_command("compare", old, new, "--output", tmp_path / "out", *options), tmp_path / "out")

    return run


class MainJob(NamedTuple):
    """The main job, run as a program."""

    ended: Ended
    reports: Reports


@pytest.fixture(scope="session")
def main_job(tmp_path_factory: pytest.TempPathFactory) -> MainJob:
    """The main job as the README has it, from an empty folder, with CSV besides."""
    folder = tmp_path_factory.mktemp("main-job")
    ended = _program("--profile", "iec61400-21", "--sag", "90%", "--csv", cwd=folder)
    return MainJob(ended, Reports(folder / "pvlvrt-report"))


@pytest.fixture
def mine(tmp_path: Path) -> Callable[..., Path]:
    """Write a profile: ``mine(text) -> path``."""

    def write(text: str = "", head: str = HEAD) -> Path:
        (tmp_path / "mine.toml").write_text(head + text, "utf-8")
        return tmp_path / "mine.toml"

    return write
