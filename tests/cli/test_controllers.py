"""`controllers inspect | new | header`: projects that work as they are, and what is said of a controller."""

import json
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from pvlvrt_compliance.controllers.library import HEADER
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters

needs_gcc = pytest.mark.skipif(None in map(shutil.which, ("gcc", "make")), reason="gcc or make is not installed")
needs_pythonfmu = pytest.mark.skipif(
    find_spec("pythonfmu") is None or find_spec("fmpy") is None, reason="pythonfmu or fmpy is not installed"
)
GATE = ("--profile", "iec61400-21", "--sag", "50%")


@pytest.fixture(scope="module")
def project(tmp_path_factory, program):
    """Begin a project of a kind: ``project(kind) -> folder``."""

    def project(kind):
        folder = tmp_path_factory.mktemp("projects") / kind
        ended = program("controllers", "new", "--kind", kind, folder)
        assert ended.status == 0
        assert re.fullmatch(
            r"Put pvlvrt_compliance-\S+\.whl into \S+, or CI cannot install it: README.md says how\n", ended.err
        )
        assert {Path(line) for line in ended.out.splitlines()} == {p for p in folder.rglob("*") if p.is_file()}
        return folder

    return project


@pytest.fixture(scope="module")
def in_python(project):
    """The project in Python."""
    return project("python")


@pytest.fixture(scope="module")
def in_c(project):
    """The project in C, built as its Makefile says, with warnings as errors."""
    folder = project("c")
    flags = "CFLAGS=-O2 -std=c99 -Wall -Wextra -Wpedantic -Werror -fPIC"
    done = subprocess.run(["make", "-s", flags], cwd=folder, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return folder


@pytest.fixture(scope="module")
def as_fmu(project):
    """The project of an FMU, built as its Makefile says."""
    folder = project("fmu")
    code = f"import sys; sys.path[:] = {sys.path!r}; from pythonfmu.__main__ import cli_main; cli_main()"
    (rule,) = (line for line in (folder / "Makefile").read_text().splitlines() if line.startswith("\tpythonfmu "))
    command = [sys.executable, "-c", code, *rule.split()[1:]]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.slow
def test_template_that_winds_up_after_a_trip(program, in_python):
    """The relay ends a row of NTS 631 at 0.837 s; what the controller commands from then on makes no error of it."""
    curve = "protection.undervoltage_curve=[[0,0],[0.15,0],[1.5,0.85]]"
    row = ("--profile", "es-nts-631-lt110kv", "--test", "U40TPmax-1", "--set", curve)
    ended = program("--controller", "controller.py:Controller", *row, cwd=in_python)
    assert ended.status == 1
    said = " ".join(f"{ended.out} {ended.err}".split())
    assert "fail: ride_through in U40TPmax-1: tripped at" in said
    assert "by the under-voltage relay of the plant" in said
    assert "0.837 s" in said
    assert "ignored, as it came after a trip: a command of the controller is out of range" in said


def assert_gates(program, folder, spec):
    """The gate of a project is red with a setting that asks for too little reactive power, and only for that."""
    red = program("--test", "VD2-full-1", "--set", "controller.plateau_power_pu=0.2", cwd=folder)
    assert red.status == 1, red
    assert "FAIL: 1 test; checks: 1 fail, 6 pass" in red.out
    assert "fail: reactive_support" in red.out
    assert f"Controller: {spec} " in red.out
    assert "called every 100 us; plant step 5 us (20 in a sample time)" in red.out


@pytest.mark.slow
def test_project_in_python_gates(program, in_python):
    """The settings of the project in Python name controller and profile; green it is in tests/packaging."""
    assert_gates(program, in_python, "controller.py:Controller")


@pytest.mark.compiler
@needs_gcc
@pytest.mark.slow
def test_project_in_c_gates(program, in_c):
    """So does the C controller, tied to the plant by the mapping file beside it."""
    assert_gates(program, in_c, "./libcontroller.so")


@pytest.mark.slow
@needs_pythonfmu
def test_project_of_an_fmu_gates(program, as_fmu):
    """So does the FMU made from the Python controller."""
    assert_gates(program, as_fmu, "./MyController.fmu")


@pytest.mark.compiler
@needs_gcc
@pytest.mark.parametrize("phases", ["abc", "c"])
def test_controllers_in_python_and_c_are_the_same(in_python, in_c, phases):
    """The two are one law: their waveforms agree within rounding."""
    scenario = Scenario(sag=Sag(depth=0.7, phases=phases), duration_s=0.2, after_s=0.3)
    specs = (f"{in_python / 'controller.py'}:Controller", str(in_c / "libcontroller.so"))
    python, c = (ForeignSimulator(spec)(scenario, Parameters()) for spec in specs)
    for name in ("i_a_a", "i_c_a", "v_dc_v", "q_ref_var", "p_ref_w"):
        one, other = (waveforms.segments[0].channels[name] for waveforms in (python, c))
        np.testing.assert_allclose(other, one, rtol=1e-6, atol=1e-6 * np.abs(one).max())


def test_header_is_the_interface(command):
    """The header that is printed is the one that examples are built with, and declares what a controller exports."""
    ended = command("controllers", "header")
    assert (ended.status, ended.err) == (0, "")
    assert ended.out == HEADER.read_text("utf-8")
    for name in ("Model_GetInfo", "Model_CheckParameters", "Model_Initialize", "Model_Outputs", "Model_Terminate"):
        assert name in ended.out


def test_new_leaves_what_is_there(command, in_python):
    """A project is never overwritten, not even in part."""
    before = {p: p.read_bytes() for p in in_python.rglob("*") if p.is_file()}
    ended = command("controllers", "new", in_python)
    assert ended.status == 2
    assert "there already, and left as they are" in ended.err
    assert {p: p.read_bytes() for p in in_python.rglob("*") if p.is_file()} == before


def test_new_refuses_an_unknown_kind(command, tmp_path):
    """Kinds are named when one is not known."""
    ended = command("controllers", "new", "--kind", "rust", tmp_path / "x")
    assert ended.status == 2
    assert "allowed are python, c, fmu" in ended.err
    assert not (tmp_path / "x").exists()


def test_inspect_for_programs(command, in_python):
    """Everything that is shown is there as JSON, with the rates that will be used and the parameters as set."""
    spec = f"{in_python / 'controller.py'}:Controller"
    ended = command("controllers", "inspect", spec, "--json", "--set", "controller.dc_voltage_v=810")
    found = json.loads(ended.out)
    assert ended.status == 0
    assert (found["kind"], found["sample_time_s"], found["plant_step_us"]) == ("python", 1e-4, pytest.approx(5.0))
    assert (found["plant_steps_per_sample"], found["computation_delay_samples"]) == (20, 1)
    (parameter,) = (p for p in found["parameters"] if p["name"] == "dc_voltage_v")
    assert (parameter["value"], parameter["default"]) == (810.0, 807.0)
    assert found["unmapped_inputs"] == found["missing_commands"] == []


@pytest.mark.compiler
@needs_gcc
def test_inspect_in_words(command, in_c):
    """Ports with their units and what they are tied to, parameters with their ranges, sample time and plant step."""
    ended = command("controllers", "inspect", in_c / "libcontroller.so")
    assert ended.status == 0
    assert "sample time 100 us: plant step 5 us, 20 steps in a sample time; recorded every 25 us" in ended.out
    lines = [line.split() for line in ended.out.splitlines()]
    assert ["Vdc", "V", "v_dc_v", "DC-link", "voltage"] in lines
    assert ["ma", "m_a", "modulating", "signal:", "u_a", "=", "ma", "Vdc", "/", "2"] in lines
    assert ["plateau_power_pu", "0.75", "pu", "0", "to", "1", "full", "reactive", "power"] in lines
    assert ended.out.splitlines()[-1].startswith("ready to run")


@pytest.mark.compiler
@needs_gcc
def test_inspect_names_what_is_unmapped(command, in_c, tmp_path):
    """Without its mapping file a description decides what a name does not; what is not given, a run says, too."""
    library = shutil.copy(in_c / "libcontroller.so", tmp_path)
    ended = command("controllers", "inspect", library)
    assert "voltage_nominal_v" in next(line for line in ended.out.splitlines() if line.startswith("Vnom"))
    mapping = tmp_path / "other.toml"
    mapping.write_text(
        '[inputs]\nVnom = "voltage_nominal_v"\nVa = {signal = "u_b_v", unit = "kV"}\n[outputs]\nma = {record = "x"}\n'
    )
    ended = command("controllers", "inspect", library, "--mapping", mapping)
    assert "u_b_v" in ended.out
    assert "cannot be run yet: no output gives m_a" in ended.out
    ended = command("--controller", library, "--mapping", mapping, *GATE, "--output", tmp_path / "out")
    assert ended.status == 2
    assert "no output gives m_a. Tie them under [outputs] of a mapping file" in ended.err


@pytest.mark.compiler
@needs_gcc
def test_fixed_plant_step_that_does_not_fit_is_refused(command, in_c):
    """So do inspection and run: the nearest possible steps are named."""
    ended = command("controllers", "inspect", in_c / "libcontroller.so", "--set", "simulation.plant_step_us=3")
    assert ended.status == 2
    assert "3.0303 us (33 steps) or 2.94118 us (34 steps)" in ended.err


def test_a_mapping_ties_ports(command, in_python):
    """It is for a controller of one's own that has ports; a Python class has none to tie, but files to list."""
    assert "it needs --controller" in command(*GATE, "--mapping", "x.toml").err
    spec, mapping = f"{in_python / 'controller.py'}:Controller", in_python / "x.toml"
    mapping.write_text("[inputs]\nVdc = 'v_dc_v'\n")
    ended = command("controllers", "inspect", spec, "--mapping", mapping)
    assert ended.status == 2
    assert "--mapping does not go with it" in " ".join(ended.err.split())
    mapping.write_text('files = ["controller.py"]\n')
    assert command("controllers", "inspect", spec, "--mapping", mapping).status == 0


@pytest.mark.parametrize("name", ["inspect", "new", "header"])
def test_help_of_each_command(command, name):
    """Each has help with an example."""
    assert "Example: pvlvrt-check controllers" in " ".join(command("controllers", name, "--help").out.split())
