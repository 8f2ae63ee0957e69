"""Settings of a file and of the environment, seen in what the command says and leaves."""

import json
import shlex

import pytest


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A folder below one with a file of settings: ``project(text)``; the working directory is that folder."""
    (tmp_path / "sub").mkdir()
    (tmp_path / ".git").mkdir()
    monkeypatch.chdir(tmp_path / "sub")

    def write(text):
        (tmp_path / "pvlvrt.toml").write_text(text, "utf-8")
        return tmp_path

    return write


LIST = 'profile = "iec61400-21"\ntest = ["VD3*"]\n'


def test_a_run_says_which_file_it_took(command, project):
    """On stderr in one line, but with --quiet, typed or written; nothing is said where there is none."""
    project(LIST)
    ended = command("--list")
    assert ended.out.splitlines()[-1] == "4 tests of iec61400-21"
    assert ended.err == "pvlvrt-check: settings of ../pvlvrt.toml (profile, test)\n"
    assert command("--list", "--quiet").err == ""
    assert command("--list", PVLVRT_QUIET="yes").err == ""
    assert command("--list", "--isolated", "--profile", "iec61400-21").err == ""


def test_command_line_over_environment_over_file(command, project):
    """The nearest to the command counts, and a list is not joined with another."""
    project(LIST)
    assert command("--list", PVLVRT_TEST="VD2*").out.splitlines()[-1] == "4 tests of iec61400-21"
    assert "VD2-full-1" in command("--list", PVLVRT_TEST="VD2*").out
    assert "VD3" not in command("--list", "--test", "VD6-full-*", PVLVRT_TEST="VD2*").out


def test_a_sag_puts_the_tests_of_a_file_aside(command, project):
    """What was not typed is not refused for what was; it is told."""
    project(LIST)
    ended = command("--list", "--sag", "50%")
    assert ended.out.splitlines()[-1] == "1 test of iec61400-21"
    assert "pvlvrt-check: ../pvlvrt.toml:2 test is put aside: it does not go with --sag\n" in ended.err


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('sag = "50%"\nphases = "ac"', "../pvlvrt.toml:2 phases ac: unknown"),
        ('duration = "1s"', "--phases, --two-phase, --sag-type, ../pvlvrt.toml:1 duration,"),
        ('set = ["a.b=1"]', "../pvlvrt.toml:1 set a.b: unknown parameter"),
        (
            '[set]\n"sensors.adc_bits" = 12\n\n"controller.nonesuch" = 2',
            "../pvlvrt.toml:4 set controller.nonesuch: unknown",
        ),
        ("[set.controller]\nprecision = 1\nnonesuch = 2", "../pvlvrt.toml:3 set controller.nonesuch: unknown"),
        ('set = [\n"sensors.adc_bits=12",\n"a.b=1"]', "../pvlvrt.toml:3 set a.b: unknown parameter"),
        ('[set]\n"sensors.adc_bits" = 12\n"simulation.fidelity" = "z"', "../pvlvrt.toml:3 set simulation.fidelity:"),
        ('test = [\n"VD1",\n"VX"]', "../pvlvrt.toml:3 test VX: no test of this name"),
        ('check = [\n"ride_through",\n"rde"]', "../pvlvrt.toml:3 check rde: no check of"),
        ('test = ["VX"]', "../pvlvrt.toml:1 test VX: no test of this name"),
        ('sag = "5"', "../pvlvrt.toml:1 sag: '5' is outside"),
        ("sga = 5", "../pvlvrt.toml: 1 problem"),
        ("sag =", "../pvlvrt.toml:1: sag: not TOML"),
    ],
)
def test_what_cannot_be_used_is_told_where_it_stands(command, project, text, said):
    """Status 2, with file and line of the value, as an option is told by its name."""
    project(text)
    ended = command("--list", "--profile", "iec61400-21")
    assert ended.status == 2
    assert said in ended.err


def test_a_field_of_a_title_page_is_told_where_it_stands(command, project):
    """By the line of its key, and before anything is run."""
    project('[report_field]\nclient = "a"\nnonsuch = "b"')
    ended = command("--profile", "iec61400-21", "--sag", "9%")
    assert ended.status == 2
    assert "../pvlvrt.toml:3 report_field: no field 'nonsuch'" in ended.err


@pytest.mark.parametrize(
    "arguments",
    [
        ("--list", "--profile", "iec61400-21", "--quiet"),
        ("--profile", "iec61400-21"),
        ("compare", "bundled", "bundled", "--profile", "iec61400-21"),
        ("baseline", "update", "--results", "x"),
    ],
)
def test_nothing_is_run_beside_a_file_of_somebody_else(command, project, arguments):
    """It may name the controller that is meant: no other one is judged in its place, and it is said how to go on."""
    (project(LIST) / "pvlvrt.toml").chmod(0o666)
    ended = command(*arguments)
    assert (ended.status, ended.out) == (2, "")
    assert ended.err == (
        "pvlvrt-check: ../pvlvrt.toml is not used: anybody may write it, and it may name code to run;"
        " --config ../pvlvrt.toml uses it all the same, --isolated runs without it\n"
    )


def test_going_on_beside_a_file_of_somebody_else(command, project):
    """By either of the options that are told: with the file, or without it."""
    (project(LIST) / "pvlvrt.toml").chmod(0o666)
    assert command("--list", "--isolated", "--profile", "iec61400-21").out.splitlines()[-1] == "27 tests of iec61400-21"
    assert command("--list", "--config", "../pvlvrt.toml").out.splitlines()[-1] == "4 tests of iec61400-21"


RUN = """
profile = "iec61400-21"
sag = "20%"
duration = "100ms"
output = "out"
[set]
"controller.reactive_plateau_pu" = 0
[report_field]
client = "Solar Ltd"
"""


def test_a_run_by_a_file_and_again_without_it(command, project, reports, tmp_path):
    """The run goes where the file says, keeps what it took, and its command gives the same run without the file."""
    found = reports(project(RUN) / "out")
    assert command().status in (0, 1)
    origin = found.json["provenance"]
    assert origin["parameters"]["controller"]["reactive_plateau_pu"] == 0
    assert origin["settings"]["file"] == "../pvlvrt.toml"
    assert origin["settings"]["values"]["sag"] == {"value": "20%", "from": "../pvlvrt.toml:3"}
    assert found.json["report"]["fields"] == {"client": "Solar Ltd"}
    first = found.json
    (tmp_path / "pvlvrt.toml").unlink()
    assert shlex.split(origin["command"])[:2] == ["pvlvrt-check", "--isolated"]
    command(*shlex.split(origin["command"])[1:])
    assert found.json["run_id"] == first["run_id"]
    assert found.json["report"] == first["report"]
    assert "settings" not in found.json["provenance"]


def test_config_show(command, project):
    """Every value with where it comes from, what gives way, and the file; in JSON the same."""
    project(LIST)
    ended = command("config", "show", "--sag", "50%", PVLVRT_CSV="yes")
    assert [line.split() for line in ended.out.splitlines()[2:]] == [
        ["profile", "iec61400-21", "../pvlvrt.toml:1"],
        ["sag", "50%", "command", "line"],
        ["csv", "true", "PVLVRT_CSV"],
        ["file", "of", "settings:", "../pvlvrt.toml;", "everything", "else", "is", "at", "its", "default"],
        ["../pvlvrt.toml:2", "test", "is", "put", "aside:", "it", "does", "not", "go", "with", "--sag"],
    ]
    told = json.loads(command("config", "show", "--json", "--sag", "50%", PVLVRT_CSV="yes").out)
    assert told == {
        "file": "../pvlvrt.toml",
        "why_not": None,
        "values": {
            "profile": {"value": ["iec61400-21"], "from": "../pvlvrt.toml:1"},
            "sag": {"value": "50%", "from": "command line"},
            "csv": {"value": True, "from": "PVLVRT_CSV"},
        },
        "put_aside": ["../pvlvrt.toml:2 test is put aside: it does not go with --sag"],
        "warnings": [],
    }


def test_config_show_of_what_is_taken_back(command, project):
    """A value that an empty one takes back is at its default, by the command line."""
    project(LIST + "scr = 5\n")
    rows = [line.split() for line in command("config", "show", "--scr", "", "--test", "").out.splitlines()]
    assert ["test", "(default)", "command", "line"] in rows
    assert ["scr", "(default)", "command", "line"] in rows
    told = json.loads(command("config", "show", "--json", "--scr", "").out)
    assert told["values"]["scr"] == {"value": None, "from": "command line"}
    assert command("--list", "--test", "", "--scr", "").out.splitlines()[-1] == "27 tests of iec61400-21"
    assert "--xr: '' is not a ratio" in command("--list", "--xr", "").err


def test_config_show_tells_each_item_of_a_list(command, project):
    """By the line of its own, beside it."""
    project('scr = 2\n[set]\n"plant.x" = 1\n\n"plant.y" = 2\n')
    rows = [line.split() for line in command("config", "show").out.splitlines()[3:5]]
    assert rows == [["set", "plant.x=1", "../pvlvrt.toml:3"], ["plant.y=2", "../pvlvrt.toml:5"]]
    told = json.loads(command("config", "show", "--json").out)["values"]["set"]
    assert (told["from"], told["each_from"]) == ("../pvlvrt.toml:2", ["../pvlvrt.toml:3", "../pvlvrt.toml:5"])


def test_config_show_without_a_file(command, project, tmp_path):
    """Where nothing is found it says how far it looked; what is refused, why."""
    ended = command("config", "show")
    assert ended.out == (
        "no file of settings: no pvlvrt.toml, and no pyproject.toml with [tool.pvlvrt], from here up to"
        f" {tmp_path}, the root of the repository; everything is at its default\n"
    )
    (project(LIST) / "pvlvrt.toml").chmod(0o666)
    assert command("config", "show").out.count("anybody may write it") == 1
    assert command("config", "show", "--isolated").out.startswith("no file of settings: --isolated;")
