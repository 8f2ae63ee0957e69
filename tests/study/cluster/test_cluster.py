"""A job on the workers of a scheduler: its results are those of one process, whatever happens to workers."""

import re
import shutil
from functools import partial
from pathlib import Path

import pytest
from clusters import ROOT, cluster

import pvlvrt_compliance
from evil import EVIL
from pvlvrt_compliance.controllers.process.family import FORKS
from pvlvrt_compliance.errors import LostError, UsageError
from pvlvrt_compliance.study.executors.cluster.executor import Cluster
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.named import Named
from pvlvrt_compliance.study.opening import open_controller
from pvlvrt_compliance.study.session import session
from pvlvrt_compliance.study.work import Work

PROFILE, TESTS = "iec61400-21", ("paper-*",)
KILLED, OTHERS = "paper-phase-c-50", ["paper-phase-c-90", "paper-three-phase-90"]
LAST = "paper-three-phase-90"  # the shortest: what takes longest is begun first


@pytest.fixture(scope="module")
def job():
    """Three short tests."""
    return make_job(Asked(profiles=[PROFILE], tests=TESTS))


@pytest.fixture(scope="module")
def expected(job):
    """What one process finds."""
    return {tested.result.id: _timeless(tested.result) for tested in session(Work(job=job))}


@pytest.fixture
def marks(tmp_path):
    """A folder in which makings leave files."""
    (tmp_path / "marks").mkdir()
    return tmp_path / "marks"


@pytest.fixture
def certificates(tmp_path):
    """Certificates of one's own, as options of dask's commands; dask's settings name them for the client."""
    dask, security = pytest.importorskip("dask"), pytest.importorskip("distributed.security")
    pytest.importorskip("cryptography", reason="makes certificates")
    made = security.Security.temporary()
    certificate, key = tmp_path / "certificate.pem", tmp_path / "key.pem"
    certificate.write_text(made.tls_client_cert)
    key.write_text(made.tls_client_key)
    files = {"cert": str(certificate), "key": str(key)}
    with dask.config.set({"distributed.comm.tls.ca-file": str(certificate), "distributed.comm.tls.client": files}):
        yield "--tls-ca-file", str(certificate), "--tls-cert", str(certificate), "--tls-key", str(key)


def _timeless(result):
    return result.model_copy(update={"wall_time_s": 0.0})


def _dying(job, marks, times):
    making = Named("cluster_makings:dies", {"at": KILLED, "marks": str(marks), "times": times})
    return Work(job=job, each=making)


def test_a_killed_worker_costs_a_repetition(running, job, expected, marks):
    """Of three workers one is killed in the middle of a test: all verdicts are there, those of one process."""
    running.have(3)
    told = []
    found = list(session(_dying(job, marks, 1), executor=Cluster(running.address, tell=told.append)))
    assert {tested.result.id: _timeless(tested.result) for tested in found} == expected
    assert sorted(tested.made for tested in found) == sorted(expected)
    assert len(list(marks.iterdir())) == 1
    assert len(told) == 1
    assert re.fullmatch(r"worker tcp://[\d.:]+ is gone; what it had is run again", told[0])


def test_a_test_that_kills_its_workers_is_an_error(running, job, expected, marks):
    """It is given up after one repetition, with the reason; the others are judged."""
    running.have(3)
    found = list(session(_dying(job, marks, 9), executor=Cluster(running.address)))
    results = {tested.result.id: _timeless(tested.result) for tested in found}
    assert {name: results[name] for name in OTHERS} == {name: expected[name] for name in OTHERS}
    message = results[KILLED].checks[0].message
    assert results[KILLED].status == "error"
    assert re.fullmatch(r"given up after two tries: (worker tcp://[\d.:]+ was lost while it was run(; |$)){2}", message)
    assert len(list(marks.iterdir())) == 2


@pytest.mark.skipif(not FORKS, reason="only Linux holds a controller to all of its limits")
@pytest.mark.parametrize("name", ["forges an answer, python", "stops its parent, python", "eats memory, python"])
def test_a_controller_that_does_harm_costs_its_own_test(running, name, tmp_path):
    """On the worker, too, within the limits of the job; nothing of its process comes here as an object."""
    running.have(1)
    evil, tests = EVIL[name], ("VD1-full-1", "VD3-full-1")
    asked = Asked(profiles=[PROFILE], tests=tests, controller=evil.build(tmp_path), settings=evil.settings)
    job = make_job(asked)
    controller = open_controller(job)
    there = Cluster(running.address, controller=controller)
    found = {t.result.id: t.result for t in session(Work(job=job), controller=controller, executor=there)}
    assert {name for name in tests if found[name].status == "error"} == {"VD3-full-1"}
    assert evil.expected in found["VD3-full-1"].checks[0].message


def test_a_worker_of_another_version_is_refused(job, tmp_path):
    """It runs nothing, and the reason names it, what it has and what is needed; without another the run ends."""
    other = shutil.copytree(ROOT / "pvlvrt_compliance", tmp_path / "pvlvrt_compliance", ignore=_no_bytecode)
    for shared in ("profiles", "reports"):
        shutil.copytree(ROOT / shared, tmp_path / shared)
    (other / "units.py").write_text((other / "units.py").read_text("utf-8") + "\n# another\n", "utf-8")
    with cluster(tmp_path) as alone:
        alone.have(1, [tmp_path])
        with pytest.raises(UsageError) as refusal:
            list(session(Work(job=job), executor=Cluster(alone.address)))
    said = r"cluster tcp://[\d.:]+: no worker can be used: worker tcp://[\d.:]+: digest of pvlvrt-compliance's files "
    assert re.fullmatch(said + "[0-9a-f]{12} where [0-9a-f]{12} is needed", str(refusal.value))


def test_the_files_of_a_run_are_the_same(running, tmp_path, monkeypatch):
    """Report, figures, records and all: byte for byte what one process writes where time is fixed."""
    running.have(2)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    run = partial(pvlvrt_compliance.check, PROFILE, tests=TESTS)
    run(output=tmp_path / "here")
    run(output=tmp_path / "there", cluster=running.address)
    assert _files(tmp_path / "there") == _files(tmp_path / "here")


def test_a_lost_scheduler_leaves_what_is_finished(job, expected, tmp_path, certificates):
    """The run ends with an error that says so, after the tests that were finished; so over TLS, too."""
    making = Named("cluster_makings:waits", {"at": LAST})
    finished = []

    def run(alone):
        for tested in session(Work(job=job, each=making), executor=Cluster(alone.address)):
            finished.append(tested.result)
            alone.scheduler.kill()

    with cluster(tmp_path, certificates) as alone:
        alone.have(1)
        with pytest.raises(LostError, match=r"^cluster tls://[\d.:]+: the scheduler is gone$"):
            run(alone)
    assert 0 < len(finished) < len(expected)
    assert all(_timeless(result) == expected[result.id] for result in finished)


def test_a_scheduler_over_tls_needs_certificates(job):
    """Without any in dask's settings the run ends before it begins, with what is missing."""
    with pytest.raises(
        UsageError,
        match=r"^cluster tls://127\.0\.0\.1:1: no scheduler can be reached there: dask's settings name no certificates",
    ):
        list(session(Work(job=job), executor=Cluster("tls://127.0.0.1:1")))


def _no_bytecode(_folder, names):
    return {name for name in names if name == "__pycache__"}


def _files(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
