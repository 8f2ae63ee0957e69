"""A controller in C in the gate: red with the clause that it breaks, green when it is mended."""

import shutil
import subprocess
from pathlib import Path

import pytest

import pvlvrt_compliance

pytestmark = pytest.mark.compiler

ROOT = Path(__file__).resolve().parents[2]
INTERFACE = Path(pvlvrt_compliance.__file__).parent / "controllers" / "library"


@pytest.fixture
def examples(tmp_path):
    """A copy of the examples in C, without what may have been built there."""
    if shutil.which("gcc") is None or shutil.which("make") is None:
        pytest.skip("gcc or make is missing, so no controller in C can be built")
    for name in ("bundled-controller-c", "negative-sequence-bug"):
        shutil.copytree(ROOT / "examples" / name, tmp_path / name, ignore=shutil.ignore_patterns("*.so"))
    return tmp_path


def build(folder):
    """Build an example by its own Makefile."""
    subprocess.run(["make", "CC=gcc", f"INTERFACE={INTERFACE}", "libcontroller.so"], cwd=folder, check=True)
    return folder / "libcontroller.so"


def gate_of(folder):
    """Arguments of the command in the example's Makefile, but for the controller."""
    (line,) = [line.strip() for line in (folder / "Makefile").read_text().splitlines() if "pvlvrt-check" in line]
    words = line.split()
    assert words[-2:] == ["--controller", "./libcontroller.so"]
    return words[1:-2]


@pytest.mark.slow
def test_bug_is_red_and_its_mending_green(examples, program, reports):
    """The negative sequence ignored breaks eq (5) and section 3.2 of the paper; without that line all is well."""
    folder = examples / "negative-sequence-bug"
    arguments = (*gate_of(folder), "--controller", build(folder), "--output", examples / "report")
    red = program(*arguments)
    assert red.status == 1
    broken = {c["check"]: c["clause"] for c in reports(examples / "report").test["checks"] if c["status"] == "fail"}
    assert broken == {"constant_power": "paper eq (5)", "dc_ripple": "paper 3.2"}
    source = folder / "controller.c"
    source.write_text("".join(x for x in source.read_text().splitlines(True) if "/* mistake */" not in x))
    build(folder)
    green = program(*arguments)
    assert (green.status, reports(examples / "report").verdicts["sag-90pct-c"].keys()) == (
        0,
        {*broken}
        | {"ride_through", "current_limit", "reactive_support", "harmonics"}
        | {"active_power_support", "oscillation", "return_to_prefault"},
    )


@pytest.fixture
def misbehaving(examples):
    """The library that misbehaves."""
    library = examples / "libmisbehaving.so"
    source = ROOT / "tests" / "controllers" / "library" / "misbehaving.c"
    command = ["gcc", "-std=c99", "-shared", "-fPIC", f"-I{INTERFACE}", str(source), "-o", str(library), "-lm"]
    subprocess.run(command, check=True)
    return library


def test_messages_go_to_stderr(misbehaving, judge):
    """What the library has to say is told once, beside the verdicts and not among them."""
    ended, reports = judge("--sag", "20%", "--controller", misbehaving, "--set", "controller.how=8")
    assert ended.err.count("the limiter is active") == 1
    assert "the limiter is active" not in ended.out
    assert "the limiter is active" in reports.json["provenance"]["controller_notes"]


def test_crash_in_one_test_leaves_the_others(misbehaving, examples, program, reports):
    """A library that crashes in deep sags only: `error` there, with the simulated time; the other is judged."""
    settings = [f"controller.{x}" for x in ("how=1", "at_s=0.3", "below_v=150")]
    ended = program(
        *("--profile", "iec61400-21", "--test", "VD1-full-1", "--test", "VD2-full-1", "--controller", misbehaving),
        *(word for setting in settings for word in ("--set", setting)),
        *("--output", examples / "report"),
    )
    assert ended.status == 3
    found = reports(examples / "report").json
    by_id = {test["id"]: test for test in found["tests"]}
    assert {check["status"] for check in by_id["VD2-full-1"]["checks"]} == {"error"}
    assert "the controller crashed (SIGSEGV) at 0.3" in str(by_id["VD2-full-1"])
    assert "error" not in {check["status"] for check in by_id["VD1-full-1"]["checks"]}
    assert found["provenance"]["controller_name"] == "misbehaving"
