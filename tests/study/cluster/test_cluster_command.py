"""`--cluster` through the command: on workers that it starts, ended in the middle, without anybody to run it."""

import signal
import socket
import subprocess
import sys
import threading
from contextlib import closing
from pathlib import Path

import pytest
from clusters import cluster

from consoles import surroundings
from pvlvrt_compliance.controllers.process.family import FORKS, descendants
from pvlvrt_compliance.errors import LostError, UsageError
from pvlvrt_compliance.study.executors.cluster.connecting import connected
from pvlvrt_compliance.study.executors.cluster.executor import Cluster
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.named import Named
from pvlvrt_compliance.study.session import session
from pvlvrt_compliance.study.work import Work
from waiting import PATIENCE_S, wait_until

FEW = ("--profile", "iec61400-21", "--test", "paper-*")


@pytest.fixture
def start(tmp_path):
    """Start the command in a folder: ``start(folder, *arguments) -> process``."""
    processes = []

    def start(folder, *arguments):
        folder.mkdir(exist_ok=True)
        processes.append(
            subprocess.Popen(
                [sys.executable, "-m", "pvlvrt_compliance", *arguments, "--output", "out"],
                cwd=folder,
                env=surroundings({"SOURCE_DATE_EPOCH": "1700000000", "TMPDIR": str(tmp_path)}),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
        )
        return processes[-1]

    yield start
    for process in processes:
        process.kill()
        process.communicate()


@pytest.mark.slow
def test_on_workers_that_the_command_starts(start, tmp_path):
    """Status, words and files are those of one process, and no worker is left, nor anything that it wrote."""
    ends, files = [], []
    for name, how in (("here", ("--jobs", "1")), ("there", ("--cluster", "local", "--jobs", "2"))):
        process = start(tmp_path / name, *FEW, *how)
        out, err = process.communicate(timeout=PATIENCE_S)
        ends.append((process.returncode, out, err))
        found = (path for path in (tmp_path / name / "out").rglob("*") if path.is_file())
        files.append({path.name: path.read_bytes() for path in found})
    assert ends[0] == ends[1]
    assert [name for name in files[0] if files[0][name] != files[1].get(name)] == []
    assert files[0].keys() == files[1].keys()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["here", "there"]


@pytest.mark.slow
@pytest.mark.skipif(not FORKS or not Path("/proc/self/stat").exists(), reason="looks at processes as Linux has them")
def test_what_is_finished_is_kept(start, tmp_path):
    """Ctrl-C ends scheduler and workers, and keeps what has come from them."""
    process = start(tmp_path, "--profile", "iec61400-21", "--cluster", "local", "--jobs", "1")
    wait_until(lambda: len(list(tmp_path.glob("out/.*/waveforms/*.dat"))) >= 2, "two records, of which one is finished")
    others = descendants(process.pid)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=PATIENCE_S)
    assert (process.returncode, out) == (130, "")
    assert "of 27 tests were finished and are kept in out/interrupted" in err
    assert len(err.splitlines()) == 1
    assert list(tmp_path.glob("out/interrupted/waveforms/*.dat"))
    assert others
    wait_until(lambda: not any(is_alive(other.pid) for other in others), "the end of all processes")


def is_alive(pid):
    """Whether a process runs: one that nobody has asked about since its end does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.slow
def test_without_workers_the_run_ends(tmp_path):
    """All of them killed, and none to come: it ends when dask's settings have waited, after what was finished."""
    dask = pytest.importorskip("dask")
    job = make_job(Asked(profiles=["iec61400-21"], tests=["paper-*"]))
    work, finished = Work(job=job, each=Named("cluster_makings:waits", {"at": "paper-three-phase-90"})), []

    def run(alone):
        for tested in session(work, executor=Cluster(alone.address)):
            finished.append(tested.result.id)
            dask.config.set({"distributed.scheduler.no-workers-timeout": "1s"})
            for worker in alone.workers:
                worker.kill()

    with cluster(tmp_path) as alone, dask.config.set({"distributed.scheduler.no-workers-timeout": "100s"}):
        alone.have(1)
        with pytest.raises(LostError, match=r"^cluster tcp://[\d.:]+: all workers are gone$"):
            run(alone)
    assert finished


def answering(says):
    """A server that takes connections and says something, or nothing, to each; None: a closed port. No scheduler."""
    server = socket.create_server(("127.0.0.1", 0))

    def serve():
        kept = []
        while True:
            try:
                client, _ = server.accept()
            except OSError:
                return
            kept.append(client)
            if says:
                client.sendall(says)

    if says is not None:  # while one waits for a connection, the port is open, whoever closes it
        threading.Thread(target=serve, daemon=True).start()
    return server


@pytest.mark.parametrize(
    ("says", "words"),
    [
        (None, "nothing answers within 1 s"),
        (b"", "nothing answers within 1 s"),
        (b"HTTP/1.1 400 Bad Request\r\n\r\n" + b"x" * 100, "what answers there is no scheduler but something else"),
    ],
)
def test_what_is_no_scheduler_is_named(says, words):
    """A closed port, a program that waits for a question, one that speaks otherwise: a line with the address, soon."""
    dask = pytest.importorskip("dask")
    server = answering(says)
    address = "{}:{}".format(*server.getsockname())
    if says is None:
        server.close()
    within = dask.config.set({"distributed.comm.timeouts.connect": "1s"})
    with closing(server), within, pytest.raises(UsageError) as refusal, connected(f"tcp://{address}", 1):
        pass
    said = f"cluster tcp://{address}: no scheduler can be reached there: {words}"
    assert str(refusal.value) == said


def test_a_worker_is_no_scheduler(running):
    """The other address that one may have at hand: it says what it is."""
    from distributed import Client

    running.have(1)
    with Client(running.address) as client:
        client.wait_for_workers(1)
        (address, *_) = client.scheduler_info()["workers"]
    with pytest.raises(UsageError, match="what answers there is no scheduler but Worker"), connected(address, 1):
        pass
