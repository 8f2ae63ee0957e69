"""Tests of a job that are run when they are asked for."""

import pytest

from pvlvrt_compliance.results import Status, TestResult, Verdict, worst
from pvlvrt_compliance.results.changes import Key
from pvlvrt_compliance.simulation import simulate as simulation
from pvlvrt_compliance.study import run
from pvlvrt_compliance.study.baseline.entries import Baseline, Entry
from pvlvrt_compliance.study.baseline.text import written
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.one_by_one import OneByOne
from pvlvrt_compliance.study.rows import run_rows
from pvlvrt_compliance.study.run import Judged

NTS = "es-nts-631-lt110kv"


def job(*profiles, **asked):
    """A job of these profiles."""
    return make_job(Asked(profiles=profiles, **asked))


@pytest.fixture
def judged(monkeypatch):
    """Tests that were run, in order; each fails to ride through that is named in ``judged.failing``."""

    class Seen(list):
        failing = ()

    seen = Seen()

    def run_test(profile, test, *_):
        seen.append(test.id)
        status = Status.FAIL if test.id in seen.failing else Status.PASS
        checks = (Verdict(check="ride_through", status=status),)
        result = TestResult(id=test.id, profile=profile.id, status=worst(c.status for c in checks), checks=checks)
        return Judged(result, None)

    monkeypatch.setattr(run, "run_test", run_test)
    return seen


def row_of_three(one_by_one):
    """The tests of the first row that has several runs."""
    first = next(item for item in one_by_one.tests if one_by_one.row_of(item))
    return [item for item in one_by_one.tests if one_by_one.row_of(item) == one_by_one.row_of(first)]


@pytest.mark.parametrize("order", ["forwards", "backwards"])
def test_a_row_is_judged_as_in_one_run(judged, order):
    """In whichever order its tests are asked for, each has the verdict of a run of the whole row, which is run once."""
    asked = job(NTS)
    row = row_of_three(OneByOne(asked))
    judged.failing = (row[0].test.id,)
    profile = row[0].profile
    together = run_rows(profile, [item.test for item in row], lambda test: run.run_test(profile, test))
    whole = [found.result for _, found in together]
    runs = list(judged)
    judged.clear()
    one_by_one = OneByOne(asked)
    found = {item.key: one_by_one.results(item) for item in (row if order == "forwards" else row[::-1])}
    assert [result for item in row for result in found[item.key]] == whole
    assert judged == runs
    (first,) = found[row[0].key]
    assert first.status is not Status.FAIL or len(found[row[-1].key]) == 1  # let off by further runs, or no such chance
    assert found[row[-1].key][-1].checks[-1].check == "repeated_runs"


def test_each_result_is_held_against_the_baseline(judged, tmp_path):
    """A failure that the file knows says so, and why it is lived with; any other is what it was."""
    judged.failing = ("VD3-full-1", "VD3-full-2")
    known = Entry(Key("iec61400-21.VD3-full-1", "ride_through"), Status.FAIL, reason="a wish")
    (tmp_path / "baseline").write_text(written(Baseline({known.key: known})), "utf-8")
    one_by_one = OneByOne(job("iec61400-21", tests=("VD3-full-*",), baseline=str(tmp_path / "baseline")))
    found = {item.test.id: one_by_one.results(item)[0].checks[0] for item in one_by_one.tests}
    assert (found["VD3-full-1"].known, found["VD3-full-1"].known_reason) == (True, "a wish")
    assert not found["VD3-full-2"].known


def test_a_test_that_is_judged_alone_is_run_alone(judged):
    """Where no rule speaks of its row, nothing else is run; asked for again, it is not run again."""
    one_by_one = OneByOne(job("iec61400-21"))
    item = next(item for item in one_by_one.tests if item.test.id == "VD3-full-2")
    assert one_by_one.row_of(item) == ""
    assert one_by_one.results(item) == one_by_one.results(item)
    assert judged == ["VD3-full-2"]


def test_a_record_is_made_once_for_tests_that_share_it(monkeypatch):
    """Tests of two profiles with one scenario stand one after the other, and it is simulated once."""
    seen = []
    monkeypatch.setattr(simulation, "simulate", lambda scenario, _: seen.append(scenario) or scenario)
    monkeypatch.setattr(
        run, "run_test", lambda _p, test, parameters, simulator: Judged(_found(test, simulator, parameters), None)
    )
    one_by_one = OneByOne(job("iec61400-21", "spain-q-curve", sag=0.5))
    for item in one_by_one.tests:
        one_by_one.results(item)
    assert len(one_by_one.tests) == 2
    assert len(seen) == 1


def _found(test, simulator, parameters):
    simulator(test.scenario, parameters)
    return TestResult(id=test.id, status=Status.PASS)


def test_a_run_that_ends_early_stops_the_controller(monkeypatch):
    """The controller is stopped, and the next test opens one anew."""
    opened, stopped = [], []

    class Controller:
        def __init__(self):
            opened.append(self)

        def stop(self):
            stopped.append(self)

        def __call__(self, scenario, _):
            if len(opened) == 1:
                raise KeyboardInterrupt
            return scenario

    monkeypatch.setattr("pvlvrt_compliance.study.one_by_one.open_controller", lambda _: Controller())
    monkeypatch.setattr(
        run, "run_test", lambda _p, test, parameters, simulator: Judged(_found(test, simulator, parameters), None)
    )
    one_by_one = OneByOne(job("iec61400-21", sag=0.5))
    with pytest.raises(KeyboardInterrupt):
        one_by_one.results(one_by_one.tests[0])
    assert stopped == opened
    assert len(one_by_one.results(one_by_one.tests[0])) == 1
    assert len(opened) == 2
