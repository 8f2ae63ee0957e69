"""Parameters that a controller states a range for: refused out of it, or allowed by name and marked everywhere."""

import sys
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "program-python" / "controller.py"
OWN = ("--controller", f'stdio:"{sys.executable}" "{EXAMPLE}"')
BEYOND = ("--set", "controller.reactive_gain=12")
ALLOWED = "--allow-out-of-range"
WORDS = "reactive_gain = 12 (0 to 10)"


@pytest.mark.slow
def test_it_runs_with_the_value_and_every_report_marks_it(program, reports, tmp_path):
    """V+ of 0.8 pu is 0.05 pu below the dead band: 12 times that is 0.6 pu of reactive power, 300 kvar."""
    output = tmp_path / "report"
    sag = ("--profile", "iec61400-21", "--sag", "20%", "--duration", "300ms")
    formats = ("--format", "markdown", "--format", "github", "--output", output)
    ended = program(*sag, *OWN, *BEYOND, ALLOWED, *formats)
    assert f"out of the range that it states, as was allowed: {WORDS}" in ended.err
    found = reports(output)
    assert found.test["measurements"]["during"]["reactive_power_kvar"] == pytest.approx(300, rel=0.02)
    origin = found.json["provenance"]
    assert origin["controller_out_of_range"] == {"reactive_gain": "12 (0 to 10)"}
    assert origin["controller_parameters"]["reactive_gain"] == 12
    assert ALLOWED in origin["command"]
    (marked,) = found.junit.iterfind(".//property[@name='controller_out_of_range']")
    assert marked.get("value") == WORDS
    for file in ("report.md", "github-summary.md"):
        assert WORDS.replace("_", r"\_") in (output / file).read_text("utf-8")
    text = " ".join(found.page.text_content().split())
    assert f"parameters out of its range{WORDS}" in text.replace(" reactive_gain", "reactive_gain")
    assert "Parameters of the controller out of the range that it states, as was allowed" in text


def test_without_the_option_it_is_refused(program, tmp_path):
    """Nothing is run or written."""
    ended = program("--profile", "iec61400-21", "--sag", "20%", *OWN, *BEYOND, "--output", tmp_path / "report")
    assert ended.status == 2
    assert "--set controller.reactive_gain: 12 is out of range; 0 to 10 is allowed" in ended.err
    assert not (tmp_path / "report").exists()


def test_inspect_marks_it(program):
    """It stands beside the range."""
    (row,) = [
        line
        for line in program("controllers", "inspect", OWN[1], *BEYOND, ALLOWED).out.splitlines()
        if line.startswith("reactive_gain")
    ]
    assert row.split() == ["reactive_gain", "12", "0", "to", "10", "(out", "of", "range)", *row.split()[8:]]
    refused = program("controllers", "inspect", OWN[1], *BEYOND)
    assert (refused.status, "12 is out of range; 0 to 10 is allowed" in refused.err) == (2, True)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (("--set", "plant.filter_inductance_h=0"), "--set plant.filter_inductance_h: 0 is out of range; 1e-07 to 1"),
        (("--set", "controller.pr_integral_gain=-1"), "--set controller.pr_integral_gain: -1 is out of range; 0 to"),
    ],
)
def test_ranges_of_our_own_hold(program, given, words):
    """Plant and bundled controller are this program's: what is out of their ranges is refused, and told why."""
    ended = program("--profile", "iec61400-21", "--sag", "20%", *given, ALLOWED)
    assert ended.status == 2
    assert words in ended.err
    assert f"{ALLOWED} is for the parameters of a controller of your own" in ended.err


def test_one_that_lets_nothing_through_is_told(program, judge):
    """With the bundled controller, and where every parameter is within its range."""
    ended = program("--profile", "iec61400-21", "--sag", "20%", "--list", ALLOWED)
    assert f"{ALLOWED} does nothing here: it needs a parameter of a controller of your own" in ended.err
    ended, found = judge("--sag", "20%", "--duration", "20ms", *OWN, "--set", "controller.reactive_gain=2", ALLOWED)
    assert "every parameter is in the range that it states: none had to be allowed out of it" in ended.err
    assert "controller_out_of_range" not in found.json["provenance"]


@pytest.mark.slow
def test_every_process_of_a_run_has_leave(program, reports, tmp_path):
    """Tests that are run beside each other run with the value, too."""
    sags = ("--profile", "iec61400-21", "--test", "VD6*", "--jobs", "2", "--output", tmp_path / "report")
    ended = program(*sags, *OWN, *BEYOND, ALLOWED)
    assert ended.err.count(WORDS) == 1
    assert {test["status"] for test in reports(tmp_path / "report").json["tests"]} <= {"pass", "fail"}
