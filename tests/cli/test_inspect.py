"""`controllers inspect` of controllers that cannot be run: their ports are shown, and all that is wrong is told."""

import json
import os
import re

import pytest

import broken

QUICK = ("--profile", "iec61400-21", "--sag", "50%", "--set", "simulation.settling_s=0.05")


def last_lines(text):
    """What a stream says, without the ends of lines that a terminal has made."""
    return re.sub(r"[ \n]+", " ", text)


@pytest.mark.compiler
@pytest.mark.slow
@pytest.mark.parametrize("name", broken.ALL)
def test_ports_are_shown_and_what_is_wrong_is_told(command, tmp_path, name):
    """Behind every door: stdout has what is known, stderr why it is no more, and the status is 2."""
    it = broken.ALL[name](tmp_path)
    ended = command("controllers", "inspect", *it.arguments)
    assert ended.status == 2
    assert re.search(rf"^{it.port}\b", ended.out, re.M), ended.out
    assert re.search(it.told, ended.err), ended.err
    assert "Traceback" not in ended.err
    assert "cannot be run: the error says why" in ended.out
    assert "ready to run" not in ended.out
    found = json.loads(command("controllers", "inspect", *it.arguments, "--json").out)
    assert not found["can_run"]
    assert re.search(it.told, "\n".join(found["faults"]))


@pytest.mark.compiler
@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["fmu_with_another_token", "fmu_without_functions", "library_that_refuses", "python_that_cannot_be_reset"]
)
def test_a_run_says_the_same(command, tmp_path, name):
    """What inspecting says of the opening is what each test of a run says, which then is an error."""
    it = broken.ALL[name](tmp_path)
    ended = command("--controller", *it.arguments, *QUICK, "--output", tmp_path / "out")
    assert ended.status == 3
    (test,) = json.loads((tmp_path / "out" / "results.json").read_text("utf-8"))["tests"]
    assert re.search(it.told, test["checks"][0]["message"])


def test_as_a_program(program, tmp_path):
    """So it is in a process of its own, with nothing of this one."""
    it = broken.python_that_cannot_be_imported(tmp_path)
    ended = program("controllers", "inspect", *it.arguments)
    assert (ended.status, "Traceback" in ended.err) == (2, False)
    assert re.search(it.told, ended.err)
    lines = [line.split() for line in ended.out.splitlines()]
    assert ["u_c_ref_v", "V", "u_c_ref_v"] in lines
    assert ["trip", "trip"] in lines
    assert ["how", "well"] in lines
    assert "its class is shown as it is written in its file" in ended.out


def test_a_file_that_is_no_python(command, tmp_path):
    """Every class is given the same, whatever its file says."""
    (tmp_path / "mine.py").write_text("class Mine(:\n", "utf-8")
    ended = command("controllers", "inspect", f"{tmp_path / 'mine.py'}:Mine")
    assert ended.status == 2
    assert "SyntaxError" in ended.err
    assert ["u_a_v", "V", "u_a_v"] in [line.split() for line in ended.out.splitlines()]
    assert "sample time not known" in ended.out


def test_several_faults_are_told_at_once(command, tmp_path):
    """A class without anything: each attribute and method that is missing, and a sample time that is none."""
    (tmp_path / "mine.py").write_text("class Mine:\n    sample_time_s = -1\n    switches = 'trip'\n", "utf-8")
    ended = command("controllers", "inspect", f"{tmp_path / 'mine.py'}:Mine")
    for said in ("4 problems", "sample_time_s is -1", "switches is 'trip'", "no method reset()", "no method step()"):
        assert said in last_lines(ended.err)


def test_a_sample_time_that_cannot_be_run(command, tmp_path):
    """It is told beside the ports, as it is where a fixed plant step does not divide it."""
    spec, *_ = broken.python_without_a_step(tmp_path).arguments
    file = tmp_path / "mine.py"
    file.write_text(file.read_text("utf-8") + broken._STEP, "utf-8")
    for setting, said in (("controller.how=well", ""), ("simulation.plant_step_us=3", "3.0303 us (33 steps)")):
        ended = command("controllers", "inspect", spec, "--set", setting)
        assert ended.status == (2 if said else 0)
        assert said in ended.err
        assert "sample time 100 us" in ended.out
        assert ("u_a_ref_v" in ended.out) is True


@pytest.mark.parametrize(
    "spec",
    ["{}.so", "{}.fmu", "{}.py:C", "{}:C", "pkg.{}:C", "mine.py:{}", "stdio:{}", "stdio:true {}", "tcp://{}:80", "{}"],
)
def test_a_name_that_is_too_long(command, tmp_path, monkeypatch, spec):
    """It is told in a line that can be read, and never as an error of ours; so does a run."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text("class Mine: pass\n", "utf-8")
    long = spec.format("x" * 5000)
    for words in (("controllers", "inspect", long), ("--controller", long, *QUICK, "--list")):
        ended = command(*words)
        if words[0] == "controllers":
            assert ended.status == 2
        assert "Traceback" not in ended.err
        assert "ended the process" not in ended.err
        assert "Errno" not in ended.err.replace("[Errno -2] Name or service not known", "")


@pytest.mark.parametrize("mapping", [True, False], ids=["mapping", "listed"])
def test_a_mapping_with_a_name_that_is_too_long(command, tmp_path, mapping):
    """So it is of a mapping file, and of a file that one lists; the ports are shown."""
    spec, *_ = broken.program_that_is_never_ready(tmp_path).arguments
    named = tmp_path / "mine.toml"
    named.write_text(f"files = ['{'y' * 5000}']\n", "utf-8")
    ended = command("controllers", "inspect", spec, "--mapping", "x" * 5000 if mapping else named)
    assert ended.status == 2
    assert "File name too long" in ended.err or os.name == "nt"
    assert "Traceback" not in ended.err
    assert ["u_a_v", "u_a_v"] in [line.split() for line in ended.out.splitlines()]
