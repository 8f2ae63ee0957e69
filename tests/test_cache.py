"""What is kept in the user's folder beside compiled code."""

import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier

import pytest

from pvlvrt_compliance import cache
from pvlvrt_compliance.compiled import notes
from pvlvrt_compliance.errors import CompiledCodeWarning


def test_the_cache_moves_with_the_environment(monkeypatch, tmp_path):
    """NUMBA_CACHE_DIR says where compiled code is kept, else the user's folder for such things."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    assert cache.cache_root() == tmp_path
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    assert cache.cache_root() == tmp_path / "home" / "pvlvrt-compliance"


def test_without_a_home_there_is_no_cache(monkeypatch):
    """A user that the system does not know, without HOME, has no folder; none is made in the current one."""
    for name in ("NUMBA_CACHE_DIR", "XDG_CACHE_HOME", "HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(os, "getuid", lambda: 123456)
    assert cache.cache_root() is None


@pytest.fixture(autouse=True)
def folder(monkeypatch, tmp_path):
    """A folder of its own for what is kept, which is not there yet; nothing has been said yet."""
    monkeypatch.setattr(notes, "_said", set())
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    return tmp_path / "cache"


def never():
    """What must not be called."""
    raise AssertionError("made anew")


def test_it_is_made_once():
    """What one call has made the next one finds; another name is of something else."""
    assert cache.kept("a", lambda: b"made") == b"made"
    assert cache.kept("a", never) == b"made"
    assert cache.kept("b", lambda: b"other") == b"other"


def test_a_name_goes_by_every_part_that_it_is_made_from():
    """Parts, their order and where one ends decide; text is the same as its bytes."""
    names = [cache.named("x", *parts) for parts in (("ab", "c"), ("a", "bc"), ("c", "ab"), ("abc",), ("ab", "d"))]
    assert len({*names, cache.named("y", "ab", "c")}) == 6
    assert cache.named("x", b"ab", "c") == names[0]


def emptied(file):
    """Nothing is left of it."""
    file.write_bytes(b"")


def cut(file):
    """Half of it is left."""
    file.write_bytes(file.read_bytes()[:50])


def flipped(file):
    """One bit is another."""
    data = bytearray(file.read_bytes())
    data[-1] ^= 1
    file.write_bytes(data)


def of_another_name(file):
    """A whole file, of another name."""
    cache.keep("another", b"another")
    file.write_bytes(file.with_name("another").read_bytes())


def a_folder(file):
    """A folder with something in it."""
    file.unlink()
    (file / "within").mkdir(parents=True)


@pytest.mark.parametrize("damage", [emptied, cut, flipped, of_another_name, a_folder])
def test_what_is_damaged_is_made_anew(folder, damage):
    """Whatever became of the file, its content is never used: that is said, and the next call finds a whole one."""
    cache.kept("a", lambda: b"made")
    damage(folder / "a")
    with pytest.warns(CompiledCodeWarning, match="damaged"):
        assert cache.kept("a", lambda: b"anew") == b"anew"
    assert cache.kept("a", never) == b"anew"


def test_a_file_that_may_not_be_read_is_none(monkeypatch):
    """A file of another user's is neither used nor complained of."""
    cache.kept("a", lambda: b"theirs")

    def refused(path):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(Path, "read_bytes", refused)
    assert cache.kept("a", lambda: b"mine") == b"mine"


@pytest.mark.parametrize("place", ["file/cache", ""])
def test_without_a_folder_it_is_made_each_time(monkeypatch, tmp_path, place):
    """Where the folder cannot be made, and without a home, nothing is kept anywhere, and nothing fails."""
    (tmp_path / "file").touch()
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / place) if place else "")
    if not place:
        monkeypatch.setattr(cache, "cache_root", lambda: None)
    assert [cache.kept("a", lambda made=made: made) for made in (b"1", b"2")] == [b"1", b"2"]
    assert [*tmp_path.iterdir()] == [tmp_path / "file"]


def test_a_run_that_is_ended_while_it_writes_leaves_nothing(folder, monkeypatch):
    """Nobody ever finds half of a file: it takes its place when it is whole."""
    whole = Path.write_bytes

    def ended(path, data):
        whole(path, data[:60])
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "write_bytes", ended)
    with pytest.raises(KeyboardInterrupt):
        cache.kept("a", lambda: b"made")
    monkeypatch.setattr(Path, "write_bytes", whole)
    assert [*folder.iterdir()] == []
    (folder / ".left.part").write_bytes(b"of a run that was killed")
    assert cache.kept("a", lambda: b"made") == b"made"


def test_two_that_begin_at_once():
    """Both make it, both have it whole, and what is kept is whole."""
    both = Barrier(2)

    def make():
        both.wait()
        return bytes(100_000)

    with ThreadPoolExecutor(2) as pool:
        found = [*pool.map(lambda _: cache.kept("a", make), range(2))]
    assert found == [bytes(100_000)] * 2
    assert cache.kept("a", never) == bytes(100_000)


def test_of_each_kind_the_latest_are_kept(folder, monkeypatch):
    """An edit leaves what was made from the text before, so the oldest of a kind goes; another kind stays."""
    monkeypatch.setattr(cache, "_MOST_OF_A_KIND", 3)
    cache.keep("other-0", b"0")
    for k in range(5):
        cache.keep(f"kind-{k}", b"x")
        os.utime(folder / f"kind-{k}", (k, k))
    assert sorted(file.name for file in folder.iterdir()) == ["kind-2", "kind-3", "kind-4", "other-0"]


def test_the_sources_of_a_room_decide(monkeypatch, tmp_path):
    """The digest of a room is another one after any edit in it, and the same after an edit elsewhere."""
    package = tmp_path / "package"
    for file in ("cache.py", "a.py", "room/b.py", "room/deep/c.py"):
        (package / file).parent.mkdir(parents=True, exist_ok=True)
        (package / file).write_text(file)
    monkeypatch.setattr(cache, "__file__", str(package / "cache.py"))
    digests = []
    for file in ("cache.py", "room/deep/c.py", "room/b.py", "a.py"):
        (package / file).write_text("edited")
        cache.sources.cache_clear()
        digests.append(cache.sources("room", "a.py"))
    cache.sources.cache_clear()
    assert len(set(digests)) == 4
    (package / "cache.py").write_text("edited again")
    assert cache.sources("room", "a.py") == digests[-1]
    cache.sources.cache_clear()
