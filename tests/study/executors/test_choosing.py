"""Where tests are run, by what was asked for and by what pays."""

import pytest
from lasting import Controller

from pvlvrt_compliance.controllers.here import SimulatorHere
from pvlvrt_compliance.controllers.process import cores
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.study.executors import choosing
from pvlvrt_compliance.study.executors.choosing import EACH_S, PAYS_FROM_S, choose_executor
from pvlvrt_compliance.study.executors.here import Here
from pvlvrt_compliance.study.executors.processes import Processes
from pvlvrt_compliance.study.executors.units import cost_s, units_of
from pvlvrt_compliance.study.job import AUTO, HOW, Asked, make_job
from pvlvrt_compliance.study.work import Work

MANY = {"profiles": ("iec61400-21", "es-po-12.3")}
FEW = {"profiles": ("iec61400-21",), "tests": ("VD6-*",)}
ONE = {"profiles": ("iec61400-21",), "tests": ("VD6-full-*",)}


@pytest.fixture(autouse=True)
def _cores(monkeypatch):
    """A machine of four cores."""
    monkeypatch.setattr(choosing, "usable_cores", lambda: 4)


def chosen(jobs, controller=None, **asked):
    """What is chosen, and the simulated time of all units."""
    job = make_job(Asked(jobs=jobs, **asked))
    units = units_of(job.tests)
    return choose_executor(Work(job=job), units, controller), sum(map(cost_s, units))


@pytest.mark.parametrize(
    ("jobs", "asked", "executor"),
    [
        (None, MANY, Here()),
        (1, MANY, Here(is_ahead=False)),
        ("1", FEW, Here(is_ahead=False)),
        (2, MANY, Processes(2)),
        ("3", MANY, Processes(3)),
        (1000, MANY, Processes(1000)),  # as many as there are units
        (AUTO, MANY, Processes(4)),
        (AUTO, FEW, Here()),
        (AUTO, ONE, Here()),
    ],
)
def test_it_goes_by_what_was_asked_for_and_what_pays(jobs, asked, executor):
    """Nothing is said where what was asked for is done, or nothing was."""
    found, cost = chosen(jobs, **asked)
    assert (type(found.executor), found.note) == (type(executor), "")
    if isinstance(executor, Here):
        assert found.executor == executor
    else:
        units = units_of(make_job(Asked(**asked)).tests)
        assert found.executor.count == min(executor.count, len(units))
        assert cost >= max(PAYS_FROM_S, EACH_S * min(executor.count, 4))


@pytest.mark.parametrize(
    ("asked", "words"), [(FEW, "too little for processes to pay"), (ONE, "share a record, or the verdict on a row")]
)
def test_what_was_asked_for_and_is_not_done_is_said(asked, words):
    """Whoever names a number is told why there is one process."""
    found, _ = chosen(2, **asked)
    assert found.executor == Here()
    assert words in found.note


def test_a_controller_of_this_process_stays_here():
    """No other process has it."""
    controller = SimulatorHere(Controller)
    found, _ = chosen(2, controller, **MANY)
    assert found.executor == Here(controller)
    assert "the controller exists in this process alone" in found.note


@pytest.mark.parametrize("given", ["0", "-1", "many", "1.5", 0])
def test_what_is_no_number_of_jobs(given):
    """It is refused before anything is run."""
    with pytest.raises(UsageError, match=rf"jobs {given}: give how many tests are run at once, 1 to 1024, or auto"):
        make_job(Asked(profiles=("iec61400-21",), jobs=given))


def test_options_know_what_says_how():
    """The command leaves the same fields out of what a run records as the library does; --debug is of one call."""
    from pvlvrt_compliance.cli.options import SETTINGS

    assert {setting.field for setting in SETTINGS if setting.is_how} == set(HOW) - {"debug"}
    assert "debug" not in {setting.field for setting in SETTINGS}


@pytest.mark.parametrize(
    ("quotas", "affinity", "count"),
    [
        ({"": "max 100000", "/a": "150000 100000"}, 8, 2),
        ({"": "max 100000", "/a": "max 100000"}, 8, 8),
        ({"": "50000 100000", "/a": "800000 100000"}, 8, 1),
        ({}, 3, 3),
        ({"/a": "garbage"}, 2, 2),
    ],
)
def test_usable_cores(tmp_path, monkeypatch, quotas, affinity, count):
    """The least that the affinity and any control group give, whole cores, at least one."""
    (tmp_path / "cgroup").write_text("0::/a\n")
    for name, text in quotas.items():
        folder = tmp_path / "groups" / name.lstrip("/")
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "cpu.max").write_text(f"{text}\n")
    monkeypatch.setattr(cores, "_GROUPS", tmp_path / "groups")
    monkeypatch.setattr(cores, "_OWN_GROUP", tmp_path / "cgroup")
    monkeypatch.setattr(cores.os, "sched_getaffinity", lambda _: set(range(affinity)), raising=False)
    assert cores.usable_cores() == count
