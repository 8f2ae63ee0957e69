"""Every command of every page, run as it stands there, from the first to the last, in a folder of the page's own."""

import re
import shutil
from pathlib import Path

import pytest
import typer

from consoles import PROGRAM, Shell, Step, steps
from pvlvrt_compliance.cli.main import app

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]

ENVIRONMENT = "python3 -m venv .venv && .venv/bin/pip install"
INSTALLS = "installs the package: tests/packaging/ and .ci/run do"
FAILED, UNJUDGED = 1, 3

NOT_RUN: dict[str, str] = {
    f"{ENVIRONMENT} . && .venv/bin/pvlvrt-check --profile iec61400-21 --sag 90%": INSTALLS,
    f"{ENVIRONMENT} -e '.[test]' && .venv/bin/pytest": INSTALLS,
    f"{ENVIRONMENT} . && . .venv/bin/activate": INSTALLS,
    "pip install 'pvlvrt-compliance[fmi]'": INSTALLS,
    "python -m pip wheel --quiet --no-deps --wheel-dir my-controller/wheels .": INSTALLS,
    "pvlvrt-check --controller tcp://127.0.0.1:5000 --profile iec61400-21 --sag 90%": "needs a program that listens:"
    " tests/controllers/program/ has one",
    ".venv/bin/python tests/adversary/search.py --draws 20000 --seed 1": "takes hours: tests/adversary/ draws a few",
}
"""Commands that no test runs, and why."""

UNJUDGED_IN = {
    "pvlvrt-check --profile spain-q-curve --sag 0% --duration 300ms"
    " --events validation/simulator/harmonics-in-phase.toml --set controller.synchronisation=srf-pll",
    "pvlvrt-check --profile spain-q-curve --sag 0% --scr 1.5 --duration 309ms",
}
"""Commands that end with 3 because nothing can be judged, as their page says in words."""

_IN_LINE = re.compile(rf"`{PROGRAM} ([^`]+)`")
_OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]+")


def commands(page):
    """Commands of a page, comments behind them left out."""
    return [Step(re.sub(r"\s+#.*", "", step.command), step.output) for step in steps(page.read_text("utf-8"))]


def named(page):
    """What a page is called in the name of a test."""
    return page.relative_to(ROOT).as_posix()


def allowed(command):
    """Statuses that a command may end with where its page does not show one; a run may find a failure."""
    if command in UNJUDGED_IN:
        return {UNJUDGED}
    return {0, FAILED} if " --profile " in command else {0}


@pytest.fixture
def shell(tmp_path):
    """A shell in a folder in which files of the checkout are found by the paths that pages name."""
    folder = tmp_path / "page"
    folder.mkdir()
    for name in ("validation", "examples", "profiles", "tests"):
        (folder / name).symlink_to(ROOT / name)
    return Shell(folder)


@pytest.mark.slow
@pytest.mark.compiler
@pytest.mark.parametrize("page", [page for page in PAGES if commands(page)], ids=named)
def test_every_command_of_a_page_does_what_the_page_says(page, shell):
    """It ends well, or with the status that the page tells, and prints what stands below it."""
    told = commands(page)
    for step, following in zip(told, [*told[1:], None], strict=True):
        if step.command in NOT_RUN:
            continue
        if step.command.startswith("gdb ") and shutil.which("gdb") is None:
            pytest.skip("gdb is missing; what stands above it was run")
        ended = shell.do(step.command)
        assert step.is_met_by(ended.said), f"{step.command}\n{ended.said}"
        is_told = following is not None and following.command == "echo $?"
        assert is_told or ended.status in allowed(step.command), f"{step.command}\n{ended.said}"


def test_what_is_not_run_stands_on_a_page():
    """A reason for a command that is nowhere would be left over."""
    assert {*NOT_RUN, *UNJUDGED_IN} - {step.command for page in PAGES for step in commands(page)} == set()


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_commands_stand_in_blocks_that_are_run(page):
    """None stands in an indented block, or in a fenced one without a language: it would not be run."""
    bare = re.sub(r"^( *)```\w+\n.*?^\1```$", "", page.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)
    assert re.findall(rf"^(?:    |\$ )?{PROGRAM} .*", bare, re.MULTILINE) == []


def known_words():
    """Options and sub-commands that there are."""
    todo, options, names = [typer.main.get_command(app)], {"--help"}, set()
    while todo:
        command = todo.pop()
        options |= {name for param in command.params for name in param.opts}
        names |= set(getattr(command, "commands", {}))
        todo += getattr(command, "commands", {}).values()
    return options, names


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_what_is_named_in_a_sentence_is_there(page):
    """Options and sub-commands of commands within a text are those of the command line."""
    options, names = known_words()
    for words in _IN_LINE.findall(page.read_text("utf-8")):
        assert set(_OPTION.findall(words)) <= options, words
        first = words.split()[0]
        assert first.startswith("-") or first in names, words


@pytest.mark.parametrize(
    ("output", "said", "met"),
    [
        (None, "anything\n", True),
        ("a ... c\nd\n", "a b c\nd\n", True),
        ("a ... c\nd\n", "a b\nd c\nd\n", False),
        ("a\nb\n", "a  \nb\n", True),
        ("a\n...\nc\n", "a\nb\nb\nc\n", True),
        ("a\n...\n", "a\n", True),
        ("", "", True),
        ("a\n", "b\n", False),
        ("a\n", "a\nb\n", False),
        ("", "a\n", False),
        ("a.c\n", "abc\n", False),
    ],
)
def test_output_is_compared(output, said, met):
    """Line by line, but for the blanks at their ends and what is left out."""
    assert Step("x", output).is_met_by(said) == met


def test_commands_are_found():
    """In blocks for shells and consoles, over several lines, and in no others."""
    text = "```sh\na \\\n  b\n# c\n```\n\n```console\n$ d\ne\n$ f\n```\n\n```toml\n$ g\n```\n"
    assert list(steps(text)) == [Step("a   b", None), Step("d", "e\n"), Step("f", "")]


def test_a_command_that_fails_ends_its_line(shell):
    """What stands behind it is not done, and its status can be asked for."""
    assert shell.do("pvlvrt-check profiles show nowhere && cd gone").status == 2
    assert shell.do("echo $?").said == "2\n"
    assert shell.do("pvlvrt-check --version | head -c 12").said == "pvlvrt-check"
