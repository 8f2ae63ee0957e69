"""`--settle-once`: the same files, byte by byte, or a word on why not."""

from pathlib import Path

import pytest
from stateful_fmu import made

pytestmark = pytest.mark.slow

FOLDER = Path(__file__).parents[1] / "controllers"
RUN = ("--profile", "iec61400-21", "--test", "VD[46]-full-*", "-q", "--waveforms", "all", "--csv")


@pytest.fixture
def files(program, tmp_path):
    """Run the command as a program in a folder of its own: ``files(*arguments) -> (how it ended, its files)``."""
    runs = iter(range(10))

    def files(*arguments):
        (folder := tmp_path / str(next(runs))).mkdir()
        ended = program(*RUN, *arguments, cwd=folder, SOURCE_DATE_EPOCH="1700000000")
        return ended, {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}

    return files


def test_every_byte_is_that_of_a_run_without(files):
    """Verdicts, waveforms, figures and the command that makes the run again; on one core and on two."""
    whole, its_files = files("--jobs", "1")
    for jobs in ("1", "2"):
        once, same_files = files("--settle-once", "--jobs", jobs)
        assert (once.status, once.out) == (whole.status, whole.out)
        assert same_files == its_files
        assert "4 scenarios start from 2 settled states, each to be simulated once" in once.err
    assert len(its_files) > 6


def test_a_controller_of_ones_own_goes_on(files):
    """The same of a class in Python."""
    given = ("--controller", FOLDER / "remembering.py:Remembering", "--jobs", "1")
    (whole, its_files), (once, same_files) = files(*given), files(*given, "--settle-once")
    assert once.status == whole.status
    assert same_files == its_files
    assert "not settled once" not in once.err


@pytest.mark.compiler
def test_an_fmu_goes_on_in_two_processes(files, tmp_path):
    """The same of one that serialises its state."""
    given = ("--controller", made(tmp_path / "it", 3), "--jobs", "2")
    (whole, its_files), (once, same_files) = files(*given), files(*given, "--settle-once")
    assert once.status == whole.status
    assert same_files == its_files
    assert "not settled once" not in once.err


def test_one_that_cannot_is_said(files):
    """What is remembered in a module is not found: the verdicts are those of whole runs, with a note."""
    given = ("--controller", FOLDER / "remembering.py:InItsModule", "--jobs", "1", "--waveforms", "none")
    (whole, _), (once, its_files) = files(*given), files(*given, "--settle-once")
    assert (once.status, once.out) == (whole.status, whole.out)
    assert "not settled once, each test settles for itself: what it remembers is not all" in once.err
    assert b"not settled once" in its_files[Path("pvlvrt-report/results.json")]


def test_it_does_not_go_with_a_scheduler(program, tmp_path):
    """A settled state stays where it is."""
    ended = program("--profile", "iec61400-21", "--settle-once", "--cluster", "local", cwd=tmp_path)
    assert ended.status == 2
    assert (
        "--settle-once: a settled state stays with the process that has it; it does not go with --cluster" in ended.err
    )


def test_where_no_two_tests_start_alike_it_is_said(program, tmp_path):
    """A sag of one's own is one test."""
    ended = program("--profile", "iec61400-21", "--sag", "90%", "--settle-once", "--waveforms", "none", cwd=tmp_path)
    assert ended.status == 0
    assert "no two tests start from the same settled state: each settles for itself" in ended.err
