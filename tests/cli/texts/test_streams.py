"""Streams: any encoding, a terminal, and lines that only the stream makes."""

import ast
import io
import os
import warnings
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from unittest import mock

import pytest

import pvlvrt_compliance.cli as package
import worst
from consoles import surroundings
from pvlvrt_compliance.cli.guarding import guarded
from pvlvrt_compliance.cli.main import run
from pvlvrt_compliance.cli.telling import screen, tell
from pvlvrt_compliance.compiled.notes import tell_in_lines
from pvlvrt_compliance.errors import KeptFileWarning
from sending import DOORS
from terminals import at_terminal

COMMANDS = {
    "main help": (("--help",), 0),
    "help of a group": (("profiles", "--help"), 0),
    "help of a command": (("compare", "--help"), 0),
    "version": (("--version",), 0),
    "list": (("--profile", "es-po-12.3", "--list"), 0),
    "list of json": (("--profile", "es-po-12.3", "--list", "--json"), 0),
    "profiles list": (("profiles", "list"), 0),
    "profiles show": (("profiles", "show", "dk-rfg"), 0),
    "profiles show json": (("profiles", "show", "dk-rfg", "--json"), 0),
    "profiles check": (("profiles", "check", "iec61400-21"), 0),
    "profiles new": (("profiles", "new"), 0),
    "profiles schema": (("profiles", "schema"), 0),
    "schema": (("schema",), 0),
    "completion": (("completion", "zsh"), 0),
    "header": (("controllers", "header"), 0),
    "inspect": (("controllers", "inspect", "é测.py:Ω"), 2),
    "config show": (("config", "show", "--report-field", "client=é测"), 0),
    "config show json": (("config", "show", "--json", "--report-field", "client=é测"), 0),
    "an error": (("--profile", "é测"), 2),
    "a missing baseline": (("baseline", "update", "é测", "--results", "é测"), 2),
    "nothing to compare": (("compare", "é测/a", "é测/b"), 2),
    "nothing to merge": (("merge", "é测"), 2),
}


def _encoded(words, encoding):
    """Status and bytes of a command on streams of an encoding that take nothing else."""
    out, err = (io.TextIOWrapper(io.BytesIO(), encoding=encoding, write_through=True) for _ in range(2))
    with (
        mock.patch.dict(os.environ, surroundings({}), clear=True),
        redirect_stdout(out),
        redirect_stderr(err),
    ):
        status = run(words)
    assert (out.errors, err.errors) == ("strict", "strict")  # whoever lends a stream has it back as it was
    return status, out.buffer.getvalue().decode(encoding), err.buffer.getvalue().decode(encoding)


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "latin-1", "utf-8"])
@pytest.mark.parametrize("command", COMMANDS)
def test_any_encoding(tmp_path, monkeypatch, command, encoding):
    """What an encoding lacks is replaced; all else is there, and the status is that of any other stream."""
    monkeypatch.chdir(tmp_path)
    words, status = COMMANDS[command]
    ended, out, err = _encoded(words, encoding)
    assert (ended, "Traceback" in out + err) == (status, False)
    _, full, told = _encoded(words, "utf-8")
    letters = str.maketrans(dict.fromkeys("─│╭╮╰╯┼╴╶…", " "))
    for got, whole in ((out, full), (err, told)):
        assert len(got) >= 0.5 * len(whole.translate(letters).strip())


@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
def test_a_run_in_any_encoding(tmp_path, encoding):
    """Tables and reasons have other letters on the stream; the files are UTF-8 whatever it is."""
    fields = ("--report-field", "client=é测试Ω")
    out = tmp_path / "out"
    ended, said, err = _encoded(["--profile", "iec61400-21", "--sag", "90%", "--output", str(out), *fields], encoding)
    assert (ended, err) == (0, "")
    assert "ride_through" in said
    assert "é测试Ω" in worst.text_of(out / "report.html")
    assert "é测试Ω" in worst.text_of(out / "results.json")


def test_a_program_in_a_locale_without_letters(program):
    """LC_ALL=C without Python's own remedies: names of files and streams are ASCII then."""
    bare = {"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}
    for words in (("profiles", "list"), ("profiles", "show", "dk-rfg"), ("--profile", "é测", "--list")):
        ended = program(*words, **bare)
        assert ended.status == (2 if "é测" in words else 0)
        assert (ended.out + ended.err).isascii()
        assert "Traceback" not in ended.err


@pytest.mark.skipif(os.name == "nt", reason="Windows has no pseudo-terminals of this kind")
@pytest.mark.slow
@pytest.mark.parametrize("encoding", ["utf-8", "ascii"])
def test_a_terminal(tmp_path, encoding):
    """Between the sequences that colour the table and move the bar there is none of a controller's."""
    sends = DOORS["python"](tmp_path)
    words = ("--sag", "50%", "--set", "simulation.settling_s=0.05", *sends.failing, "--output", str(tmp_path / "out"))
    status, seen = at_terminal(*words, cwd=tmp_path, PYTHONIOENCODING=encoding)
    assert status == 3
    bare = worst.of_a_terminal(seen)
    assert "1/1" in bare or "0/1" in bare
    assert "[bold]" in bare.replace("\n", "")
    assert encoding == "ascii" or worst.MARK in bare
    assert encoding != "ascii" or bare.isascii()


def test_a_line_that_folding_begins():
    """A text that begins a line only because the one before is full commands nobody either."""
    out = io.StringIO()
    with redirect_stdout(out), guarded():
        wide = screen()
        wide.width = 20
        wide.print(f"{'x' * 18} ::error::x {'y' * 18} ##[error]z")
    worst.seen(out.getvalue())
    assert ": :error" in out.getvalue()


@pytest.mark.parametrize("category", [KeptFileWarning, UserWarning])
def test_warnings(category):
    """A warning, of ours or of a library, is lines of text as anything else is."""
    kept = warnings.formatwarning
    try:
        with warnings.catch_warnings():
            tell_in_lines()
            said = warnings.formatwarning(category(worst.WORST), category, worst.NAME, 1)
    finally:
        warnings.formatwarning = kept
    worst.of_a_terminal(said)
    assert worst.MARK in said


OWNERS = {"telling.py", "flushing.py"}


@pytest.mark.parametrize("word", ["\n::set-output name=x::y", "a\u2029b", "a\n\n b", "\r\npvlvrt-check: PASS"])
def test_no_line_of_a_name_passes_for_ours(word):
    """A name may have lines; every one after the first stands further in, as lines of a message do."""
    with redirect_stderr(io.StringIO()) as said:
        tell(f"{word}: cannot be read: No such file or directory")
    first, *more = said.getvalue().removesuffix("\n").split("\n")
    assert first.startswith("pvlvrt-check:")
    assert all(line.startswith("  ") and line.strip() for line in more)


def test_nothing_else_prints():
    """In the room of the command one file prints, and makes what rich prints on; another hands over what is kept."""
    folder = Path(package.__file__).parent
    for file in folder.rglob("*.py"):
        called = {
            node.func.id
            for node in ast.walk(ast.parse(file.read_text("utf-8")))
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
        }
        assert file.name in OWNERS or not called & {"print", "Console"}, file
