"""A job in, a stream of judged tests out, with what is made of each record."""

import itertools
import threading
from datetime import UTC, datetime

import makings
import pytest

from pvlvrt_compliance.errors import OutputError, SimulationError, UsageError
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.simulation import simulate as simulation
from pvlvrt_compliance.study.executors.units import units_of
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.named import Named
from pvlvrt_compliance.study.run import run_test
from pvlvrt_compliance.study.session import session
from pvlvrt_compliance.study.work import Keeping, Work

IEC = "iec61400-21"


def job(*profiles, **asked):
    """A job of these profiles."""
    return make_job(Asked(profiles=profiles, **asked))


def test_what_is_made_of_a_record_comes_with_its_test():
    """The function is found by its name and given its options; the result is that of a test run alone."""
    asked = job(IEC, tests=("VD3-full-*",))
    found = list(session(Work(job=asked, each=Named("makings:length", {"unit_s": 1e-3}))))
    assert [tested.test.id for tested in found] == ["VD3-full-1", "VD3-full-2"]
    for tested in found:
        assert tested.result.wall_time_s > 0
        untimed = tested.result.model_copy(update={"wall_time_s": 0.0})
        assert untimed == run_test(tested.profile, tested.test, asked.parameters).result
        assert tested.made == (tested.test.id, pytest.approx(1e3 * tested.result.duration_s))


def test_nothing_is_made_unless_it_is_asked_for():
    """Without a function the results come alone."""
    (tested,) = session(Work(job=job(IEC, sag=0.9)))
    assert (tested.result.status, tested.made) == (Status.PASS, None)


def test_one_record_for_all_profiles(runs):
    """A scenario is simulated once, and judged by each profile."""
    found = list(session(Work(job=job(IEC, "es-po-12.3", sag=0.5))))
    assert [tested.profile.id for tested in found] == [IEC, "es-po-12.3"]
    assert len(runs) == 1


def test_progress(runs):
    """Each test is named before it is run, with how many are finished."""
    told = []
    list(session(Work(job=job(IEC, tests=("VD3-full-*",))), progress=lambda *words: told.append((*words, len(runs)))))
    assert [words[:3] for words in told] == [(f"{IEC} VD3-full-1", 0, 2), (f"{IEC} VD3-full-2", 1, 2)]
    assert told[0][3] == 0


def keeping(folder):
    """Records kept in a folder."""
    (folder / "waveforms").mkdir()
    created = datetime(2026, 1, 1, tzinfo=UTC)
    return Keeping(staging=folder, folder=folder.parent / "report", created=created)


def test_what_is_kept_says_so_in_its_result(tmp_path):
    """A record is kept before anything is made of it, and the result is the one that says where."""
    makings.SEEN.clear()
    work = Work(job=job(IEC, tests=("VD3-full-1",)), keeping=keeping(tmp_path), each=Named("makings:seen"))
    (tested,) = session(work)
    assert tested.result.waveforms == "waveforms/VD3-full-1.cfg"
    assert (tmp_path / tested.result.waveforms).is_file()
    assert [seen.waveforms for seen in makings.SEEN] == [tested.result.waveforms]


def test_a_test_that_cannot_be_simulated(monkeypatch):
    """It is an error with the reason, of which nothing is made; the others go on."""
    right, seen = simulation.simulate, []

    def simulate(scenario, parameters):
        seen.append(scenario)
        if len(seen) == 1:
            raise SimulationError("no good")
        return right(scenario, parameters)

    monkeypatch.setattr(simulation, "simulate", simulate)
    first, second = session(Work(job=job(IEC, tests=("VD3-full-*",)), each=Named("makings:length")))
    assert (first.result.status, first.made) == (Status.ERROR, None)
    assert "no good" in first.result.checks[0].message
    assert (second.result.status, second.made[0]) == (Status.PASS, "VD3-full-2")


def test_a_row_that_is_held_back_is_drawn_as_it_is_decided():
    """What is made of a run that is not ridden through is made of the verdict on its row, once for each run."""
    profile = _with_repeated_runs()
    asked = make_job(
        Asked(profiles=(profile,), tests=("VD3-full-*",), settings=("protection.overcurrent_pu=1.1",)),
    )
    makings.SEEN.clear()
    found = list(session(Work(job=asked, each=Named("makings:seen"))))
    assert [tested.result for tested in found] == makings.SEEN
    assert [tested.made for tested in found] == list(range(len(found)))
    assert [check.check for check in found[-1].result.checks][-1] == "repeated_runs"


def _with_repeated_runs():
    number = {"value": 2, "confidence": "memory", "source": "a test"}
    rule = {"clause": "6.1", "source": "a test", "consecutive": number, "consecutive_after_trip": number}
    profile = load_profile(IEC)
    data = profile.model_dump(by_alias=True, exclude_none=True)
    data["requirements"] |= {"repeated_runs": rule}
    return type(profile).model_validate(data)


@pytest.mark.parametrize(
    "name", ["absent_module:length", "makings:absent", "makings", "makings:", ":length", "", "makings.length"]
)
def test_a_name_of_no_function(runs, name):
    """It is refused before anything is simulated."""
    with pytest.raises(UsageError, match="there is no such function"):
        next(session(Work(job=job(IEC, sag=0.9), each=Named(name))))
    assert not runs


class Endless:
    """A simulator that never comes to an end by itself."""

    notes, is_in_process = (), False

    def __init__(self):
        self.stopped = threading.Event()
        self.begun = []

    def __call__(self, scenario, parameters):
        self.begun.append(scenario)
        if len(self.begun) > 1:
            self.stopped.wait()
            raise SimulationError("stopped")
        return simulation.simulate(scenario, parameters)

    def stop(self):
        """End it."""
        self.stopped.set()


def test_who_stops_listening_ends_the_run():
    """The controller that is at the next test already is told to stop."""
    controller = Endless()
    stream = session(Work(job=job(IEC, tests=("VD3-*",))), controller=controller)
    next(stream)
    stream.close()
    assert controller.stopped.is_set()


def test_what_fails_while_a_record_is_kept_ends_the_run(tmp_path):
    """An error on the way out stops the controller, too, and names the file as it would have been in its place."""
    controller = Endless()
    work = Work(job=job(IEC, tests=("VD3-*",)), keeping=keeping(tmp_path))
    (tmp_path / "waveforms").rmdir()
    with pytest.raises(OutputError, match=r"report/waveforms/.*\.dat cannot be written: No such file"):
        next(session(work, controller=controller))
    assert controller.stopped.is_set()


def test_rows_that_share_a_scenario_make_one_unit():
    """Each scenario belongs to one unit, all rows are in one, and a unit that shares nothing is one row."""
    asked = job("all")
    units = units_of(asked.tests)
    owners = {}
    for number, unit in enumerate(units):
        for item in itertools.chain(*unit):
            assert owners.setdefault(item.test.scenario, number) == number
    assert sorted(item.key for unit in units for row in unit for item in row) == sorted(x.key for x in asked.tests)
    for unit in units:
        rest = [{item.test.scenario for item in row} for row in unit]
        joined = rest.pop()
        while rest:
            near = next(row for row in rest if row & joined)  # StopIteration: not connected
            rest.remove(near)
            joined |= near
