"""Times the main command warm and with nothing compiled yet, its helps and lists, and its peak memory.

Each is run in turn with a Python that imports numba and compiles one function, or with one that imports typer and rich:
what the machine does at its best is in both. Imports nothing but the standard library, for the sake of the peak memory
(`child`).
"""

import os
import statistics
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from child import COMMAND, Run, evaluated, program_path, run
from row import Row

MAIN_JOB = ("--profile", "iec61400-21", "--sag", "90%")
_NUMBA = (sys.executable, "-c", "import numba; numba.njit(lambda x: x+1)(1)")
_EMPTY = (sys.executable, "-c", "pass")
_TYPER = (sys.executable, "-c", "import typer, rich")
_LIGHT = ((("--help",), 0.2), (("compare", "--help"), 0.2), (("--version",), 0.1), (("profiles", "list"), 0.3))
_TYPER_IN_WORDS = 'python -c "import typer, rich"'
_IN_WORDS = 'python -c "import numba; numba.njit(lambda x: x+1)(1)"'


def rows(runs: int, cold_runs: int) -> Iterator[Row]:
    """Rows of the table.

    Parameters
    ----------
    runs : int
        Runs of each, in turn with the reference.
    cold_runs : int
        Runs that compile anew.
    """
    program = program_path()
    job = [program, *MAIN_JOB]
    _main_job(job, cold=False)  # leaves bytecode and compiled code behind
    run(_NUMBA)
    pairs = [(_main_job(job, cold=False), run(_NUMBA)) for _ in range(runs)]
    yield Row(
        f"`pvlvrt-check {' '.join(MAIN_JOB)}`, warm",
        [mine.wall_s / other.wall_s for mine, other in pairs],
        "x",
        must=1.3,
        stretch=1.0,
        reference=_IN_WORDS,
        reference_values=[other.wall_s for _, other in pairs],
        remark=f"{sorted(mine.wall_s for mine, _ in pairs)[len(pairs) // 2]:.2f} s",
    )
    cold = [(_main_job(job, cold=True), run(_NUMBA)) for _ in range(cold_runs)]
    yield _against_numba("the same, nothing compiled yet", cold, must=10, stretch=6)
    for words, must in _LIGHT:
        yield _against_typer([program, *words], runs, must)
    yield _for_the_first_time([program, "--help"], runs)
    if all(mine.peak_mb and other.peak_mb for mine, other in pairs):
        yield Row(
            "peak memory of the main job",
            [mine.peak_mb or 0.0 for mine, _ in pairs],
            "MB",
            must=200,
            stretch=150,
            reference=_IN_WORDS,
            reference_values=[other.peak_mb or 0.0 for _, other in pairs],
            reference_unit="MB",
        )


def _against_numba(what: str, pairs: Sequence[tuple[Run, Run]], *, must: float, stretch: float) -> Row:
    return Row(
        what,
        [mine.wall_s for mine, _ in pairs],
        "s",
        must=must,
        stretch=stretch,
        reference=_IN_WORDS,
        reference_values=[other.wall_s for _, other in pairs],
    )


def _against_typer(command: Sequence[str], runs: int, must: float) -> Row:
    """A command that says what it has said before: helps and the list of profiles are kept then."""
    _said(command)
    timed = [(_said(command), run(_TYPER), run(_EMPTY)) for _ in range(runs)]
    times_empty = statistics.median(mine.wall_s / empty.wall_s for mine, _, empty in timed)
    times_typer = statistics.median(mine.wall_s / typer.wall_s for mine, typer, _ in timed)
    return Row(
        f"`{COMMAND} {' '.join(command[1:])}`",
        [mine.wall_s for mine, _, _ in timed],
        "s",
        must=must,
        reference=_TYPER_IN_WORDS,
        reference_values=[typer.wall_s for _, typer, _ in timed],
        remark=f"{times_typer:.2f} x the reference, {times_empty:.1f} x `python -c pass`",
    )


def _for_the_first_time(command: Sequence[str], runs: int) -> Row:
    """The same where nothing is kept yet."""
    with tempfile.TemporaryDirectory() as folder:
        empty = ({**os.environ, "NUMBA_CACHE_DIR": str(Path(folder) / str(number))} for number in range(runs))
        timed = [(_said(command, environment), run(_TYPER)) for environment in empty]
    return Row(
        f"`{COMMAND} {' '.join(command[1:])}` for the first time",
        [mine.wall_s for mine, _ in timed],
        "s",
        reference=_TYPER_IN_WORDS,
        reference_values=[typer.wall_s for _, typer in timed],
    )


def _said(command: Sequence[str], environment: Mapping[str, str] | None = None) -> Run:
    ended = run(command, environment)
    if ended.status != 0:
        raise RuntimeError(f"{' '.join(command)} ended with status {ended.status}")
    return ended


def _main_job(job: Sequence[str], *, cold: bool) -> Run:
    """Run the main job into a folder that goes away; cold: without any compiled code."""
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ)
        if cold:
            environment["NUMBA_CACHE_DIR"] = str(Path(folder) / "cache")
        return evaluated([*job, "--output", str(Path(folder) / "report")], environment)
