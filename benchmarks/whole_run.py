"""Times a run of every profile, and two worker processes against one core."""

import json
import os
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from child import Run, evaluated, program_path
from row import Row

_ALL = ("--profile", "all", "--waveforms", "failed")
_TESTS = 200


def rows_of_all(runs: int) -> Iterator[Row]:
    """Row of a run of every profile with its reports, on the cores that this process may use.

    Its reference is the processor time that the run has spent: what one core would have taken.
    """
    program = program_path()
    timed, counts = [], []
    for _ in range(runs):
        with tempfile.TemporaryDirectory() as folder:
            timed.append(evaluated([program, *_ALL, "--output", folder]))
            counts.append(len(json.loads((Path(folder) / "results.json").read_bytes())["tests"]))
    yield Row(
        f"`pvlvrt-check {' '.join(_ALL)}`, {counts[0]} runs, {len(_usable())} cores",
        [ended.wall_s for ended in timed],
        "s",
        must=100,
        stretch=60,
        reference="processor time of the same run",
        reference_values=[ended.processor_s or 0.0 for ended in timed],
    )


def rows_of_jobs(runs: int) -> Iterator[Row]:
    """Row of two worker processes on two cores against ``--jobs 1`` bound to one core, where nothing is made ahead."""
    if shutil.which("taskset") is None:  # nothing else binds a process to a core
        return
    program = program_path()
    words = _two_hundred_tests()
    pairs = [(_on_cores(program, words, 2), _on_cores(program, words, 1)) for _ in range(runs)]
    yield Row(
        f"`--jobs 2` against `--jobs 1` bound to one core, {_TESTS} tests",
        [one.wall_s / two.wall_s for two, one in pairs],
        "x",
        must=1.9,
        is_at_least=True,
        reference="the run on one core",
        reference_values=[one.wall_s for _, one in pairs],
    )


def _on_cores(program: str, words: Sequence[str], cores: int) -> Run:
    """A run of so many jobs that may use so many cores."""
    allowed = ",".join(str(core) for core in _usable()[:cores])
    with tempfile.TemporaryDirectory() as folder:
        command = ["taskset", "-c", allowed, program, *words, "--jobs", str(cores), "--output", folder]
        return evaluated(command)


def _two_hundred_tests() -> list[str]:
    """Words that select so many tests of the profiles, short ones, whose scenarios all differ."""
    from pvlvrt_compliance.study.job import Asked, make_job

    by_scenario = {item.test.scenario: item for item in make_job(Asked(profiles=("all",))).tests}
    shortest = sorted(by_scenario.values(), key=lambda item: item.test.scenario.end_s)[:_TESTS]
    profiles = list(dict.fromkeys(item.profile.id for item in shortest))
    chosen = [word for profile in profiles for word in ("--profile", profile)]
    tests = [word for item in shortest for word in ("--test", item.key)]
    return [*chosen, *tests, "--waveforms", "none"]


def _usable() -> list[int]:
    """Cores that this process may use."""
    if sys.platform == "linux":
        return sorted(os.sched_getaffinity(0))
    return list(range(os.cpu_count() or 1))
