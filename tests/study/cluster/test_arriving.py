"""What comes back of a worker passes here what it has passed there: it is a process of whoever has started it."""

import pickle
import zlib

import pytest

import worst
from pvlvrt_compliance.results import Verdict
from pvlvrt_compliance.study.executors.cluster import worker
from pvlvrt_compliance.study.executors.cluster.dispatch import _as_here
from pvlvrt_compliance.study.executors.cluster.luggage import packed
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.work import Work


@pytest.fixture(scope="module")
def finished():
    """A test as a worker has finished it."""
    assert worker.receive("run", packed(Work(job=make_job(Asked(profiles=["spain-q-curve"], sag="50%"))), None)) == ""
    (found,) = worker.run_unit("run", 0).finished
    worker.forget("run")
    return found


def forged(model, **texts):
    """A model with texts that have passed nowhere, as an object from elsewhere may be."""
    made = pickle.loads(pickle.dumps(model))
    made.__dict__.update(texts)
    return made


def test_an_honest_result_is_as_it_was(finished):
    """Every number and every text."""
    assert _as_here(finished) == finished


def test_texts_of_a_worker_are_shown_and_obeyed_by_nobody(finished):
    """Those of the test, of each verdict, and what its controller is said to have said."""
    verdict = forged(finished.result.checks[0], message=worst.WORST, clause=worst.WORST)
    result = forged(finished.result, title=worst.WORST, checks=(verdict,))
    arrived = _as_here(finished._replace(result=result, notes=(worst.WORST,)))
    worst.data(arrived.result.model_dump(mode="json"))
    worst.data(list(arrived.notes))
    assert worst.MARK in arrived.result.title
    assert worst.MARK in arrived.result.checks[0].message
    assert isinstance(arrived.result.checks[0], Verdict)


@pytest.mark.parametrize(
    "name",
    [
        "waveforms/../../x.dat",
        "../waveforms/x.dat",
        "/x.dat",
        "report.html",
        "waveforms/a/b.dat",
        "waveforms/..",
        "waveforms/a\\b",
    ],
)
def test_a_record_lies_where_records_do(finished, name):
    """What is sent writes no other file."""
    with pytest.raises(ValueError, match="is no name of a record"):
        _as_here(finished._replace(files={name: zlib.compress(b"x")}))


def test_what_is_no_result(finished):
    """A verdict that there is none of, or a record that is not packed, is refused before anything is written."""
    with pytest.raises(ValueError, match="status"):
        _as_here(finished._replace(result=forged(finished.result, status="great")))
    with pytest.raises(zlib.error):
        _as_here(finished._replace(files={"waveforms/x.dat": b"x"}))
