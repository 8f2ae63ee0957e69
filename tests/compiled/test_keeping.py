"""Machine code that is kept: found again, never taken for another's, never trusted."""

import errno
import os
import pickle
import shutil
import warnings
from pathlib import Path

import pytest
from small import FILES, ended, kept_in, ran, started, written

from pvlvrt_compliance.compiled import checked_file, notes
from pvlvrt_compliance.errors import CompiledCodeWarning

RIGHT = "7.0"


@pytest.fixture
def program(tmp_path):
    """The small program."""
    return written(tmp_path / "program")


@pytest.fixture
def cache(tmp_path):
    """A folder for its compiled code, which is not there yet."""
    return tmp_path / "cache"


@pytest.fixture(scope="module")
def run_once(tmp_path_factory):
    """The small program after a run: where it is, and where its code is."""
    folder = tmp_path_factory.mktemp("small")
    program = written(folder / "program")
    assert ran(program, folder / "cache") == (f"{RIGHT} 0", "")
    return program, folder / "cache"


@pytest.fixture
def kept(run_once, cache):
    """The program, and a copy of its kept code."""
    program, first_cache = run_once
    shutil.copytree(first_cache, cache)
    return program, cache


def test_code_is_found_again(kept):
    """The next process compiles nothing."""
    assert ran(*kept) == (f"{RIGHT} 1", "")


@pytest.mark.parametrize("name", FILES)
def test_an_edit_that_keeps_the_time_of_a_file_is_compiled(kept, tmp_path, name):
    """Whichever file decides, another number in it is another result, and the old text has its old code still."""
    first, kept_code = kept
    program = shutil.copytree(first, tmp_path / "program")
    file = program / name
    text, times = file.read_text(), file.stat()
    edited = {
        "small_numbers.py": ("2.0", "2.25"),
        "small_gain.py": ("1.0", "0.50"),
        "small_block.py": ("K * x", "-K * x"),
    }
    old, new = edited.get(name, ("+ 1.0", "+ 2.00"))
    file.write_text(text.replace(old, new))
    os.utime(file, ns=(times.st_atime_ns, times.st_mtime_ns))
    found, said = ran(program, kept_code)
    assert (found.split()[0] != RIGHT, found.split()[1], said) == (True, "0", "")
    file.write_text(text)
    os.utime(file, ns=(times.st_atime_ns, times.st_mtime_ns))
    assert ran(program, kept_code) == (f"{RIGHT} 1", "")


@pytest.mark.slow
def test_two_versions_side_by_side(tmp_path, cache):
    """Two checkouts with one cache folder each find their own code, in turns."""
    first, second = written(tmp_path / "first"), written(tmp_path / "second")
    (second / "small_numbers.py").write_text("BASE = 3.0\n")
    assert [ran(first, cache)[0], ran(second, cache)[0]] == ["7.0 0", "11.0 0"]
    assert [ran(first, cache)[0], ran(second, cache)[0], ran(first, cache)[0]] == ["7.0 1", "11.0 1", "7.0 1"]


@pytest.mark.parametrize("count", [2, 5])
def test_processes_that_begin_at_once(program, cache, count):
    """However many begin with no code kept, each comes to the right result, and what they leave is whole."""
    for process in [started(program, cache) for _ in range(count)]:
        found, said = ended(process)
        assert (found.split()[0], said) == (RIGHT, "")
    assert ran(program, cache) == (f"{RIGHT} 1", "")
    assert [file for file in cache.rglob("*") if file.suffix == ".part"] == []


class Trap:
    """What leaves a file when it is unpickled."""

    def __init__(self, file: Path) -> None:
        self.file = file

    def __reduce__(self):
        return Path.touch, (self.file,)


def emptied(file: Path) -> None:
    """Nothing is left of it."""
    file.write_bytes(b"")


def cut(file: Path) -> None:
    """Half of it is left."""
    data = file.read_bytes()
    file.write_bytes(data[: len(data) // 2])


def cut_in_its_head(file: Path) -> None:
    """Not even its digest is whole."""
    file.write_bytes(file.read_bytes()[:30])


def flipped(file: Path) -> None:
    """One bit of the machine code is another."""
    data = bytearray(file.read_bytes())
    data[len(data) // 3] ^= 0x10
    file.write_bytes(data)


def flipped_at_its_end(file: Path) -> None:
    """The last bit is another."""
    data = bytearray(file.read_bytes())
    data[-1] ^= 0x01
    file.write_bytes(data)


def foreign(file: Path) -> None:
    """Something else that can be unpickled."""
    file.write_bytes(pickle.dumps(Trap(file.with_name("trapped"))))


def foreign_behind_a_head(file: Path) -> None:
    """The same behind the head of the file that was there."""
    file.write_bytes(file.read_bytes()[:56] + pickle.dumps(Trap(file.with_name("trapped"))))


def of_another_name(file: Path) -> None:
    """The same with a digest that is right, for a file of another name."""
    checked_file.write_checked(file, "another", pickle.dumps(Trap(file.with_name("trapped"))))


def a_folder(file: Path) -> None:
    """A folder with something in it."""
    file.unlink()
    (file / "within").mkdir(parents=True)


def a_pipe(file: Path) -> None:
    """What waits for ever to be read."""
    file.unlink()
    os.mkfifo(file)


DAMAGES = [
    *(emptied, cut, cut_in_its_head, flipped, flipped_at_its_end),
    *(foreign, foreign_behind_a_head, of_another_name, a_folder, a_pipe),
]


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_file_is_made_anew(kept, damage):
    """Whatever has happened to the machine code, it is not looked at; one warning says so, and it is kept again."""
    (file,) = kept_in(kept[1])
    damage(file)
    found, said = ran(*kept)
    assert found == f"{RIGHT} 0"
    assert said.count("CompiledCodeWarning: ") == 1
    assert f"{file}: damaged (" in said
    assert kept_in(kept[1]) == [file]
    assert checked_file.read_checked(file, "/".join(file.parts[-3:]))


@pytest.mark.parametrize("damage", [emptied, flipped, foreign, a_folder])
def test_a_damaged_note_of_the_sources_is_made_anew(kept, damage):
    """What is noted of the sources is trusted no more than the code, and its loss costs no code."""
    (note,) = kept[1].glob("sources-*")
    damage(note)
    found, said = ran(*kept)
    assert (found, said.count("CompiledCodeWarning: ")) == (f"{RIGHT} 1", 1)
    assert sorted(kept[1].glob("*")) == sorted([note, *kept[1].glob("kernels-*")])
    assert checked_file.read_checked(note, "sources")


def test_everything_damaged_is_said_once(kept):
    """A folder whose files are all bad gives one line."""
    for file in [*kept[1].glob("sources-*"), *kept_in(kept[1])]:
        file.write_bytes(b"")
    found, said = ran(*kept)
    assert (found, said.count("CompiledCodeWarning: ")) == (f"{RIGHT} 0", 1)


def test_code_of_another_key_is_none_of_this(kept, tmp_path):
    """A whole file of another version's folder in this one's place is damage."""
    other = written(tmp_path / "other")
    (other / "small_numbers.py").write_text("BASE = 3.0\n")
    (own,) = kept_in(kept[1])
    ran(other, kept[1])
    (others,) = set(kept_in(kept[1])) - {own}
    own.write_bytes(others.read_bytes())
    assert ran(*kept)[0] == f"{RIGHT} 0"


def test_a_folder_that_cannot_be_made(program, tmp_path):
    """Then it compiles without keeping anything, anywhere, and says so."""
    (tmp_path / "file").touch()
    before = sorted(program.rglob("*.nb?"))
    for _ in range(2):
        found, said = ran(program, tmp_path / "file" / "cache", HOME=str(tmp_path / "home"))
        assert (found, said.count("CompiledCodeWarning: compiled code is not kept")) == (f"{RIGHT} 0", 1)
    assert sorted(program.rglob("*.nb?")) == before
    assert not (tmp_path / "home").exists()


def test_numbas_own_choice_of_a_folder_has_no_part(program, cache):
    """Options of numba's for other folders lead to none."""
    found, said = ran(program, cache, NUMBA_CACHE_LOCATOR_CLASSES="InTreeCacheLocator")
    assert (found, said) == (f"{RIGHT} 0", "")
    assert list(program.rglob("*.nb?")) == []
    assert len(kept_in(cache)) == 1


def test_the_cache_folder_is_that_of_the_start(program, tmp_path):
    """A relative NUMBA_CACHE_DIR is one of the folder that the process began in."""
    code = f"import os; os.chdir({str(tmp_path)!r}); import small; os.chdir('/'); small.entry(2.0)"
    ended(started(program, Path("relative"), code=code))
    assert len(kept_in(tmp_path / "relative")) == 1


@pytest.mark.parametrize("written_bytes", [0, 40])
def test_a_full_disk_leaves_nothing(tmp_path, monkeypatch, written_bytes):
    """A file that cannot be written to its end is not there, and the one that was there before still is."""
    file = tmp_path / "folder" / "file"
    checked_file.write_checked(file, "test", b"before")
    whole = Path.write_bytes

    def full(path: Path, data: bytes) -> None:
        whole(path, data[:written_bytes])
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OSError, match="No space"):
        checked_file.write_checked(file, "test", b"after")
    assert checked_file.read_checked(file, "test") == b"before"
    assert list(file.parent.iterdir()) == [file]


def test_each_kind_of_note_once(monkeypatch):
    """A process warns once of damage and once of what is not kept."""
    monkeypatch.setattr(notes, "_said", set())

    def said_thrice() -> None:
        for _ in range(3):
            notes.say_not_kept("the disk is full")
            notes.discard(Path("nowhere"), "empty")

    with pytest.warns(CompiledCodeWarning) as warned:
        said_thrice()
    assert [str(warning.message) for warning in warned] == [
        "compiled code is not kept, so the next run compiles it anew: the disk is full",
        "nowhere: damaged (empty): thrown away and made anew",
    ]


def test_a_line_of_the_command_spells_a_name_that_is_no_text(monkeypatch):
    """A folder's name need not be text; another warning than these is none of the command's lines."""
    monkeypatch.setattr(warnings, "formatwarning", warnings.formatwarning)
    with warnings.catch_warnings():
        notes.tell_in_lines()
        line = warnings.formatwarning(CompiledCodeWarning("a\udcff"), CompiledCodeWarning, "file", 1)
        other = warnings.formatwarning(UserWarning("b"), UserWarning, "file", 1)
    assert line == "pvlvrt-check: a\\xff\n"
    assert other.startswith("file:1: UserWarning: b")


def test_any_number_of_commands_in_one_process(monkeypatch):
    """A warning goes through as many functions after a thousand commands as after the first."""
    monkeypatch.setattr(warnings, "formatwarning", warnings.formatwarning)
    with warnings.catch_warnings():
        notes.tell_in_lines()
        once = warnings.formatwarning
        for _ in range(2000):
            notes.tell_in_lines()
    assert warnings.formatwarning is once
