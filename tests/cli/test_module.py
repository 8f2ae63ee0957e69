"""`python -m pvlvrt_compliance` is the command, whatever it was started as."""

import subprocess
import sys

import pytest

import pvlvrt_compliance
from pvlvrt_compliance.cli import start


def as_module(*arguments, cwd):
    """Status, output and errors of the package run as a program."""
    program = [sys.executable, "-m", "pvlvrt_compliance", *arguments]
    done = subprocess.run(program, cwd=cwd, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


def test_version(tmp_path):
    """It says what the command says."""
    assert as_module("--version", cwd=tmp_path) == (0, f"pvlvrt-check {pvlvrt_compliance.__version__}\n", "")


@pytest.mark.parametrize("arguments", [["--help"], ["profiles", "--help"]], ids=" ".join)
def test_help_names_the_command(arguments, tmp_path):
    """The usage is that of pvlvrt-check, which is what a reader types."""
    status, out, err = as_module(*arguments, cwd=tmp_path)
    assert (status, err) == (0, "")
    assert "Usage: pvlvrt-check " in out
    assert "python -m" not in out


def test_errors(tmp_path):
    """They begin with the name of the command, and end with its status."""
    assert as_module("--profile", "iec61400-21", "--sag", "x", cwd=tmp_path) == (
        2,
        "",
        "pvlvrt-check: --sag: 'x' is not a fraction; write 90% or 0.9\n",
    )


def test_a_run_carries_the_command(reports, tmp_path):
    """What makes the run again is written with the command's name."""
    status, out, err = as_module("--profile", "iec61400-21", "--sag", "90%", "--quiet", cwd=tmp_path)
    assert (status, out, err) == (0, "PASS: 1 test; checks: 7 pass; 1 marginal\n", "")
    origin = reports(tmp_path / "pvlvrt-report").json["provenance"]
    assert origin["command"] == "pvlvrt-check --profile iec61400-21 --sag 90% --quiet"


def test_importing_it_runs_nothing(capsys):
    """The module is a program only as such."""
    import pvlvrt_compliance.__main__ as program

    assert capsys.readouterr() == ("", "")
    assert program.main is start.main
