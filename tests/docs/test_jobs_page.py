"""The page on parts of a run: its jobs do what it says."""

import json
import re
from pathlib import Path
from string import Template

import yaml
from typer.testing import CliRunner

from pvlvrt_compliance.cli.main import app

PAGE = (Path(__file__).parents[2] / "docs" / "jobs.md").read_text("utf-8")
GITHUB, GITLAB = (yaml.safe_load(text) for text in re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL))


def ids(words):
    """Tests that a command would run."""
    ended = CliRunner().invoke(app, [*words.removeprefix("pvlvrt-check ").split(), "--list", "--json"])
    assert ended.exit_code == 0, ended.output
    return [test["id"] for test in json.loads(ended.stdout)]


def own(lines):
    """The one command of this program among some."""
    (found,) = [line for line in lines if line.startswith("pvlvrt-check")]
    return found


def check(parts, whole):
    """The parts have every test once, and their folders are those that are merged."""
    tests = [test for part in parts for test in ids(part)]
    assert sorted(tests) == sorted(ids("pvlvrt-check --profile iec61400-21"))
    folders = [re.search(r"--output (\S+)", part)[1] for part in parts]
    assert whole == f"pvlvrt-check merge {' '.join(folders)}"


def test_github():
    """Each value of the matrix is a part."""
    job, whole = GITHUB["jobs"]["part"], GITHUB["jobs"]["whole"]
    line = own(step["run"] for step in job["steps"] if "run" in step)
    parts = [line.replace("${{ matrix.part }}", str(n)) for n in job["strategy"]["matrix"]["part"]]
    assert whole["needs"] == "part"
    check(parts, own(step["run"] for step in whole["steps"] if "run" in step))


def test_gitlab():
    """Each of the parallel jobs is a part."""
    count = GITLAB["part"]["parallel"]
    line = Template(own(GITLAB["part"]["script"]))
    parts = [line.substitute(CI_NODE_INDEX=n, CI_NODE_TOTAL=count) for n in range(1, count + 1)]
    check(parts, own(GITLAB["whole"]["script"]))


def test_nothing_is_installed_from_an_index():
    """The package is on none: each job installs its wheel, as the page says where that is from."""
    jobs = [step.get("run", "") for job in GITHUB["jobs"].values() for step in job["steps"]]
    jobs += [line for job in GITLAB.values() for line in job["script"]]
    installed = [line for line in jobs if "install" in line]
    assert installed == ["pip install wheels/*.whl"] * 4
    assert "--wheel-dir wheels" in PAGE
