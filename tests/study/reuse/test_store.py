"""The folder of stored records."""

import os
import signal
import sys

import pytest

from pvlvrt_compliance.errors import StoredRecordWarning
from pvlvrt_compliance.study.reuse import record_file
from pvlvrt_compliance.study.reuse.record_file import UNFINISHED, size_of
from pvlvrt_compliance.study.reuse.store import ENDING, RecordStore

KEYS = tuple(letter * 64 for letter in "abcdef")
HOUR_NS = 3600 * 10**9

forks = pytest.mark.skipif(not hasattr(os, "fork"), reason="no copies of a process on this system")


def value_of(kept):
    """What a made-up record was made of."""
    return None if kept is None else float(kept.waveforms.segments[0]["x"][0])


def names_in(store):
    """First letters of the keys of what is stored."""
    return sorted(file.name[0] for file in store.folder.glob(f"*{ENDING}"))


def used(store, key, hours_ago):
    """Say that a record was used some time ago."""
    file = store.folder / f"{key}{ENDING}"
    then = file.stat().st_mtime_ns - round(hours_ago * HOUR_NS)
    os.utime(file, ns=(then, then))


def write_all(store, made):
    """Keep a record for every key."""
    for key in KEYS:
        store.write(key, made())


def room_for(count, made, folder):
    """A store with room for so many records of those that are made."""
    RecordStore(folder, 10**9).write(KEYS[0], made())
    size = next(folder.glob(f"*{ENDING}")).stat().st_size
    next(folder.glob(f"*{ENDING}")).unlink()
    return RecordStore(folder, count * size + size_of(made()) - size)


def test_what_was_kept_is_found(store, made):
    """By its key, and by no other."""
    store.write(KEYS[0], made(3.0))
    assert value_of(store.read(KEYS[0])) == 3.0
    assert store.read(KEYS[1]) is None


def test_a_damaged_record_is_thrown_away(store, made):
    """That is said, once; the next one takes its place."""
    for key in KEYS[:2]:
        store.write(key, made())
        file = store.folder / f"{key}{ENDING}"
        file.write_bytes(file.read_bytes()[:-1])
    with pytest.warns(StoredRecordWarning, match="damaged .it ends too early.: thrown away and simulated anew") as said:
        assert [store.read(key) for key in KEYS[:2]] == [None, None]
    assert (len(said), names_in(store)) == (1, [])
    store.write(KEYS[0], made(1.0))
    assert value_of(store.read(KEYS[0])) == 1.0


def test_what_was_used_longest_ago_goes_first(tmp_path, made):
    """To have been read is to have been used."""
    store = room_for(3, made, tmp_path)
    for age, key in enumerate(KEYS[:3], start=1):
        store.write(key, made())
        used(store, key, age)
    RecordStore(tmp_path, 10**9).read(KEYS[2])  # the oldest
    store.write(KEYS[3], made())
    assert names_in(store) == ["a", "c", "d"]


@pytest.mark.parametrize("count", [1, 2, 3])
def test_the_bound_is_kept(tmp_path, made, count):
    """However many are written: all files together take no more."""
    limit = room_for(count, made, tmp_path)._limit
    for key in KEYS:
        RecordStore(tmp_path, limit).write(key, made())
        assert sum(file.stat().st_size for file in tmp_path.iterdir()) <= limit
        for file in tmp_path.glob(f"{key}{ENDING}"):
            used(RecordStore(tmp_path, limit), file.stem, KEYS[::-1].index(key) + 1)
    assert names_in(RecordStore(tmp_path, limit)) == list("abcdef")[-count:]


def test_a_run_that_is_larger_than_the_bound_keeps_what_it_began_with(tmp_path, made):
    """It does not replace what it will need the next time; that no more are kept is said, once."""
    store = room_for(2, made, tmp_path)
    with pytest.warns(
        StoredRecordWarning, match="is full; further records are not kept; --reuse-size gives them more room"
    ) as said:
        write_all(store, made)
    assert (len(said), names_in(store)) == (1, ["a", "b"])


def test_a_record_for_which_the_folder_is_too_small(tmp_path, made):
    """Nothing is removed for it in vain."""
    store = room_for(2, made, tmp_path)
    store.write(KEYS[0], made())
    used(store, KEYS[0], 5)
    with pytest.warns(StoredRecordWarning, match="full"):
        store.write(KEYS[1], made(rows=1000))
    assert names_in(store) == ["a"]


def test_a_full_disk_is_no_error(store, made, monkeypatch):
    """It is said once what is not kept, and why."""

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(record_file, "_write", full)
    with pytest.warns(StoredRecordWarning, match="records are not kept: .*No space left on device") as said:
        write_all(store, made)
    assert (len(said), list(store.folder.iterdir())) == (1, [])


@pytest.mark.skipif(sys.platform == "win32", reason="no modes of this kind")
def test_a_record_that_cannot_be_read_is_none(store, made, monkeypatch):
    """It is said once."""
    store.write(KEYS[0], made())

    def refused(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("pvlvrt_compliance.study.reuse.store.read_record", refused)
    with pytest.warns(StoredRecordWarning, match=r"cannot be read \(Permission denied\): simulated anew"):
        assert store.read(KEYS[0]) is None


@forks
def test_a_run_that_is_killed_at_any_point_of_a_write_leaves_no_half_record(tmp_path, made):
    """What is found after it is nothing, or the whole; the next run keeps its own."""
    store, right, killed = RecordStore(tmp_path, 10**9), record_file.zlib.crc32, 0
    for step in range(100):
        child = os.fork()
        if child == 0:
            steps = iter(range(100))

            def crc32(*of, steps=steps, step=step):
                if next(steps) == step:
                    os.kill(os.getpid(), signal.SIGKILL)
                return right(*of)

            record_file.zlib.crc32 = crc32
            store.write(KEYS[0], made(1.0))
            os._exit(0)
        if os.waitpid(child, 0)[1] == 0:
            break
        killed += 1
        assert value_of(store.read(KEYS[0])) is None
    assert killed == 7  # before each of six channels' samples is counted, and the table
    assert value_of(store.read(KEYS[0])) == 1.0


def test_what_killed_runs_have_left_is_removed_when_it_is_old(store, made):
    """What another run may be writing stays."""
    store.write(KEYS[0], made())
    old, new = (store.folder / f"{name}{UNFINISHED}" for name in ("old", "new"))
    for part in (old, new):
        part.write_bytes(b"half")
    then = old.stat().st_mtime_ns - 2 * HOUR_NS
    os.utime(old, ns=(then, then))
    RecordStore(store.folder, 10**9)
    assert (old.exists(), new.exists(), names_in(store)) == (False, True, ["a"])


@forks
def test_two_runs_at_once(tmp_path, made):
    """Each finds nothing or the right record, in a folder that is too small for both; none ends with an error."""
    limit = room_for(3, made, tmp_path)._limit

    def work():
        for turn in range(40):
            for number, key in enumerate(KEYS):
                store = RecordStore(tmp_path, limit)  # of a run of its own: what is older may go
                if value_of(store.read(key)) not in (None, float(number)):
                    os._exit(1)
                if (turn + number) % 2:
                    store.write(key, made(float(number)))

    children = []
    for _ in range(2):
        child = os.fork()
        if child == 0:
            import warnings

            warnings.simplefilter("ignore", StoredRecordWarning)
            try:
                work()
            except BaseException:
                os._exit(2)
            os._exit(0)
        children.append(child)
    assert [os.waitpid(child, 0)[1] for child in children] == [0, 0]
    assert sum(file.stat().st_size for file in tmp_path.iterdir()) <= limit
