"""Checks that another package brings: built, installed and found by their entry point, as a user would have them."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

PYPROJECT = """
[build-system]
requires = ["hatchling"]
build-backend = "hatchling.build"

[project]
name = "house-rules"
version = "1.0"

[project.entry-points."pvlvrt_compliance.checks"]
house-rules = "house_rules:CHECKS"
"""

MODULE = '''
"""Rules of a house: V+ has a floor, and nobody lets go within a time."""

from pvlvrt_compliance.checks.api import Band, Check, Positive, Requirement, judged, pass_or_fail


class Floor(Requirement):
    """Lowest mean V+ of a sag."""

    floor_pu: Positive


class Stay(Requirement):
    """Least time of connection from the start."""

    stay_s: Positive


class FloorCheck(Check):
    """V+ keeps above a floor."""

    kind = "voltage_floor"
    title = "Floor of the voltage"
    requirement = Floor

    def judge(self, requirement, evidence):
        low, limit = evidence.during().voltage_positive_pu, requirement.floor_pu
        return judged(
            self.kind, requirement, pass_or_fail(low >= limit.value), f"V+ was {low:.3f} pu", measured=low,
            limit=limit.value, margin=low - limit.value, unit="pu", at_s=evidence.disturbance.start_s, rests_on=[limit],
        )

    def limits(self, requirement, evidence):
        span, level = (0.0, evidence.waveforms.end_s), (requirement.floor_pu.value,) * 2
        return [Band(check=self.kind, quantity="voltage_positive_pu", name="floor of the house", t_s=span, lower=level)]


class StayCheck(Check):
    """Connected for a time."""

    kind = "house_stay"
    title = "Stay of the house"
    requirement = Stay
    judges_connection = True

    def judge(self, requirement, evidence):
        opened_s, limit = evidence.disconnected_at_s, requirement.stay_s
        end_s = evidence.waveforms.end_s if opened_s is None else opened_s
        stayed_s = end_s - evidence.disturbance.start_s
        return judged(
            self.kind, requirement, pass_or_fail(stayed_s >= limit.value), f"stayed; {evidence.trip_cause}",
            measured=stayed_s, limit=limit.value, margin=stayed_s - limit.value, unit="s", at_s=end_s, rests_on=[limit],
        )


CHECKS = (FloorCheck, StayCheck)
'''

PROFILE = """schema_version = 1
id = "house"
title = "rules of the house"
include = ["iec61400-21"]
[requirements.voltage_floor]
clause = "H 1"
source = "the house"
{number} = {{ value = 0.4, confidence = "chosen", source = "the house" }}
[requirements.house_stay]
clause = "H 2"
source = "the house"
stay_s = {{ value = 0.2, confidence = "chosen", source = "the house" }}
"""


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    """Folder that the package is installed in, from a wheel that was built of it."""
    folder = tmp_path_factory.mktemp("house")
    (folder / "pyproject.toml").write_text(PYPROJECT, "utf-8")
    (folder / "house_rules.py").write_text(MODULE, "utf-8")
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    subprocess.run([*pip, "wheel", "--no-deps", "--wheel-dir", folder / "dist", folder], check=True, cwd=folder)
    (wheel,) = (folder / "dist").glob("*.whl")
    subprocess.run([*pip, "install", "--no-deps", "--target", folder / "site", wheel], check=True, cwd=folder)
    return folder / "site"


@pytest.fixture
def check(site, tmp_path):
    """Run the command with the package installed: ``check(profile_text, *arguments)``."""

    def run(text: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        profile = tmp_path / "house.toml"
        profile.write_text(text, "utf-8")
        command = [sys.executable, "-m", "pvlvrt_compliance.cli.main", *arguments, str(profile)]
        path = os.pathsep.join(filter(None, [str(site), os.environ.get("PYTHONPATH")]))
        environment = os.environ | {"PYTHONPATH": path, "NO_COLOR": "1"}
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)

    return run


def results_in(folder: Path) -> dict:
    """The verdicts of a run by the name of their check, and the test itself."""
    (test,) = json.loads((folder / "results.json").read_text("utf-8"))["tests"]
    return {verdict["check"]: verdict for verdict in test["checks"]} | {"test": test}


@pytest.mark.slow
def test_its_requirement_is_typed_judged_and_drawn(check, tmp_path):
    """A requirement of its own stands beside the built-in ones; its band is in the figure."""
    done = check(PROFILE.format(number="floor_pu"), "--sag", "50%", "--output", "out", "--profile")
    assert done.returncode == 0, done.stdout + done.stderr
    found = results_in(tmp_path / "out")
    assert (found["voltage_floor"]["status"], found["voltage_floor"]["clause"]) == ("pass", "H 1")
    assert found["voltage_floor"]["margin"] == pytest.approx(0.1, abs=1e-3)
    assert "floor of the house" in {band["name"] for band in found["test"]["bands"]}
    assert "floor of the house" in (tmp_path / "out" / "report.html").read_text("utf-8")


def test_its_mistakes_are_named_with_line_and_key(check):
    """A key that its model does not have is told as any other, with the near miss."""
    done = check(PROFILE.format(number="flor_pu"), "profiles", "check")
    assert done.returncode == 2
    assert 'house.toml:8: requirements.voltage_floor.flor_pu: unknown key; did you mean "floor_pu"?' in done.stderr
    assert "requirements.voltage_floor.floor_pu: missing" in done.stderr


def test_it_judges_the_connection_of_an_inverter_that_tripped(check, tmp_path):
    """A check of the connection has its say after a trip and knows the cause; one of the voltage has not."""
    arguments = ("--sag", "90%", "--duration", "500ms", "--output", "out", "--profile")
    done = check(PROFILE.format(number="floor_pu"), *arguments)
    found = results_in(tmp_path / "out")
    assert (found["house_stay"]["status"], found["voltage_floor"]["status"]) == ("pass", "not_applicable"), done.stderr
    assert found["house_stay"]["message"] == "stayed; under-voltage relay of the plant"
    assert found["test"]["trip_cause"] == "under-voltage relay of the plant"
    assert "under-voltage relay of the plant" in (tmp_path / "out" / "report.html").read_text("utf-8")


def test_its_schema_is_published(site, tmp_path):
    """An editor completes its keys, too."""
    command = [sys.executable, "-m", "pvlvrt_compliance.cli.main", "profiles", "schema"]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, [str(site), os.environ.get("PYTHONPATH")]))}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True)
    schema = json.loads(done.stdout)
    assert "floor_pu" in schema["$defs"]["Floor"]["properties"]
