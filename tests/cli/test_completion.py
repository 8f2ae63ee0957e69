"""What a shell is told when somebody presses the tabulator key."""

import shutil
import subprocess
import sys
from typing import get_args

import pytest

from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
from pvlvrt_compliance.cli.completion import values
from pvlvrt_compliance.cli.completion.asking import completer
from pvlvrt_compliance.cli.completion.scripts import ASKED_BY, SHELLS
from pvlvrt_compliance.cli.options import OPTIONS
from pvlvrt_compliance.data.search_path import known_profiles
from pvlvrt_compliance.profile.loading import load_profile
from pvlvrt_compliance.scenario.sag import PhaseNames
from pvlvrt_compliance.simulation.parameters import OF_THE_HOST, Fidelity, parameter_names

IEC = ("--profile", "iec61400-21")


@pytest.fixture
def offered(command):
    """Words that fish would offer at the end of a line, with their meaning: ``offered(line) -> {word: meaning}``."""

    def offered(line, **environment):
        asked = {ASKED_BY: "complete_fish", "_TYPER_COMPLETE_FISH_ACTION": "get-args", "_TYPER_COMPLETE_ARGS": line}
        ended = command(**asked, **environment)
        assert (ended.status, ended.err) == (0, "")
        pairs = [answer.partition("\t") for answer in ended.out.splitlines() if answer]
        return {word: meaning for word, _, meaning in pairs}

    return offered


def test_names_of_profiles_with_their_titles(offered):
    """Each known profile and `all` may follow, and what is begun narrows them."""
    found = offered("pvlvrt-check --profile ")
    assert set(known_profiles()) | {"all"} <= set(found)
    assert found["spain-q-curve"] == load_profile("spain-q-curve", INSTALLED_KINDS).title
    assert set(offered("pvlvrt-check --profile dk-")) == {name for name in known_profiles() if name.startswith("dk-")}


def test_files_that_may_be_profiles(offered, tmp_path, monkeypatch):
    """A file in TOML is offered as its path begins, here or in a folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "codes").mkdir()
    for name in ("mine.toml", "mine.txt", "codes/other.toml"):
        (tmp_path / name).write_text("")
    assert set(offered("pvlvrt-check profiles check mi")) == {"mine.toml"}
    assert set(offered("pvlvrt-check --profile codes/")) == {"codes/other.toml"}


def test_tests_of_the_profiles_on_the_line(offered):
    """Behind --test stand the tests of just those profiles, each with its title."""
    found = offered("pvlvrt-check --profile iec61400-21 --test VD3-f")
    cases = load_profile("iec61400-21", INSTALLED_KINDS).tests()
    assert found.items() >= {case.id: case.title for case in cases if case.id.startswith("VD3-f")}.items()
    assert all(word.startswith("VD3-f") for word in found)
    assert offered("pvlvrt-check --profile iec61400-21 --test VD3")["VD3"] == "all runs of VD3"
    assert offered("pvlvrt-check --test V") == {}
    several = offered("pvlvrt-check --profile iec61400-21 --profile nerc-prc-029 --test ")
    wanted = {
        case.id for name in ("iec61400-21", "nerc-prc-029") for case in load_profile(name, INSTALLED_KINDS).tests()
    }
    assert wanted <= set(several)


def test_whatever_is_offered_as_a_test_selects_one(offered, command):
    """Each word behind --test is one that the command takes."""
    for word in list(offered("pvlvrt-check --profile spain-q-curve --profile rey-boue-500kva --test "))[::6]:
        assert command("--profile", "rey-boue-500kva", "--list", "--test", word).status == 0


def test_parameters_and_their_words(offered):
    """Every parameter may follow --set, with its default; behind the equals sign stand the words that it takes."""
    assert {word.removesuffix("=") for word in offered("pvlvrt-check --set ")} == set(parameter_names())
    assert offered("pvlvrt-check --set simulation.control_")["simulation.control_ratio="].endswith("(default 8)")
    words = offered("pvlvrt-check --set simulation.fidelity=")
    assert set(words) == {f"simulation.fidelity={word}" for word in get_args(Fidelity)}
    assert set(offered("pvlvrt-check --set simulation.record_settling=t")) == {"simulation.record_settling=true"}


def test_parameters_of_a_controller_of_ones_own_are_not_guessed(offered):
    """Those of the bundled one are not its; it is not run to be asked for them."""
    found = offered("pvlvrt-check --controller absent.py:Nothing --set controller.")
    assert set(found) == {"controller.computation_delay_samples=", "controller.hold="}


@pytest.fixture
def settings(tmp_path, monkeypatch):
    """A repository with a file of settings, which is the working directory: ``settings(text) -> its file``."""
    (tmp_path / ".git").mkdir()
    monkeypatch.chdir(tmp_path)

    def settings(text):
        (tmp_path / "pvlvrt.toml").write_text(text, "utf-8")
        return tmp_path / "pvlvrt.toml"

    return settings


def test_tests_of_the_profiles_in_settings(offered, settings):
    """What file and variables say counts as for the command that is typed: under what the line has, or not at all."""
    settings('profile = "iec61400-21"\n')
    vd3 = set(offered("pvlvrt-check --profile iec61400-21 --test VD3"))
    others = set(offered("pvlvrt-check --profile spain-q-curve --profile rey-boue-500kva --test "))
    assert vd3
    assert set(offered("pvlvrt-check --test VD3")) == vd3
    assert set(offered("pvlvrt-check config show --test VD3")) == vd3
    assert set(offered("pvlvrt-check compare a b --test VD3")) == vd3
    assert set(offered("pvlvrt-check --test ", PVLVRT_PROFILE="spain-q-curve rey-boue-500kva")) == others
    assert set(offered("pvlvrt-check --profile spain-q-curve --profile rey-boue-500kva --test ")) == others
    assert offered("pvlvrt-check --isolated --test ") == {}


@pytest.mark.parametrize(
    ("line", "own"),
    [
        ("", True),
        ("--controller bundled", False),
        ("--isolated", False),
        ("compare bundled", False),
        ("compare bundled a.py:A", True),
    ],
)
def test_parameters_go_by_the_controller_of_the_settings(offered, settings, line, own):
    """Those of the bundled one are offered where that is meant, and none where it is one's own, which is not run."""
    settings('controller = "absent.py:Nothing"\n')
    found = set(offered(f"pvlvrt-check {line} --set controller."))
    assert found >= {"controller.computation_delay_samples="}
    assert (len(found) == len(OF_THE_HOST)) is own


@pytest.mark.parametrize("text", ["profile =", "profile = 5", 'sga = "9%"', 'profile = "absent"', "\x00"])
def test_settings_that_are_broken_say_nothing(offered, settings, text):
    """The profile that is typed has its tests all the same."""
    assert settings(text)
    assert offered("pvlvrt-check --test ") == {}
    assert offered("pvlvrt-check --profile iec61400-21 --test VD3")


def test_settings_of_somebody_else_are_not_asked(offered, settings):
    """They are not taken for a run either."""
    settings('profile = "iec61400-21"\n').chmod(0o666)
    assert offered("pvlvrt-check --test ") == {}
    assert offered("pvlvrt-check --config pvlvrt.toml --test VD3")


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("--phases ", set(get_args(PhaseNames))),
        ("--fidelity=s", {"switched"}),
        ("--sag-type ", set("ABCDEFG")),
        ("--waveforms ", {"all", "failed", "none"}),
        ("--transformer D", {*(f"Dy{k}" for k in range(1, 12, 2)), *(f"Dyn{k}" for k in range(1, 12, 2))}
         | {f"Dd{k}" for k in range(0, 12, 2)}),
        ("--language ", {"en", "es"}),
        ("--report-field cl", {"client="}),
        ("controllers new --kind ", {"python", "c", "fmu"}),
        ("profiles plot x --scale ", {"linear", "log"}),
        ("completion ", set(SHELLS)),
        ("profiles sh", {"show"}),
        ("--include", {"--include-long"}),
    ],
)  # fmt: skip
def test_words_of_an_option(offered, line, words):
    """An option with few words offers all of them that go on as what is typed begins."""
    assert set(offered(f"pvlvrt-check {line}")) == words


def test_formats_are_offered(offered):
    """Every report that can be asked for is offered behind --format."""
    assert "pdf" in offered("pvlvrt-check --format ")


@pytest.mark.parametrize("option", [option for option in OPTIONS.values() if option.complete], ids=lambda o: o.names[0])
def test_each_named_function_is_there(option):
    """A name in the table of options is one of a function; a misspelt one would only be silent."""
    assert callable(getattr(values, option.complete))


def test_an_answer_is_one_line(offered, tmp_path):
    """A title of several lines, and as wide as no terminal is, stays one answer, and its brackets are no markup."""
    (tmp_path / "odd.toml").write_text(f'title = """a [bold]b[/bold]\nc {"wide " * 40}"""', "utf-8")
    assert offered("pvlvrt-check --profile odd", PVLVRT_PROFILES=str(tmp_path)) == {
        "odd": f"a (bold)b(/bold) c {'wide ' * 40}".strip()
    }


@pytest.mark.parametrize(
    "line",
    [
        "--profile absent --test ",
        "--profile broken.toml --test ",
        "--no-such --test ",
        "nonsense ",
        "--version --help --profile iec61400-21 'open",
        "--set a.b.c=",
        "--profile ./absent/",
        "\udcff",
    ],
)
def test_a_line_that_cannot_be_read_offers_nothing_and_says_nothing(offered, tmp_path, monkeypatch, line):
    """Whoever is typing sees no error, no version and no help."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "broken.toml").write_text("[requirements", "utf-8")
    commands = set(offered("pvlvrt-check "))
    assert {"profiles", "completion"} <= commands
    assert set(offered(f"pvlvrt-check {line}")) <= commands


def test_what_fails_while_looking_offers_nothing(monkeypatch):
    """A completer that breaks is a completer that has nothing."""
    monkeypatch.setattr(values, "phases", lambda *_: 1 / 0)
    assert completer("phases")(None, "a") == []


def test_a_folder_of_profiles_that_is_gone(offered):
    """A wrong $PVLVRT_PROFILES is told by the command, not by the tabulator key."""
    assert offered("pvlvrt-check --profile ", PVLVRT_PROFILES="/no/such/folder") == {}


def test_the_answer_in_the_words_of_each_shell(command):
    """Bash gets words, zsh a call with words and meanings, fish asks first whether there is anything."""
    bash = command(**{ASKED_BY: "complete_bash", "COMP_WORDS": "pvlvrt-check --profile spain", "COMP_CWORD": "-1"})
    assert bash == (0, "spain-q-curve\n", "")
    zsh = command(**{ASKED_BY: "complete_zsh", "_TYPER_COMPLETE_ARGS": "pvlvrt-check --profile spain"})
    assert zsh.out.startswith('_arguments \'*: :(("spain-q-curve":"Reactive support')
    fish = {ASKED_BY: "complete_fish", "_TYPER_COMPLETE_FISH_ACTION": "is-args"}
    assert command(**fish, _TYPER_COMPLETE_ARGS="pvlvrt-check --profile spain").status == 0
    assert command(**fish, _TYPER_COMPLETE_ARGS="pvlvrt-check --output x").status == 1
    assert command(**{ASKED_BY: "complete_nonsense"}) == (1, "", "")


def test_script_in_a_bash(tmp_path):
    """In bash, which cuts a line at `=`, what is offered goes on from that cut."""
    if shutil.which("bash") is None:
        pytest.skip("needs bash")
    program = tmp_path / "pvlvrt-check"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m pvlvrt_compliance "$@"\n', "utf-8")
    program.chmod(0o755)
    asked = f"""
PATH="{tmp_path}:$PATH"
eval "$(pvlvrt-check completion bash)"
complete -p pvlvrt-check
COMP_LINE="pvlvrt-check --report-field 'client=Solar Ltd' --set simulation.fidelity=sw"
COMP_POINT=${{#COMP_LINE}}
_pvlvrt_check_completion pvlvrt-check
printf '<%s>' "${{COMPREPLY[@]}}"
"""
    done = subprocess.run(["bash", "--norc", "-c", asked], capture_output=True, text=True, check=True)
    assert done.stdout == "complete -o default -F _pvlvrt_check_completion pvlvrt-check\n<switched>"
    assert done.stderr == ""


@pytest.mark.parametrize("shell", SHELLS)
def test_each_shell_has_a_script(command, shell):
    """It names the program, and the variable by which the shell asks."""
    ended = command("completion", shell)
    assert (ended.status, ended.err) == (0, "")
    assert ASKED_BY in ended.out
    assert "pvlvrt-check" in ended.out


def test_a_shell_without_a_script(command):
    """One line says which there are."""
    ended = command("completion", "tcsh")
    assert (ended.status, ended.out) == (2, "")
    assert ended.err == "pvlvrt-check: completion tcsh: allowed are bash, zsh, fish, powershell\n"


@pytest.mark.parametrize("line", ["--profile iec61400-21 --test VD3", "--set sim", "--format p", "--waveforms a"])
def test_a_key_press_loads_no_simulator(line):
    """What is offered is found without the compiler, plots, or anything else that takes seconds."""
    asked = (
        "import os, sys\n"
        f"os.environ.update({ASKED_BY}='complete_bash', COMP_WORDS='pvlvrt-check {line}', COMP_CWORD='-1')\n"
        "from pvlvrt_compliance.cli.main import run\n"
        "status = run([])\n"
        "print(status, sorted({'numba', 'scipy', 'plotly', 'numpy', 'jinja2'} & set(sys.modules)), file=sys.stderr)\n"
    )
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=True)
    assert done.stdout
    assert done.stderr == "0 []\n"
