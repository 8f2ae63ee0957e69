"""A controller that does harm in one test: all others are in the results, wherever the tests are run."""

import os
import shutil

import pytest

from evil import EVIL
from pvlvrt_compliance.controllers.process.family import FORKS, descendants
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.study.executors.here import Here
from pvlvrt_compliance.study.executors.processes import Processes
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.opening import open_controller
from pvlvrt_compliance.study.session import session
from pvlvrt_compliance.study.work import Work
from waiting import wait_until

DEEP = "VD3-full-1"
TESTS = ("VD1-full-1", DEEP, "VD1-full-2")
"""In the middle one harm is done."""

EXECUTORS = {"here": Here, "in processes": lambda controller: Processes(2, controller)}

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not FORKS, reason="only Linux holds a controller to all of its limits"),
]


@pytest.mark.parametrize("where", EXECUTORS)
@pytest.mark.parametrize(
    "name",
    [
        *("forges an answer, python", "forges with a link, python", "kills its parent, python"),
        *("stops its parent, python", "removes its folder, python", "speaks to its parent's reader, python"),
        *("answers then dies, python", "eats memory, python", "starts processes, python"),
        pytest.param("stops its parent, library", marks=pytest.mark.compiler),
    ],
)
def test_every_other_test_is_in_the_results(name, where, tmp_path, monkeypatch):
    """The one in which it is done is an error with the reason."""
    evil = EVIL[name]
    if evil.needs_compiler and shutil.which("gcc") is None:
        pytest.skip("gcc is missing")
    (temporary := tmp_path / "tmp").mkdir()
    monkeypatch.setenv("TMPDIR", str(temporary))
    monkeypatch.setattr("tempfile.tempdir", None)
    before = set(descendants(os.getpid()))
    asked = Asked(profiles=("iec61400-21",), tests=TESTS, controller=evil.build(tmp_path), settings=evil.settings)
    job = make_job(asked)
    controller = open_controller(job)
    stream = session(Work(job=job), controller=controller, executor=EXECUTORS[where](controller))
    found = {test.result.id: test.result for test in stream}
    assert set(found) == set(TESTS)
    assert {test for test in TESTS if found[test].status == Status.ERROR} == {DEEP}
    assert all(evil.expected in check.message for check in found[DEEP].checks)
    controller.stop()
    wait_until(lambda: not set(descendants(os.getpid())) - before, "the end of all processes")
    assert list(temporary.iterdir()) == []
