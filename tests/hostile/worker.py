"""Runs cases one after the other in one process, as the command would, and tells how each ended.

``python -m tests.hostile.worker SEED FOLDER KEEP NUMBER...``; a line of JSON a case on standard output.
"""

import contextlib
import io
import json
import os
import pickle
import resource
import shutil
import sys
import traceback
import warnings
from collections.abc import Callable
from inspect import getclosurevars
from pathlib import Path
from typing import Any
from unittest import mock

import typer

from pvlvrt_compliance.cache import cache_root
from pvlvrt_compliance.controllers.process import command as process
from pvlvrt_compliance.controllers.process.family import adopt_orphans, descendants
from pvlvrt_compliance.errors import stop_behind
from tests.hostile.case import EVALUATE, Case
from tests.hostile.cases import case_of
from tests.hostile.folder import clear, put
from tests.hostile.verdict import INTERRUPTED, Ended, reached_reports, wrong

FILES, TEMPORARY, HOME, CASE = "files", "tmp", "home", "case.pickle"
"""What lies in the folder of a worker."""

MORE_MEMORY = 3 << 30
"""Bytes of addresses that a worker may take besides what it has: what needs more is an error of that case."""

_SURROUNDINGS = ("PVLVRT_", "GITHUB_", "CI", "COLUMNS", "FORCE_COLOR", "NO_COLOR", "SOURCE_DATE_EPOCH")


def work(seed: int, place: Path, keep: Path, numbers: list[int]) -> None:
    """Run cases; what is wrong is kept in ``keep``."""
    tell = os.fdopen(os.dup(1), "w", buffering=1)
    _settle(place)
    for number in numbers:
        case = case_of(seed, number)
        put(case, place / FILES)
        (place / CASE).write_bytes(pickle.dumps(case))
        tell.write(json.dumps({"begins": number, "kind": case.kind, "simulates": case.simulates}) + "\n")
        ended = run(case, place)
        tell.write(json.dumps({"ends": number, **told(case, ended, place, keep / f"{seed}-{number}")}) + "\n")
        if ended.status == INTERRUPTED:  # what was interrupted may still be at work in a thread
            os._exit(0)


def told(case: Case, ended: Ended, place: Path, keep: Path) -> dict[str, Any]:
    """How a case ended, as JSON; keeps its files when something is wrong."""
    found = wrong(case, ended, place / FILES, interrupted=ended.status == INTERRUPTED)
    for name in (TEMPORARY, HOME):
        if left := sorted(path.name for path in (place / name).iterdir()):
            found.append(f"left in {name}: {left[:5]}")
            clear(place / name)
    said = {"kind": case.kind, "status": ended.status, "wrong": found, "arguments": case.arguments, "peak": ended.peak}
    if found:
        kept(case, ended, place, keep)
    return said | {"reached": reached_reports(ended, place / FILES)}


def kept(case: Case, ended: Ended, place: Path, keep: Path) -> None:
    """Keep the files of a case as they were before it ran, and what it said."""
    shutil.rmtree(keep, ignore_errors=True)
    put(case, keep / FILES)
    for name, content in (("stdout", ended.out), ("stderr", ended.err), (CASE, (place / CASE).read_bytes())):
        (keep / name).write_bytes(content)
    said = {"arguments": case.arguments, "environment": dict(case.environment), "encoding": case.encoding}
    (keep / "command.json").write_text(json.dumps(said, indent=1), "utf-8")


def _settle(place: Path) -> None:
    """Make this process what a start of the command is, with a home and a temporary folder that are watched."""
    for name in (TEMPORARY, HOME):
        clear(place / name)
    adopt_orphans()
    for name in [name for name in os.environ if name.startswith(_SURROUNDINGS)]:
        del os.environ[name]
    kernels = {"NUMBA_CACHE_DIR": str(cache_root())}
    os.environ.update(kernels, TMPDIR=str(place / TEMPORARY), HOME=str(place / HOME))
    for kind in (UserWarning, RuntimeWarning):
        warnings.filterwarnings("always", category=kind)
    typer.main.get_command = _once_made(typer.main.get_command)
    case_of(0, 0)  # the files that lie ready are made with all there is of memory
    now = int(Path("/proc/self/statm").read_text("ascii").split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (now + MORE_MEMORY, resource.RLIM_INFINITY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def _once_made(get_command: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """What typer makes of the table of options, made once: it takes half of the time that a wrong line takes.

    A start of the command leaves out parameters that are not given, and typer remembers what was: both are put back.
    """
    made: list[tuple[Any, Any, bool, dict[str, Any], dict[str, Any]]] = []

    def walk(command: Any) -> None:
        remembered = getclosurevars(command.callback).nonlocals.get("use_params", {}) if command.callback else {}
        made.append((command, command.params, command.add_help_option, remembered, dict(remembered)))
        for inner in getattr(command, "commands", {}).values():
            walk(inner)

    def get(app: Any) -> Any:
        if not made:
            walk(get_command(app))
        for command, params, add_help_option, remembered, at_first in made:
            command.params, command.add_help_option = params, add_help_option
            remembered.clear()
            remembered.update(at_first)
        return made[0][0]

    return get


def run(case: Case, place: Path) -> Ended:
    """Run one case."""
    before = set(descendants(os.getpid()))
    process._command.signals = 0  # a signal to this case is the first
    Path("/proc/self/clear_refs").write_text("5", "ascii")  # the peak begins anew
    with _streams(case, place), contextlib.chdir(place / FILES), mock.patch.dict(os.environ, case.environment):
        status = _status_of(case)
    left = [child for child in descendants(os.getpid()) if child not in before and _lives(child.pid)]
    for child in left:
        with contextlib.suppress(ProcessLookupError):
            os.kill(child.pid, 9)
    return ended(status, place, _peak(), len(left))


def ended(status: int, place: Path, peak: int = 0, processes: int = 0) -> Ended:
    """How a case ended that has written into the files of this folder."""
    return Ended(status, (place / "stdout").read_bytes(), (place / "stderr").read_bytes(), peak, processes)


def _status_of(case: Case) -> int:
    from pvlvrt_compliance.cli.start import main

    sys.argv = ["pvlvrt-check", *case.arguments]
    try:
        if case.arguments[:1] == (EVALUATE,):
            return _evaluate(*case.arguments[1:])
        main()
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else 0 if end.code is None else -1
    except BaseException as end:
        if stop := stop_behind(end):
            return process.status_of(stop)
        traceback.print_exc()
    return -1


def _evaluate(profile: str, record: str) -> int:
    from pvlvrt_compliance import evaluate, exit_status
    from pvlvrt_compliance.cli.telling import tell
    from pvlvrt_compliance.errors import PvlvrtError

    process.become_the_command()
    try:
        results = evaluate(profile, record)
    except PvlvrtError as error:
        tell(str(error))
        return 2
    sys.stdout.write(results.model_dump_json())
    return exit_status(results)


@contextlib.contextmanager
def _streams(case: Case, place: Path) -> Any:
    """Both streams into files, whoever writes to them: Python, a library, a process that was started."""
    saved = [(number, os.dup(number)) for number in (1, 2)]
    streams = sys.stdout, sys.stderr
    for number, name in ((1, "stdout"), (2, "stderr")):
        file = os.open(place / name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_APPEND, 0o600)
        os.dup2(file, number)
        os.close(file)
    sys.stdout = io.TextIOWrapper(io.FileIO(1, "w", closefd=False), case.encoding, write_through=True)
    sys.stderr = io.TextIOWrapper(
        io.FileIO(2, "w", closefd=False), case.encoding, "backslashreplace", write_through=True
    )
    try:
        yield
    finally:
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError, ValueError):
                stream.flush()
        sys.stdout, sys.stderr = streams
        for number, copy in saved:
            os.dup2(copy, number)
            os.close(copy)


def _lives(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text("ascii", "replace").rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def _peak() -> int:
    """Most memory that this process has had since the case began (bytes)."""
    for line in Path("/proc/self/status").read_text("utf-8").splitlines():
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) * 1024
    return 0


if __name__ == "__main__":
    work(int(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3]), [int(number) for number in sys.argv[4].split(",")])
