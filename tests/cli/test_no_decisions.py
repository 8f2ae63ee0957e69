"""The command line parses, calls, prints and exits: what is run, and how, is decided elsewhere."""

import ast
from pathlib import Path

import pytest

import pvlvrt_compliance.cli

FOLDER = Path(pvlvrt_compliance.cli.__file__).parent
NAME = "pvlvrt_compliance."

RUNS = {"api", "output", "study"}
"""Rooms that run something."""

SIMULATES = {"simulation", "controllers", "plant", "control", "hardware", "kernel"}
"""Rooms that only a run needs."""

# By file: what of these rooms it touches. Whatever is not here touches none, and starts light.
TOUCHES = {
    "check.py": {"study.job"},
    "running.py": {"output", "study.job", "study.running", "study.shards", "controllers.process"},
    "merge.py": {"output", "study.shards"},  # parts of a run are read, and nothing is simulated
    "completion/values.py": {
        "study.job",
        "study.selection",
        "simulation.parameters",
        "controllers.bundled",
        "controllers.projects",
    },
    "catalogue.py": {"study.job", "study.selection"},
    "compare.py": {"output", "study.comparing", "study.job", "study.overlays"},  # two results load no kernel
    "main.py": {"controllers.process"},
    "typed.py": {"controllers.spelling"},  # how one is written
    "baseline/update.py": {"study.baseline.files"},
    "controllers/inspect.py": {"controllers", "simulation.parameters"},  # which load no kernel
    "controllers/new.py": {"controllers.projects"},
    "controllers/replay.py": {"controllers.replay", "simulation.parameters"},  # run in a process of its own
    "controllers/header.py": {"controllers.library"},
}

ENDS = {"check.py", "running.py"}
"""Files of the main command, which raise nothing of their own but what standard output makes of them."""


def files():
    """Every module of the command line."""
    return sorted(FOLDER.rglob("*.py"))


def named(path):
    """Name in the folder."""
    return path.relative_to(FOLDER).as_posix()


def imports(path):
    """Modules of the package that a file imports anywhere, without its name."""
    tree = ast.parse(path.read_text("utf-8"))
    found = [node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    found += [alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names]
    return {name.removeprefix(NAME) for name in found if name.startswith(NAME)}


@pytest.mark.parametrize("path", files(), ids=named)
def test_what_a_command_may_touch(path):
    """Only the main command and the comparison run anything; others than these come near no simulator or controller."""
    touched = {name for name in imports(path) if name.split(".")[0] in RUNS | SIMULATES}
    allowed = TOUCHES.get(named(path), set())
    assert all(any(f"{name}.".startswith(f"{entry}.") for entry in allowed) for name in touched), touched
    for entry in allowed:
        assert any(f"{name}.".startswith(f"{entry}.") for name in touched), f"{entry} is allowed and not needed"


def test_the_table_has_no_file_that_is_gone():
    """Each file of the table is there."""
    assert set(TOUCHES) <= {named(path) for path in files()}


@pytest.mark.parametrize("name", sorted(ENDS))
def test_the_main_command_judges_nothing_that_is_typed(name):
    """What cannot be used is refused where it is understood: no file of the main command raises a usage error."""
    assert "UsageError" not in (FOLDER / name).read_text("utf-8")


def test_the_main_command_computes_nothing():
    """Its function has no arithmetic and no comparison but with none, and hands on what was typed."""
    tree = ast.parse((FOLDER / "check.py").read_text("utf-8"))
    (check,) = [node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == "check"]
    assert not [node for node in ast.walk(check) if isinstance(node, ast.BinOp) and not _is_a_type(node, check)]
    for node in ast.walk(check):
        if isinstance(node, ast.Compare):
            assert all(isinstance(x, ast.Constant) and x.value is None for x in node.comparators), ast.unparse(node)


def _is_a_type(node, function):
    """Whether an expression is part of an annotation: ``str | None``."""
    annotations = [argument.annotation for argument in ast.walk(function) if isinstance(argument, ast.arg)]
    annotations.append(function.returns)
    return any(node is part for annotation in annotations if annotation for part in ast.walk(annotation))
