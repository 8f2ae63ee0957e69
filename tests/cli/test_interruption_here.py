"""A run that ends early in this process, where it was begun: by Ctrl-C or a crash."""

import os

import pytest

from old_report import OLD, with_old_report
from pvlvrt_compliance.report.formats import html
from pvlvrt_compliance.study.store import OutputFolder

MAIN = ("--profile", "iec61400-21", "--sag", "90%")


@pytest.fixture
def folder(tmp_path):
    """Output folder with the report of a run before."""
    return with_old_report(tmp_path / "out")


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


@pytest.mark.skipif(os.name == "nt", reason="names are text in Windows")
def test_last_words_spell_a_name_that_is_no_text(command, interrupt_at, tmp_path):
    """The line that says where finished tests are kept spells the bytes as all others do."""
    interrupt_at(2)
    ended = command("--profile", "iec61400-21", "--test", "VD3*", "--output", tmp_path / "\udcff")
    assert ended.err.endswith(f"are kept in {tmp_path}/\\xff/interrupted\n")


def test_interrupted_twice(command, reports, interrupt_at, folder):
    """What is kept is that of the last interrupted run."""
    for n in (3, 2):
        interrupt_at(n)
        ended = command("--profile", "iec61400-21", "--test", "VD3*", "--output", folder)
        assert ended.status == 130
        assert len(reports(folder / "interrupted").verdicts) == n - 1
    assert (folder / "report.html").read_text("utf-8") == OLD


def test_interrupted_while_finished_tests_are_kept(command, monkeypatch, folder):
    """After an error, too, nothing stays of a run that is stopped before it could keep anything."""

    def fail(*_arguments):
        raise OSError(28, "No space left on device")

    def stop(_output, _records):
        raise KeyboardInterrupt

    monkeypatch.setattr(html, "render", fail)
    monkeypatch.setattr(OutputFolder, "drop_all_but", stop)
    assert command(*MAIN, "--output", folder).status == 130
    assert [p.name for p in folder.iterdir()] == ["report.html"]


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
    assert not list(folder.glob(".unfinished*"))
