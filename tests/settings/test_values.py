"""What a file and the environment may say, and what becomes of it."""

from pathlib import Path

import pytest

from pvlvrt_compliance.cli.options import OPTIONS, SETTINGS
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.settings.effective import effective
from pvlvrt_compliance.settings.reading import Level, Value
from pvlvrt_compliance.settings.telling import _each


def test_every_option_is_a_setting_by_its_name():
    """Key and variable follow from the option alone, and no two are the same; what is meant for one call is none."""
    assert {s.field for s in SETTINGS} == set(OPTIONS) - {"list_only", "list_json", "config", "isolated", "debug"}
    for setting in SETTINGS:
        assert setting.kind in (str, float, bool, list[str])
        assert setting.key == OPTIONS[setting.field].names[0][2:].replace("-", "_")
        assert setting.variable == f"PVLVRT_{setting.key}".upper()
    assert len({s.key for s in SETTINGS}) == len(SETTINGS)


def test_no_setting_has_the_name_of_another_variable():
    """$PVLVRT_PROFILES, the folders to look in, and $PVLVRT_CONFIG are no settings."""
    assert not {s.variable for s in SETTINGS} & {"PVLVRT_PROFILES", "PVLVRT_CONFIG"}


@pytest.mark.parametrize(
    ("text", "field", "value"),
    [
        ('profile = "iec61400-21"', "profiles", ["iec61400-21"]),
        ('profile = ["a", "b"]', "profiles", ["a", "b"]),
        ("sag = 0.9", "sag", "0.9"),
        ('sag = "90%"', "sag", "90%"),
        ("scr = 20", "scr", 20.0),
        ("frequency = 50", "frequency", "50"),
        ("csv = true", "csv", True),
        ("csv = false", "csv", False),
        ("set = ['controller.x=1']", "settings", ["controller.x=1"]),
        ('[set]\n"controller.x" = 1\n', "settings", ["controller.x=1"]),
        ('[set.controller]\nx = 1.5\nz = "d"', "settings", ["controller.x=1.5", "controller.z=d"]),
        ('[report_field]\nclient = "Solar Ltd, Madrid"\n', "report_fields", ["client=Solar Ltd, Madrid"]),
    ],
)  # fmt: skip
def test_values_of_a_file(hold, text, field, value):
    """Each is what the option would give: one text is a list of one, a table of NAME=VALUE its pairs."""
    assert hold(text).given == {field: value}


@pytest.mark.parametrize(
    ("name", "text", "field", "value"),
    [
        ("PROFILE", "a b", "profiles", ["a", "b"]),
        ("PROFILE", "a\nC:\\grid\\b.toml\n", "profiles", ["a", r"C:\grid\b.toml"]),
        ("REPORT_FIELD", "client='Solar Ltd' number=7", "report_fields", ["client=Solar Ltd", "number=7"]),
        ("SAG", "90%", "sag", "90%"),
        ("SCR", "20", "scr", 20.0),
        ("CSV", "Yes", "csv", True),
        ("CSV", "0", "csv", False),
    ],
)
def test_values_of_the_environment(hold, name, text, field, value):
    """Lists are words as on a command line, but for the backslash; a flag is yes or no."""
    assert hold(None, {f"PVLVRT_{name}": text}).given == {field: value}


def test_all_problems_of_a_file_at_once(hold):
    """Each with its line, its key, what is wrong and what is allowed or was meant."""
    text = """profiles = "x"
sga = "9%"
csv = 1
scr = true
xr = nan
test = ["a", 5, ""]
sag = [1]
output = ""
two-phase = true
[set]
controller.x = [1]
"""
    with pytest.raises(UsageError) as error:
        hold(text)
    assert str(error.value).splitlines() == [
        "pvlvrt.toml: 11 problems",
        '  pvlvrt.toml:1: profiles: there is no such setting; it is written "profile"',
        '  pvlvrt.toml:2: sga: there is no such setting; did you mean "sag"?',
        "  pvlvrt.toml:3: csv: must be true or false, not 1",
        "  pvlvrt.toml:4: scr: must be a number, not true",
        "  pvlvrt.toml:5: xr: must be a number, not NaN",
        "  pvlvrt.toml:6: test[1]: must be a text, not 5",
        '  pvlvrt.toml:6: test[2]: must be a text that is not empty, not ""',
        "  pvlvrt.toml:7: sag: must be a text, not [1]",
        "  pvlvrt.toml:8: output: must not be empty; leave it out",
        '  pvlvrt.toml:9: two-phase: there is no such setting; it is written "two_phase"',
        "  pvlvrt.toml:11: set.controller.x: must be a number, true, false or a text, not [1]",
    ]


def test_keys_of_a_project(project):
    """In pyproject.toml the table stands before the key."""
    (project / "pyproject.toml").write_text("[tool.pvlvrt]\ncsv = 2\n", "utf-8")
    with pytest.raises(UsageError, match=r"pyproject.toml:2: tool.pvlvrt.csv: must be true or false, not 2"):
        effective(SETTINGS, {}, {}, start=Path.cwd())


def test_all_problems_of_the_environment_at_once(hold):
    """Each names its variable."""
    with pytest.raises(UsageError) as error:
        hold(None, {"PVLVRT_SCR": "x", "PVLVRT_CSV": "maybe", "PVLVRT_SET": "'a"})
    assert str(error.value).splitlines() == [
        "environment: 3 problems",
        "  PVLVRT_CSV: 'maybe' is neither of 1, true, yes, on nor of 0, false, no, off",
        "  PVLVRT_SCR: must be a number, not 'x'",
        """  PVLVRT_SET: "'a" has a quotation mark without its second""",
    ]


def test_variables_that_are_none(hold):
    """A name that is no setting's is told with what was meant, and changes nothing; an empty one is not given."""
    holds = hold(None, {"PVLVRT_SAGG": "1", "PVLVRT_SAG": "", "PVLVRT_PROFILES": "/folder", "OTHER": "x"})
    assert holds.given == {}
    (warning,) = holds.warnings
    assert warning.startswith('PVLVRT_SAGG: there is no setting of this name; did you mean "PVLVRT_SAG"')


PATHS = """
profile = ["iec61400-21", "codes/mine.toml"]
mapping = "ports.toml"
events = "../events.toml"
output = "out"
baseline = "known.baseline"
[report_field]
logo = "logo.png"
client = "a/b"
"""


def test_paths_count_from_the_file(hold, project, monkeypatch):
    """What is a path is found from any folder, what is a name or a text stays; where the file is, so does a path."""
    (project / "sub").mkdir()
    assert hold(PATHS).given["output"] == "out"
    monkeypatch.chdir("sub")
    assert hold(PATHS).given == {
        "profiles": ["iec61400-21", str(Path("../codes/mine.toml"))],
        "mapping": str(Path("../ports.toml")),
        "events": str(Path("../../events.toml")),
        "output": str(Path("../out")),
        "baseline": str(Path("../known.baseline")),
        "report_fields": [f"logo={Path('../logo.png')}", "client=a/b"],
    }


@pytest.mark.parametrize(
    ("spec", "from_below"),
    [
        ("ctrl.py:Mine", f"{Path('../ctrl.py:Mine')}"),
        ("build/libctrl.so", f"{Path('../build/libctrl.so')}"),
        ("stdio:python3 ctrl.py --fast other.py", f"stdio:python3 {Path('../ctrl.py')} --fast other.py"),
        ("tcp://localhost:5000", "tcp://localhost:5000"),
        ("bundled", "bundled"),
    ],
)
def test_a_controller_counts_from_the_file(hold, project, monkeypatch, spec, from_below):
    """Its file does; of a command each word that names a file there; an address is none."""
    (project / "sub").mkdir()
    (project / "ctrl.py").touch()
    monkeypatch.chdir("sub")
    assert hold(f'controller = "{spec}"').given == {"controller": from_below}


class Counted(dict):
    """Lines of items, and how often all of them were gone through."""

    times = 0

    def items(self):
        """All of them."""
        self.times += 1
        return super().items()


def test_many_items_are_told_in_one_go():
    """However many items a list has, the lines of all are gone through once, and each is its own."""
    lines = Counted({f"controller.x{k}={k}": f"a.toml:{k} set" for k in range(50)})
    value = Value(list(lines), Level.FILE, "a.toml:0", "a.toml:0 set", lines)
    assert _each(value) == {"each_from": [f"a.toml:{k}" for k in range(50)]}
    assert lines.times == 1
