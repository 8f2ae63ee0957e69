"""What the program says without typer is what it says with it, to the byte."""

import contextlib
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from consoles import surroundings
from pvlvrt_compliance import cache
from pvlvrt_compliance.cli import at_once, kept_help, main, start
from waiting import PATIENCE_S

ENTRY = (sys.executable, "-m", "pvlvrt_compliance")
DRAWN = (sys.executable, "-m", "pvlvrt_compliance.cli.main")
POSIX = pytest.mark.skipif(os.name == "nt", reason="Windows has no pseudo-terminals of this kind, nor /dev/full")
COLOURS = {"FORCE_COLOR": "1", "TERM": "xterm-256color", "COLORTERM": "truecolor"}
LOADED = """
import sys, pvlvrt_compliance.__main__ as program
sys.argv[1:] = {words!r}
try:
    program.main()
finally:
    print(*sorted(sys.modules), file=sys.stderr)
"""


@pytest.fixture(autouse=True)
def folder(monkeypatch, tmp_path):
    """A folder of its own for what is kept."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    return tmp_path / "cache"


def kept(folder):
    """The helps that are kept."""
    return sorted(folder.glob("help-*"))


def ended(program, *words, stdout=subprocess.PIPE, **environment):
    """Status, output and errors of a program, in bytes."""
    done = subprocess.run(
        [*program, *words],
        env=surroundings(environment),
        stdin=subprocess.DEVNULL,
        stdout=stdout,
        stderr=subprocess.PIPE,
        timeout=PATIENCE_S,
        check=False,
    )
    return done.returncode, done.stdout, done.stderr


def loaded_by(*words):
    """Modules that are loaded when the program has ended."""
    status, _, err = ended((sys.executable, "-c", LOADED.format(words=list(words))))
    assert status == 0
    return set(err.decode().split())


def test_the_version_by_both_ways(command, folder):
    """One text, whether typer reads the line or nobody; where more is asked for typer does."""
    words = f"{at_once.version()}\n"
    assert command("--version") == (0, words, "")
    assert ended(ENTRY, "--version") == (0, words.encode(), b"")
    assert ended(ENTRY, "--version", "--quiet") == ended(DRAWN, "--version", "--quiet") == (0, words.encode(), b"")
    assert not folder.exists()


@pytest.mark.parametrize("words", [("--version",), ("--help",), ("profiles", "list", "-h")], ids=" ".join)
def test_what_is_said_at_once_loads_no_typer(words):
    """The version, and a help that is kept, need neither typer nor what draws."""
    ended(ENTRY, *words)
    assert not loaded_by(*words) & {"typer", "rich", "click", "pvlvrt_compliance.cli.main", "importlib.metadata"}


@pytest.mark.parametrize(
    ("words", "environment"),
    [
        *((("--help",), {"COLUMNS": width, **more}) for width in ("40", "80", "131") for more in ({}, COLOURS)),
        (("--help",), {"PYTHONIOENCODING": "ascii"}),
        (("--help",), {"GITHUB_ACTIONS": "true"}),
        (("--help",), {"PYTHONOPTIMIZE": "2"}),
        (("--help",), {"TYPER_USE_RICH": "0"}),
        (("-h",), {"TERMINAL_WIDTH": "60", "NO_COLOR": "1", **COLOURS}),
        (("profiles", "--help"), COLOURS),
        (("profiles", "list", "-h"), {}),
        (("compare", "--help"), COLOURS),
    ],
    ids=str,
)
def test_a_help_is_typers_to_the_byte(folder, words, environment):
    """Drawn by typer alone, drawn and kept, found again: the same bytes, in any width and colour."""
    drawn = ended(DRAWN, *words, **environment)
    assert kept(folder) == []
    assert ended(ENTRY, *words, **environment) == drawn
    assert len(kept(folder)) == 1
    assert ended(ENTRY, *words, **environment) == drawn
    assert len(kept(folder)) == 1
    assert drawn[0] == 0
    assert (b"\x1b[" in drawn[1]) == ("FORCE_COLOR" in environment or "GITHUB_ACTIONS" in environment)


def _read(end: int) -> bytes:
    """All that comes to one end of a terminal until the other is closed."""
    said = b""
    with contextlib.suppress(OSError):  # Linux says so when it is
        while chunk := os.read(end, 65536):
            said += chunk
    return said


@POSIX
@pytest.mark.parametrize("columns", [60, 100])
def test_a_help_fits_the_terminal_that_it_is_read_in(folder, columns):
    """The width and the colours of a terminal count, and its help is none of a pipe."""
    import fcntl
    import pty
    import struct
    import termios

    def seen(program):
        ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 40, columns, 0, 0))
        with ThreadPoolExecutor(1) as beside:  # a terminal that nobody reads holds some 4000 characters
            said = beside.submit(_read, ours)
            ended(program, "compare", "--help", stdout=theirs, TERM="xterm-256color")
            os.close(theirs)
        os.close(ours)
        return said.result()

    drawn = seen(DRAWN)
    assert b"\x1b[" in drawn
    assert [seen(ENTRY), seen(ENTRY)] == [drawn, drawn]
    piped = ended(ENTRY, "compare", "--help", TERM="xterm-256color")
    assert b"\x1b[" not in piped[1]
    assert len(kept(folder)) == 2


_READS = """
import os
read = set()
class Noting(type(os.environ)):
    def __getitem__(self, name):
        read.add(f"variable {name}")
        return super().__getitem__(name)
os.environ.__class__ = Noting
sys.addaudithook(lambda event, told: read.add(f"file {told[0]}") if event == "open" else None)
import atexit
atexit.register(lambda: print(*sorted(read), sep="\\n", file=sys.stderr))
"""

_OF_NO_HELP = {
    *("_TYPER_STANDARD_TRACEBACK", "TYPER_STANDARD_TRACEBACK"),  # of a crash
}


@pytest.mark.parametrize("words", [("--help",), ("profiles", "--help"), ("controllers", "new", "--help")], ids=" ".join)
def test_a_help_is_drawn_from_nothing_but_what_it_goes_by(words):
    """What is read while typer draws a help is code, and of the environment what its name counts."""
    code = (
        f"import sys\nsys.argv[1:] = {list(words)!r}\n{_READS}\nfrom pvlvrt_compliance.cli.main import main\nmain()\n"
    )
    status, _, err = ended((sys.executable, "-c", code), **COLOURS)
    assert status == 0
    read = {kind: set() for kind in ("variable", "file")}
    for line in err.decode().splitlines():
        kind, _, name = line.partition(" ")
        read[kind].add(name)
    assert {"COLUMNS", "TERM", "FORCE_COLOR"} <= read["variable"]
    others = read["variable"] - {*kept_help.VARIABLES} - _OF_NO_HELP
    assert not {name for name in others if not name.endswith("_COMPLETE")}  # typer names it by the command
    assert not [name for name in read["file"] if Path(name).suffix not in (".py", ".pyc", ".so", ".pyd")]


@pytest.mark.parametrize("variable", kept_help.VARIABLES)
def test_a_help_goes_by_each_variable(monkeypatch, variable):
    """Set, set otherwise and not set are three surroundings."""
    monkeypatch.delenv(variable, raising=False)
    names = [kept_help.name_of(["--help"])]
    for value in ("", "1"):
        monkeypatch.setenv(variable, value)
        names.append(kept_help.name_of(["--help"]))
    assert len({*names}) == 3


def test_a_help_goes_by_the_words_and_by_every_file(monkeypatch, tmp_path):
    """An edit, another file and another command are another help; bytecode beside the sources is none."""
    package = tmp_path / "drawing"
    (package / "part").mkdir(parents=True)
    (package / "__init__.py").write_text("")
    source = package / "part" / "source.py"
    source.write_text("a = 1\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(kept_help, "_DRAWN_BY", ("drawing", "not_installed_at_all"))
    names = [kept_help.name_of(["--help"]), kept_help.name_of(["a", "--help"])]
    (package / "__pycache__").mkdir()
    (package / "__pycache__" / "source.pyc").write_bytes(b"")
    assert kept_help.name_of(["--help"]) == names[0]
    os.utime(source, ns=(1, 1))
    names.append(kept_help.name_of(["--help"]))
    (package / "other.toml").write_text("")
    names.append(kept_help.name_of(["--help"]))
    assert len({*names}) == 4


def test_no_help_is_kept_where_more_than_its_name_decides(monkeypatch):
    """Without a standard output, and on Windows, whose consoles differ, each is drawn anew."""
    assert kept_help.name_of(["--help"])
    monkeypatch.setattr(sys, "platform", "win32")
    assert not kept_help.name_of(["--help"])
    monkeypatch.undo()
    monkeypatch.setattr(sys, "stdout", None)
    assert not kept_help.name_of(["--help"])


def test_a_damaged_help_is_drawn_anew(folder):
    """What is kept is trusted no further than its digest; that it was thrown away is a line of the command."""
    drawn = ended(ENTRY, "compare", "--help")
    (file,) = kept(folder)
    whole = file.read_bytes()
    file.write_bytes(whole[:-1] + b"?")
    status, out, err = ended(ENTRY, "compare", "--help")
    assert (status, out) == drawn[:2]
    assert err.startswith(f"pvlvrt-check: {file}: damaged (".encode())
    assert file.read_bytes() == whole


def test_a_help_needs_no_folder(tmp_path):
    """Where nothing can be kept it is drawn each time, and nothing is said of it."""
    (tmp_path / "file").touch()
    drawn = ended(DRAWN, "compare", "--help")
    assert drawn[0::2] == (0, b"")
    for _ in range(2):
        assert ended(ENTRY, "compare", "--help", NUMBA_CACHE_DIR=str(tmp_path / "file" / "none")) == drawn


def test_no_help_of_what_there_is_not(folder):
    """A word that is no command is refused as ever."""
    for _ in range(2):
        status, out, err = ended(ENTRY, "kompare", "--help")
        assert (status, out) == (2, b"")
        assert b"did you mean" in err
    assert kept(folder) == []


@POSIX
@pytest.mark.parametrize("words", [("--version",), ("compare", "--help")], ids=" ".join)
def test_what_cannot_be_written_is_said(folder, words):
    """A full disk is the status of what cannot be written, by both ways; half a help is not kept."""
    said = b"pvlvrt-check: standard output cannot be written: No space left on device\n"
    with Path("/dev/full").open("wb") as full:
        assert ended(DRAWN, *words, stdout=full) == ended(ENTRY, *words, stdout=full) == (3, None, said)
        assert kept(folder) == []
        ended(ENTRY, *words)
        assert ended(ENTRY, *words, stdout=full) == (3, None, said)
        assert ended(ENTRY, *words, stdout=full, PYTHONUNBUFFERED="1") == (3, None, said)


@POSIX
@pytest.mark.parametrize("words", ["--version", "compare --help"])
def test_a_reader_that_has_gone_is_no_error(words):
    """As with everything else that the command prints."""
    ended(ENTRY, *words.split())
    line = f'( "{sys.executable}" -m pvlvrt_compliance {words}; echo $? >&2 ) | true'
    for unbuffered in ("", "1"):
        done = ended(("bash", "-c", f"exec 3>&2; {line}"), PYTHONUNBUFFERED=unbuffered)
        assert done == (0, b"", b"0\n")


def test_a_shell_that_asks_is_answered():
    """Words that would act at once are completed like all others."""
    asked = {"_PVLVRT_CHECK_COMPLETE": "complete_fish", "_TYPER_COMPLETE_ARGS": "pvlvrt-check --vers"}
    asked["_TYPER_COMPLETE_FISH_ACTION"] = "get-args"
    assert ended(ENTRY, "--version", **asked)[1].startswith(b"--version")


@pytest.mark.parametrize("words", [["--version"], ["compare", "--help"]], ids=" ".join)
def test_within_a_process(monkeypatch, capsys, command, words):
    """The same, where every line is counted."""
    monkeypatch.setattr(main, "become_the_command", lambda: None)
    monkeypatch.setattr(main, "tell_in_lines", lambda: None)
    monkeypatch.setattr("pvlvrt_compliance.compiled.notes.tell_in_lines", lambda: None)
    monkeypatch.setattr(main, "leave", sys.exit)
    monkeypatch.setattr(sys, "argv", ["pvlvrt-check", *words])
    for name in kept_help.VARIABLES:
        monkeypatch.delenv(name, raising=False)
    expected = command(*words)
    for _ in range(2):
        with pytest.raises(SystemExit) as end:
            start.main()
        assert (end.value.code, *capsys.readouterr()) == expected
    assert cache.cache_root().is_dir() == ("--help" in words)
