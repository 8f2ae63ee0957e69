"""What is compared: results that are there already, or controllers that are run for it, and where the files go."""

import stat
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from pvlvrt_compliance.controllers.bundled import BUNDLED
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.ordinary_file import mode_of
from pvlvrt_compliance.results import Results
from pvlvrt_compliance.results.files import COMPARISON_FILES, INTERRUPTED, JUNIT, NEW, OLD, RESULTS
from pvlvrt_compliance.results.reading import read_results
from pvlvrt_compliance.study.job import Asked, Job, Spell, make_job
from pvlvrt_compliance.study.opening import open_controller
from pvlvrt_compliance.study.running import Output, run_job
from pvlvrt_compliance.study.session import Progress
from pvlvrt_compliance.study.store import OutputFolder


class Side(NamedTuple):
    """One of two runs: its name, and what it found, with the folder that its waveforms are named from."""

    name: str
    results: Results
    folder: Path


class Runs(NamedTuple):
    """How controllers are run that are compared.

    Parameters
    ----------
    output : callable
        What a run writes into a folder, by how many tests it has.
    watch : callable
        What hears of so many tests.
    tell : callable
        Is given what there is to know besides.
    command : sequence of str
        What makes the comparison again.
    settings : mapping, optional
        What was taken from a file of settings or the environment, as of `run_job`.
    """

    output: Callable[[str, int], Output]
    watch: Callable[[int], AbstractContextManager[Progress | None]]
    tell: Callable[[str], None]
    command: Sequence[str]
    settings: Mapping[str, Any] | None = None


def results_file(name: str) -> Path | None:
    """The results that a name stands for, a file or a folder that holds them; None of what may be a controller.

    Raises
    ------
    UsageError
        When it is a folder without results.
    """
    path = Path(name)
    if path.suffix.lower() == ".json":
        return path
    if not stat.S_ISDIR(mode_of(path)):
        return None
    if (path / RESULTS).is_file():
        return path / RESULTS
    part = path / INTERRUPTED / RESULTS
    hint = f"; the tests that an interrupted run has finished are in {part}" if part.is_file() else ""
    raise UsageError(f"{name}: the folder has no {RESULTS}{hint}")


def are_run(names: tuple[str, str]) -> bool:
    """Whether any of two names stands for a controller, which is to be run.

    Raises
    ------
    UsageError
        As of `results_file`.
    """
    return any(results_file(name) is None for name in names)


def refuse_unused(given: Collection[str], spell: Spell = str) -> None:
    """Refuse what says how controllers are run, where there are only results.

    Parameters
    ----------
    given : collection of str
        What was given of it, by its name in `Asked` or in settings.
    spell : callable
        As of `make_job`.

    Raises
    ------
    UsageError
        When anything was.
    """
    if given:
        verb = "goes" if len(given) == 1 else "go"
        raise UsageError(f"{', '.join(map(spell, given))} {verb} with controllers, not with results: nothing is run")


def read_side(name: str) -> Side:
    """Results that are there already.

    Raises
    ------
    UsageError
        When there are none, or they cannot be read.
    """
    file = results_file(name)
    if file is None:
        raise UsageError(f"{name}: no results; name a {RESULTS} or a folder that holds one")
    return Side(name, read_results(file), file.parent)


def sides_of(names: tuple[str, str], asked: Asked, folder: str, runs: Runs, spell: Spell = str) -> tuple[Side, Side]:
    """Both runs: those that are results are read, and controllers are run, into ``old`` and ``new`` of a folder.

    Parameters
    ----------
    names : tuple of str
        A `results.json`, a folder that holds one, or the specification of a controller each.
    asked : Asked
        What the controllers are asked for; of no meaning where none is.
    folder : str
        Where their files go.
    runs : Runs
        How they are run.
    spell : callable
        As of `make_job`.

    Raises
    ------
    PvlvrtError
        As `make_job` and `run_job`; nothing is run before both can be.
    """
    refuse_reports(folder, spell)
    files = [results_file(name) for name in names]
    jobs = [None if file else _job_of(name, asked, spell) for name, file in zip(names, files, strict=True)]
    ready = [job or read_side(name) for job, name in zip(jobs, names, strict=True)]
    own = [one for one in ready if isinstance(one, Job)]
    for job in own:
        open_controller(job)  # one that cannot be opened is told before the other one has run
    if own:
        withdraw(Path(folder))
    old, new = (
        _run(name, one, Path(folder) / part, runs) if isinstance(one, Job) else one
        for name, one, part in zip(names, ready, (OLD, NEW), strict=True)
    )
    return old, new


def _job_of(name: str, asked: Asked, spell: Spell) -> Job:
    if not asked.profiles:
        said = f"{name}: no results (a {RESULTS}, or a folder that holds one)"
        raise UsageError(f"{said}; a controller is run with {spell('profiles')}")
    is_bundled = name == BUNDLED
    own = replace(asked, controller=None, mapping=None) if is_bundled else replace(asked, controller=name)
    return make_job(own, spell)


def _run(name: str, job: Job, folder: Path, runs: Runs) -> Side:
    count = len(job.tests)
    output = runs.output(str(folder), count)
    results = run_job(
        job,
        command=runs.command,
        output=output,
        watch=runs.watch(count),
        tell=runs.tell,
        settings=runs.settings,
    )
    return Side(name, results, folder)


def withdraw(folder: Path) -> None:
    """Take away an earlier comparison, which would speak of other runs than those that stand beside it.

    Raises
    ------
    OSError
        When a file cannot be removed.
    """
    for name in reversed(COMPARISON_FILES):
        (folder / name).unlink(missing_ok=True)


def refuse_reports(folder: str, spell: Spell = str) -> None:
    """Refuse a folder in which a run has its reports: both write a `junit.xml`.

    Raises
    ------
    UsageError
        When it is one.
    """
    if (Path(folder) / RESULTS).exists():
        said = f"{folder} holds the reports of a run, and a comparison has a {JUNIT} of its own"
        raise UsageError(f"{spell('output')}: {said}; name another folder")


def write_comparison(folder: str, files: Mapping[str, str | bytes], spell: Spell = str) -> None:
    """Put the files of a comparison into a folder, all of them or none.

    Raises
    ------
    UsageError
        When nothing can be written there, or a run has its reports there.
    OutputError
        When a file cannot be written; what was there is there still.
    """
    refuse_reports(folder, spell)
    output = OutputFolder(folder, spell, files=COMPARISON_FILES)
    try:
        for name, content in files.items():
            output.write(name, content)
        output.finish()
    finally:
        output.discard()
