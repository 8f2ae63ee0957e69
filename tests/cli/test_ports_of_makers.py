"""Ports of a maker, tied by their names: what a run says of them, and what it refuses."""

import json
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parents[1]
EXAMPLE = HERE.parent / "examples" / "program-python" / "controller.py"
MAKER = f'stdio:"{sys.executable}" "{HERE / "controllers" / "makers.py"}" "{EXAMPLE}"'
GATE = ("--profile", "iec61400-21", "--sag", "50%")
IDC = "input Idc: by its name i_dc_a, but its description speaks of where the power comes from (primary)"


@pytest.mark.slow
def test_a_port_that_is_not_clear_is_told_and_never_tied(program, tmp_path):
    """A run says what is left, why, and what it could be; by a mapping file it is given that, and nothing is said."""
    ended = program("--controller", MAKER, *GATE, "--output", tmp_path / "out")
    assert ended.status == 0, ended.err
    notes = json.loads((tmp_path / "out" / "results.json").read_text("utf-8"))["provenance"]["controller_notes"]
    for said in (ended.err, "\n".join(notes)):
        assert "tied to nothing and left as the controller has them: inputs Idc, T\n" in f"{said}\n"
        assert f"{IDC}; it could be i_dc_a or i_pv_a" in said
        assert "input T: a time, or a temperature? By its name time_s, but the unit 'C' does not fit a time" in said
        assert "I1a and I2a, I1b and I2b, I1c and I2c are each the same current here: the filter has one" in said
    mapping = tmp_path / "maker.mapping.toml"
    mapping.write_text('[inputs]\nIdc = "i_pv_a"\nT = 25.0\n', "utf-8")
    tied = program("--controller", MAKER, "--mapping", mapping, *GATE, "--output", tmp_path / "tied")
    assert (tied.status, tied.out.replace("tied", "out")) == (0, ended.out)
    assert "Idc" not in tied.err


def test_commands_that_are_not_clear_are_refused_with_what_they_could_be(command):
    """Nothing is run on a guess of what drives the bridge; with their unit in a file duties do."""
    ended = command("--controller", f"{MAKER} duties", *GATE)
    assert ended.status == 2
    assert "no output gives m_a, m_b, m_c; outputs that give nothing yet: da (a duty cycle (unit duty) or" in ended.err
    assert "It could be m_a or a share of the link), db (" in ended.err


def test_all_mistakes_of_a_mapping_in_one_run(command, tmp_path):
    """Of keys, of ports on both sides and of units: each by file, line and key."""
    mapping = tmp_path / "maker.mapping.toml"
    mapping.write_text(
        '[inputs]\nIdc = {signal = "i_pv_a", sing = -1}\nVdc = "v_dc_v"\nT = {signal = "time_s", unit = "C"}\n'
        '[outputs]\nm_a = "m_x"\n',
        "utf-8",
    )
    ended = command("--controller", MAKER, "--mapping", mapping, *GATE)
    assert ended.status == 2
    said = ended.err.replace(f"{tmp_path}/", "")
    assert "4 problems" in said
    assert 'maker.mapping.toml:2: inputs.Idc.sing: unknown key; did you mean "sign"' in said
    assert "maker.mapping.toml:3: inputs.Vdc: the controller has no such input; did you mean" in said
    assert "maker.mapping.toml:4: inputs.T: the unit 'C' does not fit a time; allowed: s, ms, us" in said
    assert "maker.mapping.toml:6: outputs.m_a: 'm_x' is no command" in said
