"""Help, version, and what the command does not load for them."""

import importlib.metadata
import subprocess
import sys

import pytest
import typer

from pvlvrt_compliance.cli.main import _commands_for, app
from pvlvrt_compliance.cli.typed import read_what_is_given
from pvlvrt_compliance.results.files import BASELINE, FOLDER


def commands(group=None, words=()):
    """Every command and group, by the words that call it."""
    group = group or typer.main.get_command(app)
    yield words
    for name, command in getattr(group, "commands", {}).items():
        yield from commands(command, (*words, name))


@pytest.mark.parametrize(
    ("words", "terminal"),
    [*((words, {}) for words in commands()), ((), {"TERM": "dumb"}), ((), {"NO_COLOR": "1"})],
    ids=str,
)
def test_every_help_has_an_example_and_fits(command, words, terminal):
    """Wherever one asks for help there is a line to begin with, within 80 columns, and no markup that was not read."""
    ended = command(*words, "--help", **terminal)
    assert (ended.status, ended.err) == (0, "")
    assert f"pvlvrt-check {' '.join(words)}".strip() in " ".join(ended.out.partition("Example")[2].split())
    assert max(map(len, ended.out.splitlines())) <= 80
    shown = ended.out.replace("[[events]]", "")
    assert not [mark for mark in ("\x1b", "[]", "[/", "[bold", "[[", "\\[") if mark in shown]


def test_help_has_an_example_and_the_exit_statuses(command):
    """A reader of the help can run the main job and gate on its end."""
    ended = command("--help")
    assert (ended.status, ended.err) == (0, "")
    words = " ".join(ended.out.split())
    assert "Example: pvlvrt-check --profile iec61400-21 --sag 90%" in words
    assert "0 all passed, 1 a check failed, 2 wrong usage or profile, 3 something could not be" in words
    assert "simulated, evaluated or written, or nothing was judged, 130 interrupted," in words
    assert "143 terminated (SIGTERM)." in words


def test_help_fits_80_columns(command):
    """No line of the help is cut or wrapped by a terminal of 80 columns."""
    assert max(map(len, command("--help").out.splitlines())) <= 80


def test_brackets_of_a_help_text_are_shown(command):
    """What stands in brackets is no markup: the table of a file of events is named as it is written."""
    assert "a TOML file with [[events]]." in " ".join(command("--help", COLUMNS="200").out.split())


@pytest.mark.parametrize(
    "option",
    [
        *("--profile", "--sag", "--phases", "--two-phase", "--duration", "--point-on-wave", "--irradiance"),
        *(
            "--frequency",
            "--temperature",
            "--scr",
            "--xr",
            "--fidelity",
            "--set",
            "--test",
            "--list",
            "--output",
            "--csv",
        ),
        *("--allow-unjudged", "--exit-zero", "--quiet", "--version"),
    ],
)
def test_help_names_every_option(command, option):
    """Each option stands in the help."""
    assert f"{option} " in command("--help").out


def test_help_of_the_schema(command):
    """A subcommand has help with an example of its own."""
    ended = command("schema", "--help")
    assert ended.status == 0
    assert "pvlvrt-check schema >" in ended.out


def test_defaults_in_the_helps_are_those_of_the_code(command):
    """Help loads no results, so it spells the names of files itself; they are the right ones."""
    words = " ".join(command("baseline", "update", "--help", COLUMNS="200").out.split())
    assert f"Default {BASELINE}." in words
    assert f"Default {FOLDER}." in words
    assert f"Default {FOLDER}." in " ".join(command("--help", COLUMNS="200").out.split())


def test_version(command):
    """The version is the one of the installed distribution."""
    assert command("--version") == (0, f"pvlvrt-check {importlib.metadata.version('pvlvrt-compliance')}\n", "")


@pytest.mark.parametrize(
    "arguments",
    [["--help"], ["--version"], ["schema"], ["--profile", "iec61400-21", "--list"], ["--profile", "x", "--sag", "9%"]],
    ids=lambda a: a[-1],
)
def test_no_compiler_is_loaded_without_a_simulation(arguments):
    """Help, lists and refusals import neither numba nor scipy nor plotly."""
    script = (
        "import sys\n"
        "from pvlvrt_compliance.cli.main import run\n"
        f"run({arguments!r})\n"
        "print(sorted({'numba', 'scipy', 'plotly', 'pandas'} & set(sys.modules)), file=sys.stderr)\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stderr.splitlines()[-1] == "[]"


@pytest.mark.parametrize(
    ("words", "read"),
    [
        ("--sag 90% --profile=x", ["profiles", "sag"]),
        *((words, None) for words in ("-v", "-vq", "--help", "--sag 9% -h")),
        ("baseline update", ["file"]),  # an argument may be any word
        ("baseline update --no-margins mine.txt", ["file", "margins"]),
    ],
)
def test_a_command_reads_what_is_given(words, read):
    """Typer makes a validator for each parameter that it reads; help, and several options in a word, need all."""
    command, words = typer.main.get_command(app), words.split()
    while words[0] in getattr(command, "commands", {}):
        command, words = command.commands[words[0]], words[1:] or [""]
    everything = command.params
    read_what_is_given(command, words)
    assert [param.name for param in command.params] == (read or [param.name for param in everything])
    assert command.add_help_option == (read is None)


def found(command, words):
    """A command within others, by the words that call it."""
    for word in words:
        command = command.commands[word]
    return command


@pytest.mark.parametrize("words", [words for words in commands() if words], ids=" ".join)
def test_a_command_is_the_same_without_the_others(words):
    """What a line calls is made without the commands that it does not: the same options, in the same words."""
    alone, among_all = found(_commands_for(words), words), found(typer.main.get_command(app), words)
    assert list(_commands_for(words).commands) == [words[0]]
    assert (alone.name, alone.help, alone.short_help) == (among_all.name, among_all.help, among_all.short_help)
    assert list(getattr(alone, "commands", {})) == list(getattr(among_all, "commands", {}))
    for one, other in zip(alone.params, among_all.params, strict=True):
        for name in ("name", "opts", "secondary_opts", "help", "metavar", "required", "multiple", "nargs", "hidden"):
            assert getattr(one, name, None) == getattr(other, name, None), (one.name, name)


@pytest.mark.parametrize("words", [[], ["--version"], ["--sag", "90%"], ["kompare"], ["check"]], ids=" ".join)
def test_all_commands_are_there_where_none_is_named(words):
    """Whatever else begins a line is for the main command, or to be refused by what there is."""
    assert list(_commands_for(words).commands) == list(typer.main.get_command(app).commands)
