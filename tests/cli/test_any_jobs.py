"""However a run is made, its folder is the same."""

import pytest

from pvlvrt_compliance.study.executors import choosing
from pvlvrt_compliance.study.executors.processes import Processes

pytestmark = pytest.mark.slow

RUN = ("--profile", "iec61400-21", "--test", "VD[46]-full-*", "-q")


@pytest.fixture
def both(command, tmp_path, monkeypatch):
    """Run the command on one core, then in two processes: ``both(*arguments) -> how each ended, and its files``."""
    counts = []

    def processes(count, controller):
        counts.append(count)
        return Processes(count, controller)

    monkeypatch.setattr(choosing, "_why_here", lambda *_: "")
    monkeypatch.setattr(choosing, "Processes", processes)

    def both(*arguments):
        found = []
        for jobs in ("1", "2"):
            (folder := tmp_path / jobs).mkdir()
            monkeypatch.chdir(folder)
            ended = command(*RUN, *arguments, "--jobs", jobs, SOURCE_DATE_EPOCH="1700000000")
            files = {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
            found.append((ended, files))
        assert counts == [2]
        return found

    return both


def test_every_byte_is_that_of_one_core(both):
    """Two processes write what one core writes, and say the same."""
    one, two = both("--csv", "--format", "markdown", "--format", "pdf")
    assert one == two
    assert len(one[1]) > 4


def test_what_is_known_is_said_of_each(both, tmp_path):
    """Marks of a baseline come once all tests are judged: they are in the reports, whatever was made before."""
    known = tmp_path / "known.txt"
    known.write_text("# pvlvrt-baseline 1\niec61400-21.VD4-full-1 current_limit fail -0.07 pu # ticket 42\n", "utf-8")
    one, two = both("--waveforms", "none", "--baseline", known)
    assert one == two
    (page,) = (content.decode() for path, content in two[1].items() if path.name == "report.html")
    assert page.count("ticket 42") > 2


def test_the_first_failure_is_that_of_one_core(both):
    """Whatever the other process has finished meanwhile is no part of the run."""
    one, two = both("--waveforms", "none", "--fail-fast")
    assert one == two
    assert one[0].status == 1
