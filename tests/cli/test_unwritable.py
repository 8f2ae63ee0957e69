"""What cannot be written is status 3 and one true line: where it was to go, and what has been written all the same."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

MAIN = ("--profile", "iec61400-21", "--sag", "90%")
OLD = "<!doctype html><title>the report of the last whole run</title>"
FULL = Path("/dev/full")
POSIX = pytest.mark.skipif(os.name == "nt", reason="Windows has neither limits of this kind nor /dev/full")


@pytest.fixture
def folder(tmp_path):
    """Output folder with the report of a run before."""
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "report.html").write_text(OLD, "utf-8")
    return folder


def _limited(size, *arguments):
    program = [sys.executable, Path(__file__).with_name("limited.py"), str(size), *map(str, arguments)]
    # What counts the lines that are run writes files of its own.
    environment = {name: value for name, value in os.environ.items() if not name.startswith("COVERAGE_")}
    done = subprocess.run(program, env=environment, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


@POSIX
def test_no_room_for_a_record(folder):
    """Nothing was finished, and nothing is left."""
    assert _limited(10_000, *MAIN, "--output", folder) == (
        3,
        "",
        f"pvlvrt-check: {folder}/waveforms/sag-90pct-abc.dat cannot be written: File too large;"
        " 0 of 1 tests were finished, nothing was written\n",
    )
    assert [p.name for p in folder.iterdir()] == ["report.html"]


@POSIX
@pytest.mark.slow
def test_no_room_for_a_record_of_another_process(folder):
    """What a process that runs tests cannot write ends the run as it would here, in the same words."""
    status, out, err = _limited(10_000, "--profile", "iec61400-21", "--jobs", "2", "--output", folder)
    said = "cannot be written: File too large; 0 of 27 tests were finished, nothing was written"
    assert (status, out) == (3, "")
    assert re.fullmatch(rf"pvlvrt-check: {re.escape(str(folder))}/waveforms/\S+\.dat {said}\n", err)
    assert [p.name for p in folder.iterdir()] == ["report.html"]


@POSIX
def test_no_room_for_a_report(reports, folder):
    """The finished test is kept; the old report is whole."""
    # A record is larger than the report of it.
    assert _limited(1_000_000, *MAIN, "--waveforms", "none", "--output", folder) == (
        3,
        "",
        f"pvlvrt-check: {folder}/report.html cannot be written: File too large;"
        f" 1 of 1 tests were finished and are kept in {folder}/interrupted\n",
    )
    assert (folder / "report.html").read_text("utf-8") == OLD
    assert sorted(p.name for p in folder.iterdir()) == ["interrupted", "report.html"]
    assert reports(folder / "interrupted").files == {"results.json", "junit.xml"}


def test_permission_lost_while_files_are_put_in_place(command, reports, monkeypatch, folder):
    """What has moved moves back, and the line says that the tests could not be kept either."""
    monkeypatch.setattr(os, "replace", _only_into(".unfinished-"))
    ended = command(*MAIN, "--output", folder)
    assert (ended.status, ended.out, ended.err.count("\n")) == (3, "", 1)
    place = folder / "waveforms" / "sag-90pct-abc.cfg"
    assert ended.err.startswith(
        f"pvlvrt-check: {place} cannot be written: Permission denied; 1 of 1 tests were finished"
    )
    assert "could not be kept" in ended.err
    assert reports(folder).files == {"report.html"}
    assert (folder / "report.html").read_text("utf-8") == OLD


def _only_into(part):
    """`os.replace` that may move files to where this is part of the name, and back to the report."""
    right = os.replace

    def replace(source, target):
        if part not in str(target) and Path(target).name != "report.html":
            raise PermissionError(13, "Permission denied")
        return right(source, target)

    return replace


def test_disk_that_is_full_all_over(command, monkeypatch, folder):
    """Where not even the results can be kept, that is said."""
    right = Path.write_bytes

    def full(path, data):
        if path.name == "results.json":
            raise OSError(28, "No space left on device")
        return right(path, data)

    monkeypatch.setattr(Path, "write_bytes", full)
    ended = command(*MAIN, "--output", folder)
    assert (ended.status, ended.out) == (3, "")
    assert ended.err == (
        f"pvlvrt-check: {folder}/results.json cannot be written: No space left on device; 1 of 1 tests were finished,"
        f" they could not be kept: {folder}/results.json cannot be written: No space left on device\n"
    )
    assert [p.name for p in folder.iterdir()] == ["report.html"]


def _into(stream, error, *arguments, cwd):
    program = [sys.executable, "-m", "pvlvrt_compliance.cli.main", *arguments]
    done = subprocess.run(program, stdout=stream, stderr=error, cwd=cwd, text=True, check=False)
    return done.returncode, done.stderr


@POSIX
@pytest.mark.parametrize(
    "arguments",
    [["--version"], ["--help"], ["schema"], ["profiles", "list"], ["controllers", "header"], [*MAIN[:2], "--list"]],
    ids=" ".join,
)
def test_standard_output_that_is_full(arguments, tmp_path):
    """Status 3 with a line, not a status of Python's own; where nobody hears the line, the status all the same."""
    with FULL.open("w") as full:
        line = "pvlvrt-check: standard output cannot be written: No space left on device\n"
        assert _into(full, subprocess.PIPE, *arguments, cwd=tmp_path) == (3, line)
        assert _into(full, full, *arguments, cwd=tmp_path)[0] == 3


@POSIX
@pytest.mark.parametrize("quiet", [[], ["--quiet"]], ids=["table", "quiet"])
def test_verdict_that_cannot_be_shown(reports, tmp_path, quiet):
    """The reports are there, and the line says so, and what they say."""
    with FULL.open("w") as full:
        assert _into(full, subprocess.PIPE, *MAIN, *quiet, cwd=tmp_path) == (
            3,
            "pvlvrt-check: standard output cannot be written: No space left on device;"
            " the reports are in pvlvrt-report: PASS: 1 test; checks: 7 pass; 1 marginal\n",
        )
    assert reports(tmp_path / "pvlvrt-report").test["status"] == "pass"


@POSIX
def test_refusal_that_nobody_hears(tmp_path):
    """A full stderr changes no status: 1 would mean that a check failed."""
    with FULL.open("w") as full:
        assert _into(subprocess.DEVNULL, full, "--profile", "absent.toml", cwd=tmp_path)[0] == 2


@POSIX
def test_reader_that_has_gone(tmp_path):
    """Nothing is wrong with a reader that has seen enough."""
    ours, theirs = os.pipe()
    os.close(ours)
    try:
        assert _into(theirs, subprocess.PIPE, "schema", cwd=tmp_path) == (0, "")
    finally:
        os.close(theirs)


@POSIX
def test_standard_output_that_is_closed(tmp_path):
    """Without any stdout the command does its work."""
    command = f"{sys.executable} -m pvlvrt_compliance.cli.main controllers header >&-"
    done = subprocess.run(command, shell=True, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
