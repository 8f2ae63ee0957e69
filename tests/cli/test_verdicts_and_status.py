"""One verdict, seen in the terminal, in every file and in the exit status."""

import os
import subprocess
import sys

import pytest

from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.study import run as study_run

TRIP = ("--set", "protection.overcurrent_pu=1.1")


@pytest.fixture(scope="module")
def tripped(command, reports, tmp_path_factory):
    """The main job with an overcurrent relay that is set too low."""
    folder = tmp_path_factory.mktemp("tripped") / "out"
    return command("--profile", "iec61400-21", "--sag", "90%", *TRIP, "--output", folder), reports(folder)


def test_a_failed_check_ends_with_1(tripped):
    """Failed ride-through; the current up to the trip; what cannot be judged after it is not applicable."""
    ended, reports = tripped
    assert ended.status == 1
    assert reports.verdicts[reports.test["id"]] == {
        "ride_through": "fail",
        "current_limit": "pass",
        "reactive_support": "not_applicable",
        "active_power_support": "not_applicable",
        "oscillation": "not_applicable",
        "return_to_prefault": "not_applicable",
        "dc_ripple": "not_applicable",
    }


def test_the_terminal_says_so(tripped):
    """Row, reason and summary."""
    ended, _ = tripped
    lines = ended.out.splitlines()
    assert " fail " in next(line for line in lines if line.startswith("ride_through"))
    assert any(line.startswith("FAIL: 1 test; checks: 1 fail, 1 pass, 5 not applicable") for line in lines)
    assert "tripped at 0.30" in " ".join(ended.out.split())


def test_junit_says_so(tripped):
    """One failure, the others skipped."""
    _, reports = tripped
    outcomes = {case.get("name"): [child.tag for child in case] for case in reports.junit.iter("testcase")}
    assert outcomes == {
        "ride_through": ["failure"],
        "current_limit": ["system-out"],
        "reactive_support": ["skipped"],
        "active_power_support": ["skipped"],
        "oscillation": ["skipped"],
        "return_to_prefault": ["skipped"],
        "dc_ripple": ["skipped"],
    }


def test_the_page_says_so(tripped):
    """Verdict at the top, and the row of the check."""
    _, reports = tripped
    page = reports.page
    assert page.get_element_by_id("verdict").get("data-status") == "fail"
    rows = {row.get("data-check"): row.get("data-status") for row in page.xpath("//tr[@data-check]")}
    assert rows == reports.verdicts[reports.test["id"]]


@pytest.fixture
def second_overflows(monkeypatch):
    """The second test of a run is simulated with a gain at which no number stays finite."""
    seen = []

    def simulator(scenario, parameters):
        seen.append(scenario)
        return simulate(scenario, parameters_from(["controller.sogi_gain=1000"]) if len(seen) == 2 else parameters)

    right = study_run.run_test
    monkeypatch.setattr(study_run, "run_test", lambda *arguments: right(*arguments[:3], simulator=simulator))


@pytest.mark.usefixtures("second_overflows")
def test_a_number_that_is_not_finite(judge):
    """That test is an error and the run ends with 3; the other tests still run and are reported."""
    ended, reports = judge("--test", "VD2-full-*", "--test", "VD3-full-1")
    assert ended.status == 3
    statuses = {test["id"]: test["status"] for test in reports.json["tests"]}
    assert statuses == {"VD2-full-1": "pass", "VD2-full-2": "error", "VD3-full-1": "pass"}
    assert set(reports.verdicts["VD2-full-2"].values()) == {"error"}
    assert len(reports.verdicts["VD2-full-2"]) == 7
    assert "ERROR: 3 tests; checks: 7 error, 14 pass" in ended.out
    assert "a number stopped being finite at 0.0" in " ".join(ended.out.split())
    assert reports.junit.get("errors") == "7"
    assert reports.page.get_element_by_id("verdict").get("data-status") == "error"
    assert "waveforms/VD2-full-1.dat" in reports.files
    assert "waveforms/VD2-full-2.dat" not in reports.files


def test_a_test_that_does_not_start_as_it_should(judge):
    """An MPPT that is kept off the maximum-power point says nothing about the inverter in a sag: status 3."""
    options = ("--irradiance", "800", "--set", "controller.mppt_voltage_max_v=610")
    ended, reports = judge("--sag", "90%", *options)
    assert ended.status == 3
    assert set(reports.verdicts[reports.test["id"]].values()) == {"not_evaluated"}
    assert "NOT EVALUATED: 1 test; checks: 7 not evaluated" in ended.out
    assert {case.find("error").get("type") for case in reports.junit.iter("testcase")} == {"not_evaluated"}


@pytest.mark.slow
def test_reader_that_goes_away(tmp_path):
    """A reader that closes the pipe early (`| head`) does not change the verdict."""
    command = [sys.executable, "-m", "pvlvrt_compliance.cli.main", "--profile", "iec61400-21", "--sag", "90%"]
    command += ["--output", str(tmp_path)]
    for options, status in (((), 0), (TRIP, 1)):
        read, write = os.pipe()
        os.close(read)
        done = subprocess.run(
            [*command, *options],
            stdout=write,
            stderr=subprocess.PIPE,
            check=False,
        )
        os.close(write)
        assert (done.returncode, done.stderr) == (status, b"")


def test_a_crash_is_not_a_failed_check():
    """An error of the program itself ends with 3 and its traceback, never with 1, which is a verdict."""
    # In a process of its own, whose signals are the command's.
    code = (
        "from pvlvrt_compliance.cli import main\n"
        "def crash(_arguments): raise RuntimeError('a bug')\n"
        "main.run = crash\n"
        "main.main()\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (3, "")
    assert "RuntimeError: a bug" in done.stderr
