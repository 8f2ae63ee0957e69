"""What an output folder refuses before anything is simulated, and that nothing stays of a run that never was."""

import errno

import pytest
import small_runs

from pvlvrt_compliance.errors import OutputError, UsageError
from pvlvrt_compliance.study import store
from pvlvrt_compliance.study.store import JUNIT, REPORT, RESULTS, OutputFolder


@pytest.mark.parametrize("name", [REPORT, JUNIT, RESULTS])
def test_a_folder_in_the_way(tmp_path, name):
    """A folder by the name of a report is told before anything is simulated, and stays."""
    (tmp_path / name / "inside").mkdir(parents=True)
    with pytest.raises(UsageError, match=f"a folder is in the way .*{name}"):
        OutputFolder(str(tmp_path))
    assert small_runs.names_in(tmp_path) == set()
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_file_in_the_way_of_the_waveforms(tmp_path):
    """So is a file where the waveforms go."""
    (tmp_path / "waveforms").write_text("mine")
    with pytest.raises(UsageError, match=r"no files can be put there .*waveforms"):
        OutputFolder(str(tmp_path))
    assert small_runs.names_in(tmp_path) == {"waveforms"}


def test_waveforms_on_another_file_system(begun, monkeypatch):
    """No file takes its place there in one step: that is told before anything is simulated."""
    monkeypatch.setattr(store, "_device_of", lambda place: len(place.parts))
    with pytest.raises(UsageError, match=r"another file system .*waveforms"):
        OutputFolder(str(begun))
    small_runs.assert_whole(begun, "first")


def test_nothing_stays_of_a_run_that_is_discarded(tmp_path):
    """Not even the folders that were made for it."""
    small_runs.stage(tmp_path / "deep" / "out", "first").discard()
    assert list(tmp_path.iterdir()) == []


def test_no_room_at_the_beginning(tmp_path, monkeypatch):
    """A full disk is no wrong usage, and is told before anything is simulated."""

    def fail(*_arguments, **_keywords):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(store.tempfile, "mkdtemp", fail)
    with pytest.raises(OutputError) as error:
        OutputFolder(str(tmp_path / "out"))
    assert str(error.value) == f"output {tmp_path / 'out'}: cannot be written: No space left on device"
    assert list(tmp_path.iterdir()) == []


def test_messages_name_what_was_typed(tmp_path):
    """The folder is called as whoever asks writes it."""
    (tmp_path / "file").write_text("mine")
    for folder, said in (("", ": a folder is needed"), (str(tmp_path / "file"), f" {tmp_path / 'file'}: cannot be")):
        for spelled, spell in (("output", str), ("--output", "--{}".format)):
            with pytest.raises(UsageError) as error:
                OutputFolder(folder, spell)
            assert str(error.value).startswith(f"{spelled}{said}")
