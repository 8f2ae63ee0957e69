"""A record goes when its test is finished, and not when somebody looks for circles of references."""

import gc
import weakref

import pytest

from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.study.executors.units import run_unit, units_of
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.one_by_one import OneByOne
from pvlvrt_compliance.study.work import Work


@pytest.fixture
def no_collection():
    """References alone decide what goes."""
    gc.collect()
    gc.disable()
    yield
    gc.enable()


@pytest.mark.usefixtures("no_collection")
@pytest.mark.parametrize(
    ("profile", "test"),
    [
        ("iec61400-21", "VD1-full-1"),
        ("es-nts-631-lt110kv", "U5TPmax-1"),
        ("es-po-12.3", "PVVC-1-1"),
        ("ieee1547-cat-iii", "rocof-up"),
        ("rey-boue-500kva", "fig09-50hz"),
    ],
)
def test_a_record_goes_with_its_test(profile, test):
    """Whatever checks, figures and errors refer to, nothing of the record is there when the result is."""
    job = make_job(Asked(profiles=(profile,), tests=(test,)))
    (unit,) = units_of(job.tests[:1])
    channels = []

    def simulated(scenario, parameters):
        record = simulate(scenario, parameters)
        channels[:] = [weakref.ref(segment["u_a_v"]) for segment in record]
        return record

    for _ in range(2):  # what is compiled the first time refers to whatever it is compiled for
        (tested,) = run_unit(Work(job=job), unit, simulated, lambda _item: None)
    assert tested.result.checks
    assert channels
    assert not [channel for channel in channels if channel() is not None]


@pytest.mark.usefixtures("no_collection")
def test_a_record_goes_where_tests_are_run_one_by_one(monkeypatch):
    """What a program asks for test by test holds no more than the record of the last one."""
    channels = []

    def simulated(scenario, parameters):
        record = simulate(scenario, parameters)
        channels.append(weakref.ref(record.segments[0]["u_a_v"]))
        return record

    monkeypatch.setattr("pvlvrt_compliance.simulation.simulate.simulate", simulated)
    tests = OneByOne(make_job(Asked(profiles=("iec61400-21",), tests=("VD1-full-*", "VD3-full-1"))))
    for item in tests.tests:
        assert tests.results(item)
    assert len(channels) == 3
    assert [channel() is None for channel in channels] == [True, True, False]
