"""A whole run: its results, its files, and what becomes of it when it ends early."""

import json
from contextlib import nullcontext
from dataclasses import replace

import pytest

from pvlvrt_compliance.output import output_in
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.running import run_job

JOB = make_job(Asked(profiles=("iec61400-21",), tests=("VD3-full-*",)))


def interrupting(test, end=KeyboardInterrupt):
    """What is told of each test before it is run, and ends the run before this one."""

    def progress(name, _done, _total):
        if name.endswith(test):
            raise end

    return nullcontext(progress)


def test_without_a_folder_nothing_is_written(tmp_path, monkeypatch, capfd):
    """Results alone come back; nothing is printed."""
    monkeypatch.chdir(tmp_path)
    results = run_job(JOB, command="a test")
    assert [test.id for test in results.tests] == ["VD3-full-1", "VD3-full-2"]
    assert results.status is Status.PASS
    assert results.provenance["command"] == "a test"
    assert all(test.waveforms is None for test in results.tests)
    assert not list(tmp_path.iterdir())
    assert capfd.readouterr() == ("", "")


def test_files_are_of_the_results(tmp_path):
    """What is written is what comes back."""
    results = run_job(JOB, command=["a", "b c"], output=output_in(str(tmp_path / "out"), 2))
    assert json.loads((tmp_path / "out" / "results.json").read_text()) == json.loads(results.model_dump_json())
    assert results.provenance["command"] == "a 'b c'"
    for test in results.tests:
        assert (tmp_path / "out" / test.waveforms).is_file()


@pytest.mark.parametrize("end", [KeyboardInterrupt, RuntimeError])
def test_what_ends_a_run_says_what_was_kept(tmp_path, end):
    """Whatever it is, it goes on to the caller, with a note; finished tests are kept apart."""
    folder = tmp_path / "out"
    with pytest.raises(end) as error:
        run_job(JOB, command="", output=output_in(str(folder), 2), watch=interrupting("VD3-full-2", end))
    assert error.value.__notes__ == [f"1 of 2 tests were finished and are kept in {folder}/interrupted"]
    kept = json.loads((folder / "interrupted" / "results.json").read_text())
    assert [test["id"] for test in kept["tests"]] == ["VD3-full-1"]
    assert kept["interrupted"]
    assert {path.name for path in (folder / "interrupted").iterdir()} == {"results.json", "junit.xml", "waveforms"}
    assert [path.name for path in folder.iterdir()] == ["interrupted"]


def test_a_format_that_fails_costs_no_finished_test(tmp_path):
    """What ended the run may be what is wrong with a format."""

    def render(*_):
        raise RuntimeError("a format")

    folder = tmp_path / "out"
    output = output_in(str(folder), 2)
    output = replace(output, formats={**output.formats, "junit.xml": render})
    with pytest.raises(RuntimeError, match="a format") as error:
        run_job(JOB, command="", output=output)
    assert error.value.__notes__ == [f"2 of 2 tests were finished and are kept in {folder}/interrupted"]
    assert {path.name for path in (folder / "interrupted").iterdir()} == {"results.json", "waveforms"}


def test_what_ends_a_run_without_a_folder():
    """The note says how far it was."""
    with pytest.raises(KeyboardInterrupt) as error:
        run_job(JOB, command="", watch=interrupting("VD3-full-2"))
    assert error.value.__notes__ == ["1 of 2 tests were finished"]
