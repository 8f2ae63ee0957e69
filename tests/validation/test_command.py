"""The command behind each page, and that the package stands without it."""

import ast
from importlib.util import find_spec
from pathlib import Path

import pytest

import pvlvrt_compliance
import validation
from validation.command import MissingProgramError, Outcome, run

FOLDER = Path(validation.__file__).parent
PACKAGE = Path(pvlvrt_compliance.__file__).parent


def missing(_check):
    """Evidence that needs what is not installed."""
    raise MissingProgramError("oracle is missing")


@pytest.mark.parametrize(("options", "check"), [([], False), (["--check"], True)])
def test_nothing_to_complain_of(monkeypatch, capsys, options, check):
    """The summary is said, and the exit status is 0."""
    monkeypatch.setattr("sys.argv", ["page", *options])
    assert run("a", "b", lambda asked: Outcome([], f"checked: {asked}")) == 0
    assert capsys.readouterr().out == f"checked: {check}\n"


def test_problems(monkeypatch, capsys):
    """Each is a line, and the exit status is 1."""
    monkeypatch.setattr("sys.argv", ["page"])
    assert run("a", "b", lambda _: Outcome(["stale: x", "stale: y"], "fine")) == 1
    assert capsys.readouterr().out == "stale: x\nstale: y\n"


def test_a_program_that_is_missing(monkeypatch, capsys):
    """Evidence that cannot be had is no stale page: exit status 2."""
    monkeypatch.setattr("sys.argv", ["page"])
    assert run("a", "b", missing) == 2
    assert capsys.readouterr() == ("", "oracle is missing\n")


def test_every_page_has_the_same_command():
    """Each folder is `python -m validation.<folder>`."""
    folders = {path.parent.name for path in FOLDER.glob("*/*.py")}
    assert folders >= {"simulator", "mutations", "grid_codes", "fidelity", "paper", "blocks"}
    assert [name for name in folders if find_spec(f"validation.{name}.__main__") is None] == []


def test_the_package_never_needs_it():
    """An installed wheel has no `validation`."""
    for path in PACKAGE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            names = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            names += [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            assert not {name for name in names if name.split(".")[0] == "validation"}, path
