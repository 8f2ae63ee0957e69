"""Help, version, and what the command does not load for them."""

import importlib.metadata
import subprocess
import sys

import pytest


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
