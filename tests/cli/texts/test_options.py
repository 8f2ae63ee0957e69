"""Whatever is typed: each option and argument of each command takes the worst text, and the answer is lines of text."""

import os

import pytest
import typer

import worst
from pvlvrt_compliance.cli.main import app
from tests.hostile.options import ONLY

MAIN = ("--profile", "iec61400-21", "--sag", "90%", "--list")
BESIDE = {
    (): MAIN,
    ("compare",): ("old", "new"),
    ("merge",): ("part",),
    ("schema",): (),
    ("completion",): (),
    ("profiles", "list"): (),
    ("profiles", "show"): (),
    ("profiles", "check"): (),
    ("profiles", "plot"): ("iec61400-21",),
    ("profiles", "new"): (),
    ("profiles", "schema"): (),
    ("controllers", "inspect"): ("absent.py:Controller",),
    ("controllers", "replay"): ("absent.so", "--inputs", "absent.csv"),
    ("controllers", "header"): (),
    ("controllers", "new"): ("begun",),
    ("config", "show"): (),
    ("baseline", "update"): (),
}
"""Arguments that a command needs besides an option, for every command that there is."""

TEXTS = {"long": f"{worst.IN_C}\udcff{'x' * 30_000}", "short": f"{worst.NAME}\udcff"}


def commands(command, path=()):
    """Every command with the words that call it."""
    children = getattr(command, "commands", {})
    if not children or not path:
        yield path, command
    for name, child in children.items():
        yield from commands(child, (*path, name))


ALL = dict(commands(typer.main.get_command(app)))


def words_of(path, param, text):
    """A command line in which a parameter is a text."""
    if param.param_type_name == "argument":
        return (*path, *BESIDE[path][1:], text) if BESIDE[path] else (*path, text)
    return (*path, *BESIDE[path], f"{param.opts[0]}={text}")


CASES = [
    pytest.param(path, param, id=" ".join([*path, param.name]))
    for path, command in ALL.items()
    for param in command.params
    if param.param_type_name == "argument" or not (param.is_flag or param.count)
]


def test_no_command_is_left_out():
    """Whoever adds a command says here what it needs; its options are found."""
    assert set(BESIDE) == set(ALL)
    assert len(CASES) > 80


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """A folder of its own: some of what is typed is the name of a file that is written."""
    monkeypatch.chdir(tmp_path)


@pytest.mark.usefixtures("elsewhere")
@pytest.mark.parametrize("which", TEXTS)
@pytest.mark.parametrize(("path", "param"), CASES)
def test_an_option(command, path, param, which):
    """A documented status, and a few lines in which nothing is obeyed."""
    ended = command(*words_of(path, param, TEXTS[which]))
    assert ended.status in (0, 1, 2, 3)
    worst.of_a_terminal(ended.out)
    worst.of_a_terminal(ended.err)
    assert "Traceback" not in ended.err
    assert len(ended.err) < 4 * worst.LONGEST


@pytest.mark.usefixtures("elsewhere")
@pytest.mark.parametrize("words", [(TEXTS["long"],), ("--" + TEXTS["long"],), ("profiles", TEXTS["long"])])
def test_a_word_that_is_nothing(command, words):
    """Neither an option nor a command."""
    ended = command(*words)
    assert (ended.status, ended.out) == (2, "")
    worst.of_a_terminal(ended.err)
    assert worst.MARK in ended.err


@pytest.mark.usefixtures("elsewhere")
@pytest.mark.parametrize("of", ["sag", "profile", "set", "controller", "config", "report_field", "test", "jobs"])
def test_a_variable(command, of):
    """What stands in the environment is what somebody has typed elsewhere."""
    text = TEXTS["long"].replace("\0", "")
    for words in (MAIN, ("config", "show"), ("config", "show", "--json")):
        ended = command(*words, **{f"PVLVRT_{of.upper()}": text})
        assert ended.status in (0, 2)
        worst.of_a_terminal(ended.out)
        worst.of_a_terminal(ended.err)


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such names")
@pytest.mark.usefixtures("elsewhere")
def test_what_is_taken(command, tmp_path):
    """Fields of the title page and names of folders are in every report, and the command that made them."""
    fields = worst.IN_TOML.replace("\n", " ")[:900]
    out = tmp_path / worst.NAME
    formats = [word for name in ("markdown", "github", "gitlab", "verdicts", "badge") for word in ("--format", name)]
    words = ("--profile", "iec61400-21", "--sag", "90%", "--output", out, "--csv", *formats)
    ended = command(*words, "--report-field", f"client={fields}", "--report-field", f"remark={fields}")
    assert (ended.status, ended.err) == (0, "")
    worst.of_a_terminal(ended.out)
    assert f"{worst.MARK}\\x1b[2J" in ended.out
    read = {file.name: worst.text_of(file) for file in out.rglob("*") if file.is_file()}
    for file in ("report.html", "results.json"):
        assert read[file].count(worst.MARK) > 2, file


@pytest.mark.parametrize("address", ONLY["--cluster"], ids=range(len(ONLY["--cluster"])))
def test_an_address_of_no_cluster(command, tmp_path, address):
    """Where a run would ask it, it is refused with one line of text, and nothing is simulated or written."""
    pytest.importorskip("distributed", reason="the extra cluster is not installed")
    run = ("--profile", "iec61400-21", "--sag", "90%", "--output", tmp_path / "out")
    ended = command(*run, f"--cluster={address}".replace("\x00", ""))
    assert (ended.status, ended.out) == (2, "")
    worst.of_a_terminal(ended.err)
    assert ended.err.startswith("pvlvrt-check: ")
    assert ended.err.count("\n") == 1
    assert not (tmp_path / "out").exists()
