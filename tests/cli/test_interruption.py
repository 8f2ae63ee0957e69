"""A run that a signal ends early, as a program, leaves the reports of the last whole run as they were."""

import os
import signal
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from old_report import OLD, with_old_report
from pvlvrt_compliance.cli import main
from pvlvrt_compliance.controllers.process.family import FORKS, descendants
from pvlvrt_compliance.errors import Stopped
from waiting import PATIENCE_S, wait_until

PROGRAM = (sys.executable, "-m", "pvlvrt_compliance.cli.main")
MAIN = ("--profile", "iec61400-21", "--sag", "90%")


@pytest.fixture
def folder(tmp_path):
    """Output folder with the report of a run before."""
    return with_old_report(tmp_path / "out")


POSIX = pytest.mark.skipif(os.name == "nt", reason="Windows cannot send a signal to one process")
ENDS = pytest.mark.parametrize(
    ("number", "status", "word"),
    [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated (SIGTERM)")],
    ids=["SIGINT", "SIGTERM"],
)


@pytest.fixture
def paused(tmp_path):
    """Start the command and wait until it says `here`, see `paused.py`: ``paused(place, *arguments) -> process``."""
    processes = []

    def start(place, *arguments):
        # A temporary folder of its own, to see what is left in it.
        (tmp_path / "tmp").mkdir(exist_ok=True)
        process = subprocess.Popen(
            [sys.executable, Path(__file__).with_name("paused.py"), place, *map(str, arguments)],
            env=os.environ | {"TMPDIR": str(tmp_path / "tmp")},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )
        processes.append(process)
        assert process.stdout.readline() == b"here\n", process.communicate(timeout=PATIENCE_S)
        return process

    yield start
    for process in processes:
        process.kill()
        process.communicate()


def ended(process):
    """Status, output and errors of a process that has been told to end."""
    out, err = process.communicate(timeout=PATIENCE_S)
    return process.returncode, out.decode(), err.decode()


@POSIX
@ENDS
def test_interrupted_in_the_middle(paused, reports, folder, tmp_path, number, status, word):
    """The old report is whole, finished tests are kept apart, and nothing half-written is left."""
    process = paused("4", "--profile", "iec61400-21", "--output", folder)
    process.send_signal(number)
    place = folder / "interrupted"
    assert ended(process) == (status, "", f"{word}; 3 of 27 tests were finished and are kept in {place}\n")
    assert (folder / "report.html").read_text("utf-8") == OLD
    assert sorted(p.name for p in folder.iterdir()) == ["interrupted", "report.html"]
    kept = reports(place)
    assert len(kept.verdicts) == 3
    for test in kept.json["tests"]:
        assert (kept.folder / test["waveforms"]).stat().st_size > 0
    records = {f"waveforms/{name}.{e}" for name in kept.verdicts for e in ("cfg", "dat")}
    assert kept.files == {"results.json", "junit.xml"} | records
    assert list((tmp_path / "tmp").iterdir()) == []


@POSIX
def test_a_job_that_was_ended_shows_why_it_is_red(paused, folder, tmp_path, monkeypatch):
    """What a CI service looks at is of what was finished, and red: files, annotations, the summary of the step."""
    summary = tmp_path / "summary.md"
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(summary))
    formats = [word for name in ("github", "gitlab", "html", "pdf") for word in ("--format", name)]
    process = paused("2", "--profile", "iec61400-21", "--waveforms", "none", *formats, "--output", folder)
    process.send_signal(signal.SIGTERM)
    status, out, _ = ended(process)
    assert status == 143
    said = "the run was interrupted: 1 of 27 tests were finished"
    *_, last = [line for line in out.splitlines() if line.startswith("::error")]
    assert last.startswith(f"::error title=Grid code::{said}; ")
    place = folder / "interrupted"
    assert {path.name for path in place.iterdir()} == {
        "results.json",
        "junit.xml",
        "github-summary.md",
        "gl-code-quality-report.json",
    }
    assert said in summary.read_text("utf-8")
    case = ET.parse(place / "junit.xml").find(".//testcase[@classname='run'][@name='finished']")
    assert case.find("error").get("message") == said


@POSIX
@ENDS
def test_interrupted_inside_the_compiled_loop(paused, folder, number, status, word):
    """Compiled code hears no signal: the command ends without waiting for it."""
    process = paused("compiled", *MAIN[:2], "--sag", "10%", "--duration", "3600s", "--output", folder)
    process.send_signal(number)
    assert ended(process) == (status, "", f"{word}; 0 of 1 tests were finished, nothing was written\n")
    assert [p.name for p in folder.iterdir()] == ["report.html"]


@POSIX
@ENDS
def test_interrupted_while_a_lock_is_taken(paused, folder, number, status, word):
    """Python's own error about that lock, which replaces the signal, is no error of the program."""
    process = paused("lock", *MAIN, "--output", folder)
    process.send_signal(number)
    assert ended(process) == (status, "", f"{word}; 0 of 1 tests were finished, nothing was written\n")


@POSIX
@pytest.mark.parametrize("command", [("profiles", "list"), ("--version",)])
def test_an_error_that_a_signal_leaves_behind_is_no_crash(command, monkeypatch, capsys):
    """Wherever it comes, and whatever has replaced it."""

    def flushed(*_):
        try:
            raise Stopped(signal.SIGTERM)
        finally:
            raise RuntimeError("release unlocked lock")

    left = []
    monkeypatch.setattr(main, "flushed", flushed)
    monkeypatch.setattr(main, "become_the_command", lambda: None)
    monkeypatch.setattr(main, "leave", left.append)
    monkeypatch.setattr(sys, "argv", ["pvlvrt-check", *command])
    main.main()
    assert left == [143]
    assert "Traceback" not in capsys.readouterr().err


@POSIX
@pytest.mark.slow
def test_interrupted_while_processes_run_tests(reports, folder):
    """They are gone with the command, which keeps what any of them has finished."""
    words = (*PROGRAM, "--profile", "iec61400-21", "--jobs", "2", "--output", folder)
    process = subprocess.Popen(words, stderr=subprocess.PIPE, stdout=subprocess.PIPE)
    # Two of the three may be written while their tests are still to be finished.
    wait_until(lambda: len(list(folder.glob(".unfinished-*/waveforms/*.cfg"))) >= 3, "three records")
    workers = descendants(process.pid)
    process.send_signal(signal.SIGINT)
    status, out, err = ended(process)
    assert (status, out) == (130, "")
    assert "of 27 tests were finished and are kept in" in err
    assert len(workers) == (2 if FORKS else 0)
    assert not [worker for worker in workers if Path(f"/proc/{worker.pid}").exists()]
    kept = reports(folder / "interrupted")
    names = [Path(test["waveforms"]).stem for test in kept.json["tests"]]
    assert names
    records = {f"waveforms/{name}.{e}" for name in names for e in ("cfg", "dat")}
    assert kept.files == {"results.json", "junit.xml"} | records
    assert not list(folder.glob(".unfinished*"))


@POSIX
def test_a_second_signal_changes_nothing(paused, reports, folder):
    """While finished tests are put in place, another signal is of no account."""
    process = paused("twice", "--profile", "iec61400-21", "--output", folder)
    process.terminate()
    status, _, err = ended(process)
    assert (status, "2 of 27 tests were finished and are kept in" in err) == (143, True)
    assert len(reports(folder / "interrupted").verdicts) == 2
    assert sorted(p.name for p in folder.iterdir()) == ["interrupted", "report.html"]


@POSIX
def test_a_third_signal_ends_at_once(command, paused, folder):
    """Whatever it is at, the command ends; what it leaves, the next run into the folder clears away."""
    process = paused("thrice", "--profile", "iec61400-21", "--output", folder)
    process.terminate()
    assert ended(process) == (143, "", "")
    assert (folder / "report.html").read_text("utf-8") == OLD
    assert len(list(folder.glob(".unfinished-*"))) == 1
    assert command(*MAIN, "--output", folder).status == 0
    assert not list(folder.glob(".unfinished*"))


@POSIX
def test_what_killed_runs_leave_is_cleared_away(command, paused, folder):
    """A run that is killed can clear nothing away; the next one does, and only that."""
    for _ in range(2):
        process = paused("3", "--profile", "iec61400-21", "--output", folder)
        assert len(list(folder.glob(".unfinished-*/waveforms/*.dat"))) == 2
        assert len(list(folder.glob(".unfinished-*"))) == 1
        process.kill()
        ended(process)
    assert command(*MAIN, "--output", folder).status == 0
    assert sorted(p.name for p in folder.iterdir()) == ["junit.xml", "report.html", "results.json", "waveforms"]


@POSIX
def test_two_runs_into_one_folder(command, paused, reports, folder):
    """The second is refused before it simulates anything; the first is not disturbed."""
    process = paused("3", "--profile", "iec61400-21", "--output", folder)
    refused = command(*MAIN, "--output", folder)
    assert refused == (
        2,
        "",
        f"pvlvrt-check: --output {folder}: another run (process {process.pid}) is writing there;"
        " wait for its end, or name another folder\n",
    )
    process.terminate()
    assert ended(process)[0] == 143
    assert len(reports(folder / "interrupted").verdicts) == 2
    assert command(*MAIN, "--output", folder).status == 0
