"""The file that ties ports to the plant: what it may say, and what is said of its mistakes."""

from pathlib import Path

import pytest

from ports import port
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.mapping.file import load_mapping
from pvlvrt_compliance.controllers.mapping.sides import map_inputs, map_outputs
from pvlvrt_compliance.units import Nominal

NOMINAL = Nominal()


def map_both(file, inputs, outputs):
    """Tie both sides as a file says."""
    mapping = load_mapping(file)
    map_inputs(inputs, mapping, NOMINAL)
    map_outputs(outputs, mapping, NOMINAL)


def refused(tmp_path, text, inputs=(), outputs=()):
    """What is said of a mapping file, without the name of its folder."""
    file = tmp_path / "my.mapping.toml"
    file.write_text(text, "utf-8")
    with pytest.raises(DoorError) as found:
        map_both(file, inputs, outputs)
    return str(found.value).replace(f"{tmp_path}/", "")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "[inputs]\nVdcc = 'v_dc_v'",
            'my.mapping.toml:2: inputs.Vdcc: the controller has no such input; did you mean "Vdc"?',
        ),
        ("[inputs]\n\nVdc = 'v_dc'", "my.mapping.toml:3: inputs.Vdc: 'v_dc' is no signal; did you mean \"v_dc_v\""),
        (
            "[inputs]\nVdc = {signal = 'v_dc_v', unit = 'kA'}",
            "the unit 'kA' does not fit a DC voltage; allowed: V, kV, pu",
        ),
        ("[inputs]\nVdc = {signal = 'v_dc_v', unit = 'pu'}", "write dc_voltage_v under [bases]"),
        ("[inputs]\nVdc = {signal = 'v_dc_v', unit = 'V', base = 1.0}", "a base is for ports in pu, not in V"),
        ("[inputs]\nVdc = {signal = 'v_dc_v', direction = 'into_inverter'}", "direction is for phase currents"),
        ("[inputs]\nabc = 'u_a_v'", "1 name for 3 elements"),
        ("[inputs]\nabc = ['u_a_v', 'u_b_v']", "2 names for 3 elements"),
        ("[inputs]\nabc = []", "0 names for 3 elements"),
        ("[inputs]\n'abc[3]' = 'u_a_v'", "abc has 3 elements, counted from 0"),
        ("[inputs]\nVdc = true", "my.mapping.toml:2: inputs.Vdc: must be a table"),
        ("[inputs]\nVdc = {unit = 'V'}", "give a signal or a constant"),
        ("[inputs]\nVdc = {signal = 'v_dc_v', sing = -1}", 'unknown key; did you mean "sign"'),
        ("[input]\nVdc = 'v_dc_v'", 'unknown key; did you mean "inputs"'),
        ("[bases]\nvoltage = 'rms'", "my.mapping.toml:2: bases.voltage:"),
        ("[outputs]\nma = 'm_d'", "'m_d' is no command"),
        ("[outputs]\nma = {record = 'v_dc_v'}", "the record has a channel 'v_dc_v' already"),
        ("[outputs]\nma = {record = 'a b'}", "not a name for a channel"),
        ("[outputs]\nma = 'm_a'\nmb = 'm_a'", "ma and mb both give m_a"),
        ("[outputs\n", "not TOML"),
    ],
)
def test_mistakes_are_told_by_line_and_key(tmp_path, text, words):
    """Every mistake in a mapping file names its place and what is allowed."""
    inputs = [port("Vdc", "V"), port("abc", "V", 3)]
    assert words in refused(tmp_path, text, inputs, [port("ma"), port("mb")])


def test_all_problems_at_once(tmp_path):
    """Two mistakes are told in one go."""
    said = refused(tmp_path, "[inputs]\na = 'x'\nb = {signal = 'u_a_v', unit = 'W'}", [port("a"), port("b")])
    assert said.splitlines()[0].endswith("2 problems")
    assert [line.split(":")[1] for line in said.splitlines()[1:]] == ["2", "3"]


def test_unit_that_does_not_fit_a_name_leaves_the_port_untied():
    """A name alone forces nothing: the port is left, with the reason, so that it can be looked at."""
    mapped = map_inputs([port("Vdc", "pu"), port("Va", "W")], None, NOMINAL)
    assert mapped.unmapped == ("Vdc", "Va")
    assert "dc_voltage_v" in mapped.ports[0].note
    assert "does not fit a voltage" in mapped.ports[1].note


def test_no_mapping_file_is_none():
    """Nothing is read where nothing is named; a file that is not there is an error."""
    assert load_mapping(None) is None
    with pytest.raises(DoorError, match="cannot be read"):
        load_mapping("absent.toml")


def test_example_on_the_page_is_a_mapping_file(tmp_path):
    """The file that the documentation shows is one, for a controller with its ports."""
    page = (Path(__file__).parents[3] / "docs" / "controllers.md").read_text("utf-8")
    file = tmp_path / "page.mapping.toml"
    file.write_text(page.partition("```toml\n")[2].partition("```")[0], "utf-8")
    names = ["Va", "Vdc", "Vdc_pu", "Ia", "Ipv", "Vref"]
    inputs = [*(port(name) for name in names), port("V_abc", width=3), port("y", width=4)]
    mapped = map_inputs(inputs, load_mapping(file), NOMINAL)
    assert mapped.unmapped == ("y[0]", "y[1]", "y[2]")
    assert map_outputs(
        [port("ma"), port("Ea"), port("run"), port("Pout", "W"), port("Pref")], load_mapping(file), NOMINAL
    ).recorded == ("p_out_w", "p_ref_w")


def test_files_that_a_mapping_lists(tmp_path):
    """By names and patterns, from its folder on; each once, in the order of their names."""
    (tmp_path / "lib" / "inner").mkdir(parents=True)
    for name in ("gains.csv", "lib/b.py", "lib/a.py", "lib/inner/c.py"):
        (tmp_path / name).write_text("")
    file = tmp_path / "my.mapping.toml"
    file.write_text('files = ["lib/*.py", "gains.csv", "lib/a.py", "lib/**/*.py"]\n')
    found = [path.relative_to(tmp_path).as_posix() for path in load_mapping(file).listed]
    assert found == ["gains.csv", "lib/a.py", "lib/b.py", "lib/inner/c.py"]


@pytest.mark.parametrize(
    ("files", "words"),
    [
        (
            '["gains.csv",\n"gain.csv"]',
            "my.mapping.toml:2: files[1]: there is no file gain.csv in the folder of the mapping",
        ),
        ('["lib/*.py"]', "my.mapping.toml:1: files[0]: there is no file lib/*.py"),
        (
            '["../other.csv"]',
            "files[0]: '../other.csv' must be the name of a file in the folder of the mapping, or a pattern",
        ),
        ('["/etc/passwd"]', "files[0]: '/etc/passwd' must be the name of a file in the folder"),
        ('[""]', "files[0]: '' must be the name of a file"),
        ('["link.csv"]', "files[0]: link.csv is a link to a file outside of the folder of the mapping"),
        ('["hole*"]', "files[0]: hole.bin is larger than 256 MiB"),
        ('"gains.csv"', "my.mapping.toml:1: files: must be a list"),
    ],
)
def test_files_that_cannot_be_listed(tmp_path, files, words):
    """Those that are not there, and those outside of the folder, which a digest would have to open."""
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "gains.csv").write_text("")
    (tmp_path / "other.csv").write_text("")
    (tmp_path / "mine" / "link.csv").symlink_to(tmp_path / "other.csv")
    with (tmp_path / "mine" / "hole.bin").open("wb") as hole:
        hole.truncate(1 << 40)
    assert words in refused(tmp_path / "mine", f"files = {files}\n")


def test_a_whole_number_of_5000_digits(tmp_path):
    """One line with file, line and key, as of any file that people write."""
    (tmp_path / "ports.toml").write_text(f"[inputs.u]\nsignal = 'u_a_v'\nsign = {'9' * 5000}\n", "utf-8")
    with pytest.raises(DoorError, match=r"ports.toml:3: inputs.u.sign: not TOML: a whole number of more than 64 bits"):
        load_mapping(tmp_path / "ports.toml")
