"""What a CI service makes of a project's files: commands of its job, and how it runs them."""

import os
import re
import subprocess
from collections.abc import Mapping
from pathlib import Path
from string import Template
from typing import Any, NamedTuple

import yaml

from waiting import PATIENCE_S

GITHUB, GITLAB, JENKINS = ".github/workflows/compliance.yml", ".gitlab-ci.yml", "Jenkinsfile"
STEP_SUMMARY = "step-summary.md"
"""File beside a checkout to which GitHub's runner lets a step append."""

# What leads back to the environment of the tests, or to a CI service that runs them.
_NOT_A_RUNNERS = ("PYTHON", "VIRTUAL_ENV", "COV_", "PVLVRT_", "GITHUB_", "GITLAB_", "CI_")


class Job(NamedTuple):
    """A job as its file has it."""

    commands: list[str]
    variables: dict[str, str]
    shell: tuple[str, ...]  # that runs a command
    is_one_script: bool  # whether all of them run in one shell


def loaded(text: str) -> Any:
    """A file as its service reads it: the key ``on`` is a word there, for YAML 1.1 it is true."""
    data = yaml.safe_load(text)
    return {"on" if key is True else key: value for key, value in data.items()}


def github_job(text: str, folder: Path) -> Job:
    """The job of a workflow in a checkout."""
    (job,) = loaded(text)["jobs"].values()
    commands = [step["run"] for step in job["steps"] if "run" in step]
    expression = r"\$\{\{ github\.workspace \}\}"
    variables = {name: re.sub(expression, str(folder), value) for name, value in job["env"].items()}
    assert not any("${{" in text for text in [*commands, *variables.values()]), "an expression that is not known here"
    variables |= {"CI": "true", "GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": str(folder.parent / STEP_SUMMARY)}
    return Job(commands, variables, ("bash", "--noprofile", "--norc", "-eo", "pipefail", "-c"), False)


def gitlab_job(text: str, folder: Path) -> Job:
    """The job of a pipeline in a checkout."""
    (job,) = loaded(text).values()
    values = {"CI": "true", "GITLAB_CI": "true", "CI_PROJECT_DIR": str(folder)}
    variables = {name: Template(value).substitute(values) for name, value in job["variables"].items()}
    return Job(job["script"], variables | values, ("bash", "-eo", "pipefail", "-c"), True)


def jenkins_commands(text: str) -> list[str]:
    """Commands of a pipeline; nothing here reads the rest of it."""
    return re.findall(r"^ +sh '([^']+)'(?: //.*)?$", text, re.MULTILINE)


def run(job: Job, folder: Path, programs: Path, **environment: str) -> list[subprocess.CompletedProcess[str]]:
    """Do what a runner does until a command fails; ``programs`` is where it finds `python`."""
    inherited = {name: value for name, value in os.environ.items() if not name.startswith(_NOT_A_RUNNERS)}
    path = os.pathsep.join([str(programs), inherited["PATH"]])
    done = []
    for command in ["\n".join(job.commands)] if job.is_one_script else job.commands:
        done.append(_shell([*job.shell, command], folder, inherited | job.variables | environment | {"PATH": path}))
        if done[-1].returncode:
            break
    return done


def _shell(command: list[str], folder: Path, variables: Mapping[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command,
        cwd=folder,
        env=variables,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
        timeout=PATIENCE_S,
    )
