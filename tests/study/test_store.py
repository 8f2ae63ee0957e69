"""The files in an output folder are those of one run, whatever happens to the next."""

import itertools
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
import small_runs

from pvlvrt_compliance.errors import OutputError, UsageError
from pvlvrt_compliance.results.files import ON_REQUEST
from pvlvrt_compliance.study.store import JUNIT, REPORT, RESULTS, OutputFolder

ID = {name: small_runs.results_of(name).run_id for name in ("first", "second", "third", "earlier")}


def files_of(name):
    """Files of a small run."""
    records = {f"waveforms/{test}.{ending}" for test in ("common", name) for ending in ("cfg", "dat")}
    return {RESULTS, JUNIT, REPORT} | records


def assert_no_mix(folder):
    """Files of one run; where its results are, all of it is."""
    found = small_runs.ids(folder)
    assert len(set(found.values())) <= 1
    if RESULTS in found:
        small_runs.assert_whole(folder, next(name for name in ID if ID[name] == found[RESULTS]))


def assert_foreign_stay(folder):
    """What others have put there is as it was."""
    assert {(folder / name).read_text() for name in small_runs.FOREIGN} == {"mine"}


@pytest.mark.skipif(not hasattr(os, "fork"), reason="Windows cannot kill a process at a step of its own")
def test_killed_at_every_step(tmp_path):
    """Old run, new run or no results, never a mix; the next run finishes what was begun, and clears away the rest."""
    subprocess.run([sys.executable, small_runs.__file__, str(tmp_path)], check=True)
    folders = sorted((p for p in tmp_path.iterdir() if p.name != "begin"), key=lambda p: int(p.name))
    assert len(folders) > 20
    ends = []
    for folder in folders:
        assert_no_mix(folder)
        assert_foreign_stay(folder)
        OutputFolder(str(folder)).discard()
        run = next(name for name in ID if ID[name] == small_runs.ids(folder).get(RESULTS))
        ends.append(run)
        small_runs.assert_whole(folder, run)
        assert small_runs.names_in(folder) - set(small_runs.FOREIGN) == files_of(run) | (
            {f"interrupted/{name}" for name in files_of("earlier") - {JUNIT, REPORT}} if run == "first" else set()
        )
        small_runs.stage(folder, "third").finish()
        assert small_runs.names_in(folder) == files_of("third") | set(small_runs.FOREIGN)
    # Before the journal stands there the run is taken back, from then on it is finished.
    assert [key for key, _ in itertools.groupby(ends)] == ["first", "second"]


def _fail_at(monkeypatch, errors):
    """Have steps, counted from 0, of renaming and removing fail with errors; a list that grows with the steps done."""
    done = []

    def failing(right):
        def change(*arguments, **keywords):
            done.append(arguments)
            if len(done) - 1 in errors:
                raise errors[len(done) - 1]
            return right(*arguments, **keywords)

        return change

    for name in ("replace", "unlink"):
        monkeypatch.setattr(os, name, failing(getattr(os, name)))
    return done


def _number_of_steps(folder):
    with pytest.MonkeyPatch.context() as patch:
        output = small_runs.stage(folder, "second")
        done = _fail_at(patch, {})
        output.finish()
    return next(k for k, (path, *_) in enumerate(done) if Path(path).name == "journal.json") + 1


NOT_ALLOWED = PermissionError(13, "Permission denied")


@pytest.mark.parametrize("error", [NOT_ALLOWED, KeyboardInterrupt()], ids=type)
def test_failure_at_every_step(tmp_path, error):
    """What cannot be put in place, or is interrupted there, is taken back as if it had never begun, and can be kept."""
    small_runs.begin(tmp_path / "counted")
    for step in range(_number_of_steps(tmp_path / "counted")):
        folder = tmp_path / str(step)
        small_runs.begin(folder)
        output = small_runs.stage(folder, "second")
        with pytest.MonkeyPatch.context() as patch:
            _fail_at(patch, {step: error})
            with pytest.raises((OutputError, KeyboardInterrupt)):
                output.finish()
        assert not output.is_placed
        assert not output.is_stuck
        small_runs.assert_whole(folder, "first")
        assert_foreign_stay(folder)
        small_runs.keep(output, "second")
        assert small_runs.ids(folder / "interrupted")[RESULTS] == ID["second"]
        small_runs.assert_whole(folder, "first")
        assert not list(folder.glob(".unfinished*"))


@pytest.mark.parametrize("error", [NOT_ALLOWED, KeyboardInterrupt()], ids=type)
def test_failure_that_cannot_be_taken_back(begun, monkeypatch, error):
    """Then it is said who will put it right, nothing is a mix meanwhile, and the next run does put it right."""
    output = small_runs.stage(begun, "second")
    with monkeypatch.context() as patch:
        _fail_at(patch, {6: error} | dict.fromkeys(range(7, 999), NOT_ALLOWED))
        with pytest.raises(OutputError, match=r"; nor could what was there be put back .*next run into") as told:
            output.finish()
    assert str(told.value).startswith("stopped while") == (error is not NOT_ALLOWED)
    assert output.is_stuck
    output.discard()
    assert_no_mix(begun)
    following = OutputFolder(str(begun))
    assert following.notes == [f"{begun}: a run that was stopped while its files were put in place is whole now"]
    following.discard()
    small_runs.assert_whole(begun, "second")
    assert_foreign_stay(begun)


def test_interruption_while_it_is_taken_back(begun, monkeypatch):
    """What is half put back stays where it is, and the next run puts it right."""
    output = small_runs.stage(begun, "second")
    with monkeypatch.context() as patch:
        _fail_at(patch, {6: NOT_ALLOWED, 8: KeyboardInterrupt()})
        with pytest.raises(KeyboardInterrupt):
            output.finish()
    assert output.is_stuck
    output.discard()
    assert_no_mix(begun)
    OutputFolder(str(begun)).discard()
    small_runs.assert_whole(begun, "second")
    assert_foreign_stay(begun)


def test_one_run_at_a_time(begun):
    """A second run into the folder is refused, with the process that has it, and disturbs nothing of the first."""
    output = small_runs.stage(begun, "second")
    with pytest.raises(UsageError) as error:
        OutputFolder(str(begun))
    assert str(error.value) == (
        f"output {begun}: another run (process {os.getpid()}) is writing there;"
        " wait for its end, or name another folder"
    )
    output.finish()
    small_runs.assert_whole(begun, "second")


def test_a_second_run_by_another_name_of_the_folder(begun, tmp_path):
    """A link to the folder is the same folder."""
    (tmp_path / "link").symlink_to(begun, target_is_directory=True)
    output = small_runs.stage(begun, "second")
    with pytest.raises(UsageError, match="another run"):
        OutputFolder(str(tmp_path / "link"))
    output.discard()


def test_leftovers_are_cleared(begun):
    """What killed runs have staged, of this version or of one before, is gone once the next one begins."""
    for number in range(3):
        (begun / f".unfinished-{number}" / "waveforms").mkdir(parents=True)
        (begun / f".unfinished-{number}" / "waveforms" / "a.dat").write_text("half")
    (begun / ".unfinished.lock").touch()
    output = OutputFolder(str(begun))
    assert [path for path in begun.glob(".unfinished-*")] == [output.staging]
    output.discard()
    assert not list(begun.glob(".unfinished*"))
    small_runs.assert_whole(begun, "first")


@pytest.mark.parametrize("name", ["../outside.txt", "/tmp/outside.txt", "a/../../outside.txt", "C:outside", "a\\..\\b"])
def test_a_journal_moves_nothing_outside(begun, name):
    """A journal that somebody has put there can name no file outside the folder; it is thrown away."""
    outside = begun.parent / "outside.txt"
    outside.write_text("mine")
    staging = begun / ".unfinished-theirs"
    staging.mkdir()
    (staging / "journal.json").write_text(json.dumps({"into": "", "withdrawn": [name], "placed": []}))
    OutputFolder(str(begun)).discard()
    assert outside.read_text() == "mine"
    assert not staging.exists()
    small_runs.assert_whole(begun, "first")


ENDLESS = ("[" * 100_000, "9" * 5000)
"""Deeper and longer than Python reads JSON."""


@pytest.mark.parametrize(
    "text", ["", "{", "[]", '{"into": 3, "withdrawn": [], "placed": []}', '{"into": ""}', *ENDLESS]
)
def test_a_journal_that_is_none(begun, text):
    """Garbage in a staging folder is cleared away with it."""
    staging = begun / ".unfinished-theirs"
    staging.mkdir()
    (staging / "journal.json").write_text(text)
    OutputFolder(str(begun)).discard()
    assert not staging.exists()


@pytest.mark.parametrize("text", ENDLESS)
def test_results_of_another_that_cannot_be_read(begun, text):
    """What lies there under the name is no results, and the next run takes its place."""
    (begun / RESULTS).write_text(text)
    small_runs.stage(begun, "second").finish()
    small_runs.assert_whole(begun, "second")


@pytest.mark.parametrize("name", ON_REQUEST)
@pytest.mark.parametrize("text", ["made of {}", "of nobody"], ids=["of the run before", "another's"])
def test_what_is_written_on_request_goes_with_its_run(tmp_path, text, name):
    """A run that writes none leaves none of the run before beside its own files; one of nobody knows whom stays."""
    output = small_runs.stage(tmp_path, "first")
    output.write(name, text.format(ID["first"]))
    output.finish()
    small_runs.stage(tmp_path, "second").finish()
    assert small_runs.ids(tmp_path)[RESULTS] == ID["second"]
    assert (tmp_path / name).exists() is (text.format("") == text)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes in folders")
def test_a_pipe_in_place_of_the_results(tmp_path):
    """Nobody waits for what it may say: the run is put in its place."""
    os.mkfifo(tmp_path / RESULTS)
    small_runs.stage(tmp_path, "second").finish()
    small_runs.assert_whole(tmp_path, "second")
