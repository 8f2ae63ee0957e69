"""Files that others name: only ordinary ones are read, and no more of them than is allowed."""

import os
import socket
import sys
from pathlib import Path

import pytest

from pvlvrt_compliance.ordinary_file import NotOrdinaryError, TooLargeError, content_of, is_within, kind_of, real

posix = pytest.mark.skipif(sys.platform == "win32", reason="pipes, devices and links of POSIX")

FOUR = 4


@pytest.fixture
def folder(tmp_path):
    """A folder with something beside it that is nobody's affair."""
    (tmp_path / "secret").write_bytes(b"root")
    inside = tmp_path / "inside"
    (inside / "below").mkdir(parents=True)
    (inside / "below" / "file").write_bytes(b"abcd")
    return inside


def test_what_is_read(folder):
    """All of it, from a folder below, too, and through a link that stays within."""
    (folder / "link").symlink_to(folder / "below" / "file")
    assert content_of(folder / "below" / "file", FOUR) == b"abcd"
    assert content_of(folder / "link", FOUR, folder) == b"abcd"
    assert content_of(folder / "below" / ".." / "link", FOUR, folder) == b"abcd"


def test_a_large_file_is_not_read(folder):
    """One with a hole in it has its size without its bytes, and is refused by that."""
    with pytest.raises(TooLargeError):
        content_of(folder / "below" / "file", FOUR - 1)
    with (folder / "hole").open("wb") as file:
        file.truncate(1 << 40)
    with pytest.raises(TooLargeError):
        content_of(folder / "hole", 1 << 20)


@pytest.mark.skipif(not Path("/proc/self/maps").exists(), reason="files of the kernel of Linux")
def test_what_says_it_is_empty_is_read_no_further():
    """Files of the kernel have no size; what comes of them is counted."""
    with pytest.raises(TooLargeError):
        content_of(Path("/proc/self/maps"), 1)


@posix
@pytest.mark.parametrize("what", ["folder", "pipe", "socket", "device"])
def test_nothing_else_is_opened(folder, what, monkeypatch):
    """What something is decides before it is opened."""
    place = folder / what
    match what:
        case "folder":
            place.mkdir()
        case "pipe":
            os.mkfifo(place)
        case "socket":
            monkeypatch.chdir(folder)  # the path of a socket must be short
            with socket.socket(socket.AF_UNIX) as bound:
                bound.bind(what)
        case "device":
            place.symlink_to("/dev/zero")
    monkeypatch.setattr(os, "open", None)
    with pytest.raises(NotOrdinaryError, match=f"it is a {what}, and must be an ordinary file"):
        content_of(place, FOUR)


@posix
def test_what_takes_its_place_is_not_read(folder, monkeypatch):
    """A pipe that another program puts there between the question and the opening: nobody waits for it."""
    file, opened = folder / "below" / "file", os.open

    def replaced(path, flags, *more):
        file.unlink()
        os.mkfifo(file)
        return opened(path, flags, *more)

    monkeypatch.setattr(os, "open", replaced)
    with pytest.raises(NotOrdinaryError, match="it is a pipe"):
        content_of(file, FOUR)


@pytest.mark.parametrize("name", ["../secret", "below/../../secret", "link", "below/link", "linked/secret"])
def test_nothing_leads_out(folder, name):
    """No path and no link, of a file or of a folder; a file of that place is read where any may be."""
    (folder / "link").symlink_to("../secret")
    (folder / "below" / "link").symlink_to(folder.parent / "secret")
    (folder / "linked").symlink_to(folder.parent)
    with pytest.raises(NotOrdinaryError, match="leads out of the folder"):
        content_of(folder / name, FOUR, folder)
    assert not is_within(folder / name, folder)
    assert content_of(folder / name, FOUR) == b"root"


@pytest.mark.parametrize("name", ["none", "below/none", "a\0b", "x" * 5000])
def test_what_is_not_there(folder, name):
    """One line, whatever the path is like."""
    with pytest.raises(NotOrdinaryError, match=r"^cannot be read: [^\n]+$"):
        content_of(folder / name, FOUR, folder)


@posix
def test_links_that_lead_round(folder):
    """They end somewhere: in an error."""
    (folder / "a").symlink_to("b")
    (folder / "b").symlink_to("a")
    with pytest.raises(NotOrdinaryError, match="cannot be read"):
        content_of(folder / "a", FOUR, folder)


def test_a_kind_in_words():
    """An ordinary file is nothing to be told."""
    assert (kind_of(0o100644), kind_of(0o040755), kind_of(0)) == (None, "a folder", "not an ordinary file")


@posix
def test_links_that_lead_round_lead_nowhere(tmp_path):
    """They are resolved as far as that goes, and whoever opens them is told by the system."""
    loop = tmp_path / "loop"
    loop.symlink_to(loop)
    assert real(loop) == loop
    (tmp_path / "link").symlink_to(tmp_path / "file")
    assert real(tmp_path / "link") == (tmp_path / "file").resolve()
