"""What a command loads: none pays for what it does not use."""

import subprocess
import sys
from pathlib import Path

import pytest

import pvlvrt_compliance

NAME = pvlvrt_compliance.__name__

HEAVY = {"numba", "scipy", "plotly", "pandas"}

LIGHT = HEAVY | {"numpy", "pydantic", "jinja2", "email.message", "tomllib"}

OLD_RESULTS = str(Path(__file__).parent / "golden" / "results-0.1.0" / "results.json")

COMPARE = ["compare", OLD_RESULTS, OLD_RESULTS, "--output", __file__]  # all but written: a file is no folder


def loaded_by(code: str) -> set[str]:
    """Names of the modules that a process has loaded after this code, with those of their packages."""
    program = f"import sys\n{code}\nprint('loaded', *sys.modules)"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    names = run.stdout.splitlines()[-1].split()[1:]
    return {".".join(name.split(".")[:depth]) for name in names for depth in (1, 2)}


@pytest.mark.parametrize(
    ("code", "never"),
    [
        (f"import {NAME}.controllers", HEAVY | {"numpy", "pydantic", "typer", "rich", "ctypes", "subprocess"}),
        (f"import {NAME}.pytest_plugin", HEAVY | {"numpy", "pydantic", "typer", "rich", f"{NAME}.cli", f"{NAME}.data"}),
        (f"import {NAME}.results", HEAVY | {"numpy"}),
        (f"import {NAME}.cli.main", HEAVY | {"numpy", "pydantic", "jinja2"}),  # a shell asks at each press of a key
        (f"from {NAME}.cli.main import run\nrun(['config', 'show'])", HEAVY | {"numpy", f"{NAME}.study"}),
        (f"from {NAME}.cli.main import run\nrun(['--version'])", LIGHT | {"importlib.metadata", "rich"}),
        (f"from {NAME}.cli.main import run\nrun(['--help'])", LIGHT | {"importlib.metadata"}),
        (f"from {NAME}.cli.main import run\nrun(['profiles', 'list'])", HEAVY | {"numpy"}),
        (f"from {NAME}.cli.main import run\nrun({COMPARE})", HEAVY),
        (f"from {NAME}.cli.main import run\nrun(['controllers', 'header'])", HEAVY | {"numpy"}),
        (f"import {NAME}.checks.api, {NAME}.checks.evaluate, {NAME}.waveforms.recording", HEAVY),
        (f"import {NAME}.simulation.simulate", HEAVY | {f"{NAME}.controllers", f"{NAME}.study", f"{NAME}.checks"}),
    ],
    ids=[
        "a user's controller",
        "pytest",
        "results",
        "a shell that asks",
        "config",
        "--version",
        "--help",
        "profiles",
        "compare",
        "header",
        "judging",
        "simulation",
    ],
)
def test_what_is_imported_stays_light(code, never):
    """What is only read, shown or judged never pays for the simulator, nor a simulation for what comes after it."""
    assert not loaded_by(code) & never


def test_a_list_that_is_kept_needs_no_models(monkeypatch, tmp_path):
    """The profiles are listed again without reading one: neither their models nor a reader of TOML are loaded."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    code = f"from {NAME}.cli.main import run\nrun(['profiles', 'list'])"
    assert "pydantic" in loaded_by(code)
    assert not loaded_by(code) & (LIGHT | {"importlib.metadata", f"{NAME}.profile", f"{NAME}.checks"})
