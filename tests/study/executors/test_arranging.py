"""Units on their way through workers: what is begun when, and in which order tests are handed on."""

import pytest

from pvlvrt_compliance.results import Status, TestResult
from pvlvrt_compliance.study.executors.arranging import Arranged
from pvlvrt_compliance.study.executors.executor import Finished
from pvlvrt_compliance.study.executors.units import cost_s, items_of, units_of
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.work import Work

IEC = "iec61400-21"


def arranged(*profiles, **asked):
    """A job on its way, and its units."""
    job = make_job(Asked(profiles=profiles or (IEC,), **asked))
    units = units_of(job.tests)
    return Arranged(Work(job=job), units), units


def finished(units, number, index=0, status=Status.PASS):
    """A test of a unit, as it comes from a worker."""
    item = items_of(units[number])[index]
    return Finished(number, item.test, TestResult(id=item.test.id, profile=item.profile.id, status=status))


def ids(tests):
    """Ids of what is handed on."""
    return [test.result.id for test in tests]


def begun(arranged):
    """All units in the order in which they are begun."""
    found = []
    while arranged.has_next:
        found.append(arranged.next())
    return found


def test_what_takes_longest_is_begun_first():
    """Every unit is begun once; none costs more than one before it."""
    way, units = arranged("es-nts-631-lt110kv")
    order = begun(way)
    assert sorted(order) == list(range(len(units)))
    costs = [cost_s(units[number]) for number in order]
    assert costs == sorted(costs, reverse=True)
    assert len(set(costs)) > 1


def test_tests_are_handed_on_as_they_come():
    """The job is done when every unit has ended, in whatever order."""
    way, units = arranged(tests=("VD[12]-full-*",))
    assert len(units) == 2
    for number in (1, 0):
        assert not way.is_done
        for index in (0, 1):
            assert ids(way.finished(finished(units, number, index))) == [items_of(units[number])[index].test.id]
        assert not ids(way.ended(number))
    assert way.is_done


def test_where_the_first_failure_ends_the_run_units_keep_their_order():
    """What comes before its turn waits, what lies beyond the end is dropped, and nothing more is begun."""
    way, units = arranged(tests=("VD[1-4]-full-*",), fail_fast=True)
    assert [way.next(), way.next(), way.next()] == [0, 1, 2]
    assert not ids(way.finished(finished(units, 2)))
    assert not ids(way.ended(2))
    assert ids(way.finished(finished(units, 0))) == ["VD1-full-1"]
    assert not ids(way.finished(finished(units, 1, status=Status.FAIL)))
    assert not ids(way.ended(1, is_end=True))
    assert not way.has_next
    assert not way.is_done
    assert ids(way.finished(finished(units, 0, 1))) == ["VD1-full-2"]
    assert ids(way.ended(0)) == ["VD2-full-1"]
    assert way.is_done


def test_a_unit_whose_worker_is_lost_is_repeated_once():
    """Its tests that were handed on are not handed on again; lost again, the others are errors with the reason."""
    way, units = arranged(tests=("VD[12]-full-*",))
    assert [way.next(), way.next(), way.has_next] == [0, 1, False]
    assert ids(way.finished(finished(units, 0))) == ["VD1-full-1"]
    assert not ids(way.lost(0, "killed"))
    assert way.next() == 0
    assert not ids(way.finished(finished(units, 0)))
    (left,) = way.lost(0, "killed again")
    assert (left.unit, left.result.id, left.result.status) == (0, "VD1-full-2", Status.ERROR)
    assert {check.message for check in left.result.checks} == {"killed again"}
    assert not ids(way.ended(1))
    assert way.is_done


def test_a_lost_unit_ends_a_run_that_its_first_failure_ends():
    """An error is no pass: nothing is handed on after it, of its unit neither."""
    way, _ = arranged(tests=("VD[12]-full-*",), fail_fast=True)
    assert way.next() == 0
    assert not ids(way.lost(0, "killed"))
    assert way.next() == 0
    assert ids(way.lost(0, "killed")) == ["VD1-full-1"]
    assert way.is_done


@pytest.mark.parametrize("fail_fast", [False, True])
def test_rows_judged_as_one_are_lost_as_one(fail_fast):
    """Where the verdict is on a row, each of its runs is an error, whatever ends the run."""
    way, units = arranged("es-po-12.3", tests=("PVVC-2-*",), fail_fast=fail_fast)
    assert len(units) == 1
    for _ in range(2):
        number = way.next()
        lost = ids(way.lost(number, "killed"))
    assert lost == ["PVVC-2-1", "PVVC-2-2", "PVVC-2-3"]
    assert way.is_done
