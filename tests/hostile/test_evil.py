"""Controllers that do harm, run by the command: each costs its own test, and every other one stays in the report."""

import shutil
from collections import Counter

import pytest

from tests.hostile.evil_more import ALL, needs_compiler
from tests.hostile.evil_sweep import EvilSweep, is_usable

pytestmark = pytest.mark.skipif(not is_usable(), reason="only Linux holds a controller to all of its limits")

EACH_TIME = (
    "stops its parent, python",
    "commands the runner, python",
    "forges an answer, python",
    "answers with no number, program",
    "closes its mouth, program",
    "overflows its stack, library",
    "kills its group, library",
    "aborts, fmu",
    "unpacks to 2 GB, fmu",
)
"""Of every door, and of every kind of end; `python -m tests.hostile --evil '*'` runs all."""


def test_forty_of_each_door():
    """As many controllers do harm through each door, no two by the same deed."""
    doors = Counter(evil.door for evil in ALL.values())
    assert set(doors) == {"python", "library", "program", "fmu"}
    assert min(doors.values()) >= 40


@pytest.mark.slow
@pytest.mark.compiler
@pytest.mark.parametrize("name", EACH_TIME)
def test_it_costs_its_own_test(tmp_path, name):
    """An error with its reason, or no harm; the other test is judged, and no file and no process is left."""
    evil = ALL[name]
    if needs_compiler(evil) and shutil.which("gcc") is None:
        pytest.skip("gcc is missing")
    assert EvilSweep(tmp_path).wrong(name, evil) == []
