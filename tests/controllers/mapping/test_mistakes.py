"""All that is wrong with a mapping file, by itself and with the ports, told in one go."""

import re

import pytest

from ports import port
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.mapping.file import load_mapping, read_mapping
from pvlvrt_compliance.controllers.mapping.sides import map_ports
from pvlvrt_compliance.controllers.program.door import ProgramDoor
from pvlvrt_compliance.units import Nominal

INPUTS = [port("Va", "V"), port("Vdc", "V"), port("abc", "V", 3)]
OUTPUTS = [port("ma"), port("mb"), port("mc"), port("x")]


def told(tmp_path, text):
    """What is said of a file, each problem without the name of the folder."""
    file = tmp_path / "my.mapping.toml"
    file.write_text(text, "utf-8")
    with pytest.raises(DoorError) as found:
        map_ports(INPUTS, OUTPUTS, read_mapping(file), Nominal())
    first, *problems = str(found.value).replace(f"{tmp_path}/", "").splitlines()
    assert first.endswith(f"{len(problems)} problems" if len(problems) > 1 else "1 problem") or not problems
    return [problem.strip() for problem in problems] or [first]


EVERYTHING = """currents = "inwards"
files = ["absent.csv"]
colour = "red"

[inputs]
Va = {signal = "u_a_v", sing = -1}
Vdc = {signal = "v_dc_v", unit = "kA"}
abc = "u_a_v"
Vdcc = "v_dc_v"

[outputs]
ma = "m_d"
mb = "m_b"
x = "m_b"
mc = {record = "v_dc_v"}
y = true

[bases]
voltage = "rms"
"""


def test_all_at_once(tmp_path):
    """Keys and values of the file, files that it lists, ports, units, signals, channels, commands given twice."""
    problems = told(tmp_path, EVERYTHING)
    places = [re.match(r"my\.mapping\.toml:(\d+): ([\w\[\].]+)", problem) for problem in problems]
    assert sorted((int(place[1]), place[2].rstrip(".")) for place in places) == [
        (1, "currents"),
        (2, "files[0]"),
        (3, "colour"),
        (6, "inputs.Va.sing"),
        (7, "inputs.Vdc"),
        (8, "inputs.abc"),
        (9, "inputs.Vdcc"),
        (12, "outputs.ma"),
        (14, "outputs.x"),
        (15, "outputs.mc"),
        (16, "outputs.y"),
        (19, "bases.voltage"),
    ]
    assert "allowed: V, kV, pu" in "\n".join(problems)
    assert "known are m_a, m_b" in "\n".join(problems)


@pytest.mark.parametrize("line", [line for line in EVERYTHING.splitlines() if "=" in line])
def test_each_alone_is_told_in_the_same_words(tmp_path, line):
    """No mistake is told for another's sake: one that is mended takes its own line away, and no other."""
    everything = set(told(tmp_path, EVERYTHING))
    at = EVERYTHING.splitlines().index(line) + 1
    mended = "\n".join("" if other == line else other for other in EVERYTHING.splitlines())
    left = {problem for problem in everything if f":{at}: " not in problem}
    if line == 'mb = "m_b"':  # without which x alone gives it
        left = {problem for problem in left if "both give" not in problem}
    assert set(told(tmp_path, mended)) == left


def test_what_is_left_out_for_a_mistake_brings_no_other(tmp_path):
    """A port whose entry is wrong is not tied by its name instead, nor is a base that is wrong called missing."""
    text = '[inputs]\nVdc = {signal = "v_dc_v", unit = "pu", sgn = 1}\n[outputs]\nma = {command = "m_b", x = 1}\n'
    assert [problem.split(": ")[1] for problem in told(tmp_path, text)] == ["inputs.Vdc.sgn", "outputs.ma.x"]
    text = '[inputs]\nVdc = {signal = "v_dc_v", unit = "pu"}\n[bases]\ndc_voltage_v = -1.0\n'
    assert [problem.split(": ")[1] for problem in told(tmp_path, text)] == ["bases.dc_voltage_v"]


def test_a_file_that_is_read_alone_is_refused_alone(tmp_path):
    """Where no ports are known, the same is said of the file."""
    file = tmp_path / "my.mapping.toml"
    file.write_text('files = ["absent.csv"]\ncolour = "red"\n', "utf-8")
    with pytest.raises(DoorError, match=r"(?s)2 problems.*:2: colour: .*:1: files\[0\]: there is no file absent.csv"):
        load_mapping(file)


def test_outputs_of_two_kinds_are_told_with_the_rest(tmp_path):
    """That a kind must be named is a problem among others; a kind that is wrong is not asked for as well."""
    file = tmp_path / "my.mapping.toml"
    outputs = [*(port(f"m{p}") for p in "abc"), *(port(f"v{p}_ref") for p in "abc")]
    file.write_text("[inputs]\nVdcc = 1.0\n", "utf-8")
    with pytest.raises(DoorError, match=r"(?s)no such input.*output_kind"):
        map_ports(INPUTS, outputs, read_mapping(file), Nominal())
    file.write_text('output_kind = "all"\n', "utf-8")
    with pytest.raises(DoorError) as found:
        map_ports(INPUTS, outputs, read_mapping(file), Nominal())
    assert "write output_kind" not in str(found.value)


def test_a_program_that_does_not_start(tmp_path):
    """Without ports the file is refused for what is wrong with it by itself, before the program."""
    file = tmp_path / "my.mapping.toml"
    file.write_text("[input]\n", "utf-8")
    with pytest.raises(DoorError, match=r'my.mapping.toml:1: input: unknown key; did you mean "inputs"'):
        ProgramDoor("stdio:absent-program", {}, str(file))
    file.write_text("[inputs]\n", "utf-8")
    with pytest.raises(DoorError, match="absent-program"):
        ProgramDoor("stdio:absent-program", {}, str(file))
