"""What jobs of projects publish when a run ends early, or does not begin, where an earlier one has left its files."""

import re

import pytest

from jobs import GITHUB, GITLAB, JENKINS, Job, github_job, gitlab_job, jenkins_commands, loaded, run
from pvlvrt_compliance.controllers.projects import project_files
from pvlvrt_compliance.results.files import INTERRUPTED, JUNIT

OUTPUT = "pvlvrt-report"


def project_texts():
    """Files of a project by name, as text."""
    return {name: content.decode() for name, content in project_files("python").items()}


@pytest.fixture
def runner(tmp_path):
    """Run the job of a service with programs of no worth in a workspace that was kept: ``runner(service, gate)``.

    ``gate`` is what `pvlvrt-check` does, a shell script. Gives the service's words for what it publishes, and the files
    that are there of it.
    """

    def run_job(service, gate):
        folder, programs, files = tmp_path / "checkout", tmp_path / "bin", project_texts()
        programs.mkdir()
        for name, does in (("python", ""), ("python3", ""), ("pvlvrt-check", gate)):
            (programs / name).write_text(f"#!/bin/sh\n{does}\n")
            (programs / name).chmod(0o755)
        for name in ("junit.xml", "interrupted/junit.xml", "gl-code-quality-report.json", "report.html"):
            (folder / OUTPUT / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / OUTPUT / name).write_text("of the run before")
        if service == GITHUB:
            job, patterns = github_job(files[GITHUB], folder), [f"{OUTPUT}/**/*"]
        elif service == GITLAB:
            job = gitlab_job(files[GITLAB], folder)
            reports = loaded(files[GITLAB])["compliance"]["artifacts"]["reports"]
            patterns = [pattern for several in reports.values() for pattern in several]
        else:
            job = Job(jenkins_commands(files[JENKINS]), {}, ("sh", "-ec"), False)
            patterns = re.findall(r"junit testResults: '([^']+)'", files[JENKINS])
        *_, done = run(job, folder, programs)
        found = {file.relative_to(folder).as_posix() for pattern in patterns for file in folder.glob(pattern)}
        return done.returncode, {name for name in found if (folder / name).is_file()}

    return run_job


@pytest.mark.parametrize("service", [GITHUB, GITLAB, JENKINS])
def test_no_job_shows_what_another_has_left(runner, service):
    """After wrong usage, which writes nothing, the green results of a kept workspace are not taken for this run's."""
    assert runner(service, "exit 2") == (2, set())


@pytest.mark.parametrize("service", [GITHUB, GITLAB, JENKINS])
def test_a_run_that_is_ended_shows_what_it_has_done(runner, service):
    """What an interrupted run leaves is published where that of a whole one is."""
    made = f"{OUTPUT}/{INTERRUPTED}"
    status, shown = runner(service, f"mkdir -p {made}; cd {made}; touch {JUNIT} gl-code-quality-report.json; exit 143")
    assert status == 143
    assert f"{made}/{JUNIT}" in shown
    assert (f"{made}/gl-code-quality-report.json" in shown) == (service != JENKINS)
