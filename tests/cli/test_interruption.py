"""A run that ends early leaves the reports of the last whole run as they were."""

import os
import signal
import time

import pytest

from pvlvrt_compliance.report import html
from pvlvrt_compliance.study.store import OutputFolder

OLD = "<!doctype html><title>the report of the last whole run</title>"
MAIN = ("--profile", "iec61400-21", "--sag", "90%")


@pytest.fixture
def folder(tmp_path):
    """Output folder with the report of a run before."""
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "report.html").write_text(OLD, "utf-8")
    return folder


def _unfinished(folder):
    return [p.name for p in folder.iterdir() if p.name.startswith(".unfinished-")]


def _wait_for(condition, process):
    end = time.monotonic() + 240
    while not condition():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < end
        time.sleep(0.01)


@pytest.mark.skipif(os.name == "nt", reason="Windows cannot send an interruption to one process")
def test_interrupted_in_the_middle(start_program, reports, folder):
    """Status 130; the old report is whole, finished tests are kept apart, and nothing half-written is left."""
    process = start_program("--profile", "iec61400-21", "--output", folder)
    _wait_for(lambda: len(list(folder.glob(".unfinished-*/waveforms/*.dat"))) >= 3, process)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (130, b"")
    lines = err.decode().splitlines()
    assert len(lines) == 1
    assert lines[0].startswith("interrupted; ")
    assert "of 27 tests were finished and are kept in" in lines[0]
    assert (folder / "report.html").read_text("utf-8") == OLD
    assert sorted(p.name for p in folder.iterdir()) == ["interrupted", "report.html"]
    kept = reports(folder / "interrupted")
    assert 2 <= len(kept.verdicts) < 27
    for test in kept.json["tests"]:
        assert (kept.folder / test["waveforms"]).stat().st_size > 0


@pytest.fixture
def interrupt_at(monkeypatch):
    """Interrupt at the n-th test of a run: ``interrupt_at(n)``."""
    from pvlvrt_compliance.study import run as study_run

    right = study_run.run_test

    def interrupt_at(n):
        seen = []

        def run_test(*arguments):
            seen.append(arguments)
            if len(seen) == n:
                raise KeyboardInterrupt
            return right(*arguments)

        monkeypatch.setattr(study_run, "run_test", run_test)

    return interrupt_at


def test_interrupted_before_the_first_test_is_finished(command, interrupt_at, tmp_path):
    """Status 130, and no trace of the run, not even the folders made for it."""
    interrupt_at(1)
    ended = command(*MAIN, "--output", tmp_path / "deep" / "out")
    assert (ended.status, ended.out) == (130, "")
    assert ended.err == "interrupted; 0 of 1 tests were finished, nothing was written\n"
    assert list(tmp_path.iterdir()) == []


def test_exit_zero_does_not_hide_an_interruption(command, interrupt_at, tmp_path):
    """An interrupted run is not a whole run, whatever was asked for."""
    interrupt_at(1)
    assert command(*MAIN, "--exit-zero", "--output", tmp_path / "out").status == 130


def test_interrupted_twice(command, reports, interrupt_at, folder):
    """What is kept is that of the last interrupted run."""
    for n in (3, 2):
        interrupt_at(n)
        ended = command("--profile", "iec61400-21", "--test", "VD3*", "--output", folder)
        assert ended.status == 130
        assert len(reports(folder / "interrupted").verdicts) == n - 1
    assert (folder / "report.html").read_text("utf-8") == OLD


def test_crash_in_the_middle(command, reports, monkeypatch, folder):
    """An error of the program itself, late in a run, leaves the old report and keeps what was finished apart."""

    def crash(*_arguments):
        raise RuntimeError("a bug")

    monkeypatch.setattr(html, "render", crash)
    with pytest.raises(RuntimeError, match="a bug"):
        command(*MAIN, "--output", folder)
    assert sorted(p.name for p in folder.iterdir()) == ["interrupted", "report.html"]
    assert (folder / "report.html").read_text("utf-8") == OLD
    assert [test["status"] for test in reports(folder / "interrupted").json["tests"]] == ["pass"]


def test_disk_that_is_full(command, monkeypatch, folder):
    """A file that cannot be written is one line and status 2; the old report stays."""

    def full(*_arguments):
        raise OSError(28, "No space left on device", "report.html")

    monkeypatch.setattr(OutputFolder, "write", full)
    ended = command(*MAIN, "--output", folder)
    assert (ended.status, ended.out, ended.err.count("\n")) == (2, "", 1)
    assert "No space left on device" in ended.err
    assert [p.name for p in folder.iterdir()] == ["report.html"]


def test_whole_run_takes_the_place_of_the_old(command, reports, folder):
    """A later run replaces reports and waveforms of the one before; files of others stay."""
    (folder / "waveforms").mkdir(parents=True)
    (folder / "waveforms" / "others.dat").write_text("mine", "utf-8")
    (folder / "notes.txt").write_text("mine", "utf-8")
    assert command("--profile", "iec61400-21", "--sag", "0%", "--csv", "--output", folder).status == 0
    assert {"waveforms/sag-0pct-abc.csv", "waveforms/sag-0pct-abc.dat"} <= set(reports(folder).files)
    assert command(*MAIN, "--output", folder).status == 0
    found = reports(folder)
    assert found.page.get_element_by_id("verdict").get("data-status") == "pass"
    assert {"notes.txt", "waveforms/others.dat"} <= set(found.files)
    assert not [name for name in found.files if "sag-0pct" in name]
    assert _unfinished(folder) == []
