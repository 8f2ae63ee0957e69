"""What CONTRIBUTING says of adding one of each is all that it takes: done in a copy of the tree, and tried there."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import additions
from additions import PROFILE, Addition
from waiting import PATIENCE_S

ROOT = Path(__file__).parents[2]
KINDS = {
    "a check": additions.CHECK,
    "a block": additions.BLOCK,
    "a door": additions.DOOR,
    "a format": additions.FORMAT,
    "a command": additions.COMMAND,
}


def recipes() -> dict[str, list[str]]:
    """Files that CONTRIBUTING names for each thing that can be added, as patterns of paths within the package."""
    rows = re.findall(
        r"^\| (an? \w+) \| `\w+/`[^|]*\|([^|]*)\|([^|]*)\|$", (ROOT / "CONTRIBUTING.md").read_text(), re.M
    )
    return {what: [_pattern(name) for name in re.findall(r"`(.*?)`", new + old)] for what, new, old in rows}


def _pattern(name: str) -> str:
    """Pattern of ``checks/ROOM/KIND.py``: what stands in capitals is for who adds it to name."""
    return re.sub(r"\b[A-Z]+\b", r"[a-z0-9_]+", re.escape(name))


@pytest.mark.parametrize("what", KINDS)
def test_no_other_file_is_touched(what, tmp_path):
    """Adding one takes the files that CONTRIBUTING names for it, and each of them."""
    touched = additions.add(additions.copy_of(ROOT, tmp_path), KINDS[what])
    named = recipes()[what]
    assert {name for name in touched if not any(re.fullmatch(pattern, name) for pattern in named)} == set()
    assert {pattern for pattern in named if not any(re.fullmatch(pattern, name) for name in touched)} == set()


def test_each_recipe_is_tried():
    """What CONTRIBUTING says can be added is what is added here."""
    assert recipes().keys() == KINDS.keys()


class Tree:
    """A copy of the tree with something added."""

    def __init__(self, folder: Path, addition: Addition) -> None:
        self.folder = additions.copy_of(ROOT, folder / "tree")
        additions.add(self.folder, addition)

    def python(self, *arguments, status=0, **environment):
        """What Python says with these arguments, where the package is the copy."""
        path = os.pathsep.join(filter(None, [str(self.folder), os.environ.get("PYTHONPATH")]))
        done = subprocess.run(
            [sys.executable, *map(str, arguments)],
            cwd=self.folder,
            env=os.environ | {"PYTHONPATH": path, "NO_COLOR": "1", "COLUMNS": "120", **environment},
            capture_output=True,
            text=True,
            check=False,
            timeout=PATIENCE_S,
        )
        assert done.returncode == status, done.stdout + done.stderr
        return done.stdout

    def command(self, *arguments, status=0):
        """What the program says."""
        return self.python("-m", "pvlvrt_compliance.cli.main", *arguments, status=status)


@pytest.fixture(scope="module")
def tree(tmp_path_factory):
    """Give the tree with one of each, but for the block: ``tree(what)``."""
    made = {}

    def tree(what):
        if what not in made:
            made[what] = Tree(tmp_path_factory.mktemp("added"), KINDS[what])
        return made[what]

    return tree


@pytest.mark.slow
def test_a_check_is_found_and_judges(tree):
    """Its key is known to profiles, its verdict stands with all others, on either side of its limit."""
    made = tree("a check")
    for limit, status, verdict in ((0.4, 0, "pass"), (0.6, 1, "fail")):
        profile = made.folder / "mine.toml"
        profile.write_text(PROFILE.format(limit=limit))
        assert "ok" in made.command("profiles", "check", profile)
        made.command("--profile", profile, "--sag", "50%", "--output", "out", status=status)
        (test,) = json.loads((made.folder / "out" / "results.json").read_text("utf-8"))["tests"]
        (found,) = [check for check in test["checks"] if check["check"] == "lowest_voltage"]
        assert (found["status"], found["measured"]) == (verdict, pytest.approx(0.5, abs=1e-3))
        assert "V+ was 0.500 pu during the sag" in (made.folder / "out" / "report.html").read_text("utf-8")


FIRST_SAMPLES = """
import json, sys
import pvlvrt_compliance
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.simulate import simulate

scenario = Scenario(sag=Sag(depth=0.5), duration_s=0.02, before_s=0.25, after_s=0.1)
segment = simulate(scenario, parameters_from(sys.argv[1:])).segments[0]
print(json.dumps([pvlvrt_compliance.__file__, segment.dt_s, list(segment["v_dc_v"][:5])]))
"""


@pytest.mark.slow
def test_a_block_is_wired_and_runs(tree):
    """A resistor across the link discharges it from the first sample on, by v G / C, and without conductance not."""
    made = tree("a block")
    settings = ("simulation.settling_s=0.0002", "plant.dc_link_capacitance_f=0.05")
    runs = [
        json.loads(
            made.python("-c", FIRST_SAMPLES, *settings, f"plant.bleeder_conductance_s={G}", NUMBA_DISABLE_JIT="1")
        )
        for G in (0.0, 0.1)
    ]
    assert all(Path(file).is_relative_to(made.folder) for file, _, _ in runs)
    (_, dt_s, without), (_, _, bled) = runs
    t = 0.0002 + dt_s * np.arange(len(without))
    assert np.subtract(without, bled) == pytest.approx(0.1 / 0.05 * np.mean(without) * t, rel=0.02)


@pytest.mark.slow
def test_a_door_opens(tree):
    """A kind of controller that is a folder more is described, named where none is known, and runs."""
    made = tree("a door")
    said = made.command("controllers", "inspect", "follow:1")
    assert "gain 1 (follow), follow:1" in said
    assert "ready to run" in said
    assert "follow:GAIN" in made.python("-c", NOWHERE)
    made.command("--profile", "iec61400-21", "--sag", "20%", "--controller", "follow:1", "--output", "out", status=3)
    results = json.loads((made.folder / "out" / "results.json").read_text("utf-8"))
    assert results["provenance"]["controller_kind"] == "follow"


NOWHERE = """
from pvlvrt_compliance.controllers.doors import DoorError, door_to
try:
    door_to("nowhere", {})
except DoorError as error:
    print(error)
"""


def test_a_command_is_shown_and_runs(tree):
    """It stands in the help with its sentence, and does what it says."""
    made = tree("a command")
    assert "Show every kind of requirement that can be judged" in made.command("--help")
    assert "Example: pvlvrt-check kinds" in made.command("kinds", "--help")
    assert "ride_through" in made.command("kinds").split()


@pytest.mark.slow
def test_a_format_is_written_with_every_run(tree):
    """Its file stands beside the others, of the same run."""
    made = tree("a format")
    made.command("--profile", "iec61400-21", "--sag", "50%", "--output", "out")
    files = {path.name for path in (made.folder / "out").iterdir()}
    assert files == {"report.html", "junit.xml", "results.json", "waveforms", "summary.txt"}
    test, verdict, panels = (made.folder / "out" / "summary.txt").read_text("utf-8").split()
    assert (test, verdict) == ("iec61400-21.sag-50pct-abc", "pass")
    assert int(panels) >= 5
