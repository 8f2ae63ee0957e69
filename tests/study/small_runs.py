"""Runs of two small tests for an output folder; as a program, ones that are killed at every step of their placing.

``python small_runs.py FOLDER``: in `FOLDER/0`, `FOLDER/1`, ... a first run is whole and a second is killed at step 0,
1, ... of taking its place; the last one of them comes to its end.
"""

import itertools
import json
import os
import shutil
import signal
import sys
import xml.etree.ElementTree as ET
from functools import cache
from pathlib import Path

from pvlvrt_compliance.report.formats import html, junit, results_json
from pvlvrt_compliance.results import Results, Status, TestResult, Verdict, conclude
from pvlvrt_compliance.study.store import JUNIT, REPORT, RESULTS, WAVEFORMS, OutputFolder

STEPS = ("replace", "rename", "unlink", "remove", "rmdir", "mkdir")
FOREIGN = ("notes.txt", "waveforms/others.dat", "waveforms/first.png", "interrupted/mine.txt")


def results_of(name: str) -> Results:
    """What a run of this name found: the first is passed, all others are errors. Each has a test of its own."""
    status = Status.PASS if name == "first" else Status.ERROR
    checks = (Verdict(check="ride_through", status=status, message=name),)
    tests = [
        TestResult(id=test, status=status, checks=checks, waveforms=f"{WAVEFORMS}/{test}.cfg")
        for test in ("common", name)
    ]
    return conclude(tests)


def stage(folder: Path, name: str) -> OutputFolder:
    """Stage a run."""
    output = OutputFolder(str(folder))
    for test in ("common", name):
        for ending in ("cfg", "dat"):
            (output.waveforms / f"{test}.{ending}").write_text(name)
    for file, content in _reports(name).items():
        output.write(file, content)
    return output


@cache
def _reports(name: str) -> dict[str, str | bytes]:
    results = results_of(name)
    return {
        RESULTS: results_json.render(results),
        JUNIT: junit.render(results),
        REPORT: html.render(results, {}),
    }


def keep(output: OutputFolder, name: str) -> None:
    """Keep a staged run as an interrupted one, of which there is no report."""
    output.drop_all_but({"common", name})
    output.write(RESULTS, _reports(name)[RESULTS])
    output.keep_interrupted()


def begin(folder: Path) -> None:
    """A folder with the first run, an interrupted one, and files of somebody else."""
    stage(folder, "first").finish()
    keep(stage(folder, "earlier"), "earlier")
    for name in FOREIGN:
        (folder / name).write_text("mine")


def ids(folder: Path) -> dict[str, str]:
    """The id that each verdict file carries, by the file's name."""
    found = {}
    if (folder / RESULTS).exists():
        found[RESULTS] = json.loads((folder / RESULTS).read_text("utf-8"))["run_id"]
    if (folder / JUNIT).exists():
        of_suites = {p.get("value") for p in ET.parse(folder / JUNIT).iterfind(".//property[@name='run_id']")}
        (found[JUNIT],) = of_suites
    if (folder / REPORT).exists():
        page = (folder / REPORT).read_text("utf-8")
        found[REPORT] = page.partition('<meta name="run-id" content="')[2].partition('"')[0]
    return found


def names_in(folder: Path) -> set[str]:
    """All files, with their folders."""
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def assert_whole(folder: Path, name: str) -> None:
    """All files of a run, and of it alone."""
    assert ids(folder) == dict.fromkeys((RESULTS, JUNIT, REPORT), results_of(name).run_id)
    for test in json.loads((folder / RESULTS).read_text("utf-8"))["tests"]:
        assert (folder / test["waveforms"]).read_text() == name
        assert (folder / test["waveforms"]).with_suffix(".dat").read_text() == name


def _killed_at(step: int) -> None:
    """Have this process killed before its `step`-th change of a folder from here on."""
    steps = itertools.count()

    def counted(right):
        def change(*arguments, **keywords):
            if next(steps) == step:
                os.kill(os.getpid(), signal.SIGKILL)
            return right(*arguments, **keywords)

        return change

    for name in STEPS:
        setattr(os, name, counted(getattr(os, name)))


def _main(folder: Path) -> None:
    begin(folder / "begin")
    _reports("second")  # once, not in every process
    for step in itertools.count():
        place = folder / str(step)
        shutil.copytree(folder / "begin", place)
        child = os.fork()
        if child == 0:
            output = stage(place, "second")
            _killed_at(step)
            output.finish()
            os._exit(0)
        if os.waitpid(child, 0)[1] == 0:
            return


if __name__ == "__main__":
    _main(Path(sys.argv[1]))
