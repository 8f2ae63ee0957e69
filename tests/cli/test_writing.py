"""What a command writes besides the files of a run: all of it or nothing, and the status says why."""

import errno
import pathlib

import pytest

NO_ROOM = OSError(errno.ENOSPC, "No space left on device")


def _fill_disk(monkeypatch, after):
    """Let so many files be opened for writing; the next one cannot be written to."""
    right, opened = pathlib.Path.open, []

    class Full:
        def __init__(self, stream):
            self._stream = stream

        def __enter__(self):
            return self

        def __exit__(self, *_):
            self._stream.close()

        def write(self, _content):
            raise NO_ROOM

    def limited(path, mode="r", *arguments, **keywords):
        stream = right(path, mode, *arguments, **keywords)
        opened.append(path) if set(mode) & set("wx") else None
        return Full(stream) if set(mode) & set("wx") and len(opened) > after else stream

    monkeypatch.setattr(pathlib.Path, "open", limited)


@pytest.mark.parametrize(
    ("arguments", "after", "says"),
    [
        (("profiles", "new", "mine"), 0, "mine.toml cannot be written (No space left on device)"),
        (("profiles", "plot", "iec61400-21"), 0, "iec61400-21.svg: cannot be written (No space left on device)"),
        (("controllers", "new", "new/project"), 2, "cannot be written (No space left on device)"),
    ],
    ids=lambda x: " ".join(x[:2]) if isinstance(x, tuple) else None,
)
def test_full_disk(command, monkeypatch, tmp_path, arguments, after, says):
    """Status 3, and nothing half-written that would be in the way of another try."""
    monkeypatch.chdir(tmp_path)
    with monkeypatch.context() as patch:
        _fill_disk(patch, after)
        ended = command(*arguments)
    assert (ended.status, ended.out) == (3, "")
    assert says in ended.err
    assert list(tmp_path.iterdir()) == []
    assert command(*arguments).status == 0


def test_a_figure_that_cannot_be_replaced(command, monkeypatch, tmp_path):
    """The one of before is as it was."""
    figure = tmp_path / "figure.svg"
    figure.write_text("before")
    _fill_disk(monkeypatch, 0)
    assert command("profiles", "plot", "iec61400-21", "--output", figure).status == 3
    assert [(path, path.read_text()) for path in tmp_path.iterdir()] == [(figure, "before")]


def test_waveforms_as_csv_that_are_not_kept(judge):
    """It is told that there are none, as of all that is given and does nothing; the run is as without it."""
    said = "--csv does nothing here: it needs waveforms that are kept (--waveforms all or failed)"
    for kept in ("none", "all"):
        ended, found = judge("--sag", "20%", "--duration", "20ms", "--csv", "--waveforms", kept)
        assert (said in ended.err) == (kept == "none")
        assert any(name.endswith(".csv") for name in found.files) == (kept == "all")
