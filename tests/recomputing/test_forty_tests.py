"""Verdicts can be redone: a program that knows the page and the files alone comes to the same numbers."""

import ast
import json
import subprocess
import sys
from pathlib import Path

import pytest

from forty_tests import CASES, run, written
from pvlvrt_compliance.profile import known_profiles
from recomputing import JUDGES, cursors, judge
from recomputing.comparing import differences, read_csv

PROGRAM = Path(__file__).parent / "recomputing"


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_each_verdict_is_recomputed_from_the_files(case, tmp_path):
    """All cursors, and every check's status, measured, limit and margin, come out of CSV, profile and disturbance."""
    found = run(case)
    result = json.loads(found.result.model_dump_json())
    profile = json.loads(found.profile.model_dump_json(by_alias=True, exclude_none=True))
    waveforms = read_csv(written(found, tmp_path))
    assert cursors.differences(result["cursors"], cursors.recompute(result, profile, waveforms)) == []
    recomputed = judge(result, profile, waveforms)
    told = {check["check"]: check for check in result["checks"]}
    assert [verdict.check for verdict in recomputed] == list(told)
    assert [text for verdict in recomputed for text in differences(told[verdict.check], verdict)] == []


def test_forty_tests_lie_in_all_profiles():
    """Each shipped profile is among them, and each kind of check that it demands can be recomputed."""
    assert len(CASES) == 40
    assert {case.profile for case in CASES} == set(known_profiles())


def test_program_imports_nothing_of_the_package():
    """Only the standard library, numpy, scipy and itself."""
    allowed = {"numpy", "scipy", "recomputing", *sys.stdlib_module_names}
    for path in PROGRAM.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            assert {name.split(".")[0] for name in names} <= allowed, path


@pytest.mark.slow
def test_files_of_the_command_are_enough(tmp_path):
    """What the command writes can be redone by the program in a process of its own, which the package is not in."""
    command = [sys.executable, "-m", "pvlvrt_compliance.cli.main"]
    own = ["--profile", "iec61400-21", "--sag", "60%", "--duration", "0.3s", "--csv", "--output", str(tmp_path), "-q"]
    subprocess.run([*command, *own], check=True, capture_output=True)
    shown = subprocess.run(
        [*command, "profiles", "show", "iec61400-21", "--json"], check=True, capture_output=True, text=True
    )
    (tmp_path / "iec61400-21.json").write_text(shown.stdout, encoding="utf-8")
    program = [sys.executable, "-m", "recomputing", str(tmp_path), str(tmp_path)]
    done = subprocess.run(program, check=False, capture_output=True, text=True, cwd=PROGRAM.parent)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count(" as told") == 7, done.stdout


def test_program_knows_every_check_of_a_record():
    """But for rules of several runs, which need no waveforms."""
    from pvlvrt_compliance.profile.requirements import BUILT_IN

    assert set(BUILT_IN) - set(JUDGES) == {"repeated_runs"}
