"""Selecting tests and checks at the command line, and the lists of what there is."""

import json

import pytest

from consoles import PROGRAM
from pvlvrt_compliance.profile import load_profile

IEC = "iec61400-21"
KEYS = [
    "profile", "id", "row", "table_row", "title", "what_happens", "duration_s", "irradiance_w_m2", "point_on_wave_deg",
    "frequency_hz", "checks", "expect", "clause", "confidence", "long",
]  # fmt: skip


def test_fail_fast_then_what_failed(command, reports, tmp_path):
    """A run ends at the first failure with a whole set of files; the next one repeats that test, judged by less."""
    asked = ("--profile", IEC, "--test", "VD1-full", "--test", "VD3-full-1", "--output", tmp_path / "out", "-q")
    ended = command(*asked, "--fail-fast")
    assert ended.status == 1
    assert ended.out == (
        "FAIL: 1 test; checks: 1 fail, 6 pass; 24 tests not selected; 2 not run after VD1-full-1 (--fail-fast)\n"
    )
    found = reports(tmp_path / "out")
    assert {"report.html", "junit.xml", "results.json"} <= found.files
    (profile,) = found.json["profiles"]
    assert (found.json["ended_at"], profile["not_run"]) == (f"{IEC}.VD1-full-1", ["VD1-full-2", "VD3-full-1"])
    ended = command(*asked, "--last-failed", "--check", "dc_ripple")
    assert (ended.status, reports(tmp_path / "out").verdicts) == (0, {"VD1-full-1": {"dc_ripple": "pass"}})
    assert ended.err == f"{PROGRAM}: --last-failed: 1 of the 3 tests selected was not passed the last time\n"
    assert reports(tmp_path / "out").json["profiles"][0]["selected_checks"] == ["dc_ripple"]
    ended = command(*asked, "--last-failed", "--list", "--json")
    assert [test["id"] for test in json.loads(ended.out)] == ["VD1-full-1", "VD1-full-2", "VD3-full-1"]
    assert "none of the tests selected failed the last time; all are run" in ended.err


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--skip", "VD9"), "--skip VD9: no test of this name; did you mean"),
        (("--skip", "*"), "--skip *: all 27 tests selected are skipped"),
        (("--check", "ripple"), '--check ripple: no check of iec61400-21; did you mean "dc_ripple"?'),
        (("--sag", "50%", "--skip", "VD1"), "--skip selects from the profile's own tests; it does not go with --sag"),
        (("--json",), "'--json': goes with --list only"),
    ],
)
def test_what_cannot_be_selected(command, tmp_path, arguments, says):
    """Wrong usage, told in one line; nothing is written."""
    ended = command("--profile", IEC, "--output", tmp_path / "out", *arguments)
    assert (ended.status, ended.out) == (2, "")
    assert says in ended.err
    assert len(ended.err.splitlines()) == 1
    assert not (tmp_path / "out").exists()


def test_the_list_for_programs(command):
    """One array, an object a test with the keys that are promised, of the tests that would be run."""
    ended = command("--profile", IEC, "--list", "--json", "--test", "VD3-full", "--skip", "*-2", "--check", "dc_ripple")
    (entry,) = json.loads(ended.out)
    test = next(test for test in load_profile(IEC).tests() if test.id == "VD3-full-1")
    assert list(entry) == KEYS
    assert entry | {
        "profile": IEC,
        "id": "VD3-full-1",
        "row": "VD3-full",
        "table_row": "VD3",
        "title": test.title,
        "duration_s": 0.2,
        "irradiance_w_m2": 1000.0,
        "point_on_wave_deg": 0.0,
        "frequency_hz": 50.0,
        "checks": ["dc_ripple"],
        "expect": "ride_through",
        "clause": test.clause,
        "confidence": "memory",
        "long": False,
    } == entry  # fmt: skip


@pytest.mark.parametrize("columns", ["20", "80", "500"])
def test_a_list_that_is_piped_is_not_cut(command, columns):
    """A test a line with every word of it, whatever width a terminal has."""
    ended = command("--profile", "nerc-prc-029", "--profile", IEC, "--list", COLUMNS=columns)
    lines = [line.split() for line in ended.out.splitlines()]
    tests = [test for name in ("nerc-prc-029", IEC) for test in load_profile(name).tests() if not test.long]
    listed = [line for line in lines if line[0] in {"nerc-prc-029", IEC}]
    assert [line[1] for line in listed] == [test.id for test in tests]
    for line, test in zip(listed, tests, strict=True):
        assert " ".join(line[2:-5]) == test.scenario.describe()
        assert line[-1] == test.confidence
    assert "…" not in ended.out


def test_profiles_for_programs(command, tmp_path):
    """Every profile that can be named, with what is wrong with one that cannot be read."""
    (tmp_path / "mine.toml").write_text("schema_version = 1\n", "utf-8")
    ended = command("profiles", "list", "--json", PVLVRT_PROFILES=str(tmp_path))
    found = {entry["name"]: entry for entry in json.loads(ended.out)}
    assert ended.status == 2
    assert found["mine"]["problems"]
    profile = load_profile(IEC)
    assert found[IEC]["problems"] == []
    assert (found[IEC]["title"], found[IEC]["tests"]) == (profile.title, len(profile.tests()))
    assert found[IEC]["digest"] == profile.digest


@pytest.mark.parametrize("columns", ["20", "500"])
def test_the_list_of_profiles_is_not_cut_when_piped(command, columns):
    """A profile a line, with the whole of its title."""
    lines = command("profiles", "list", COLUMNS=columns).out.splitlines()
    assert [line for line in lines if line.startswith(f"{IEC} ") and load_profile(IEC).title in line]


def test_a_terminal_that_is_narrow_cuts_nothing(command):
    """What has no room beside the others goes on in the next line; every id stands there whole."""
    ended = command("--profile", "nerc-prc-029", "--list", "--test", "*bc*", COLUMNS="64", FORCE_COLOR="1")
    assert max(map(len, ended.out.splitlines())) < 64 + len("\x1b[1m\x1b[0m") * 2 * len(KEYS)
    for name in ("0.005pu-0.32s-bc-partial", "0.705pu-6s-bc-full"):
        assert name in ended.out
    assert "…" not in ended.out
