"""Files of the projects that `controllers new` begins: what CI services read, and where the package comes from."""

import json
import re
import shlex
import shutil
import subprocess
import tomllib
import zipfile
from importlib.metadata import version
from pathlib import Path

import jsonschema
import pytest
import yaml

from jobs import GITHUB, GITLAB, JENKINS, github_job, gitlab_job, jenkins_commands, loaded
from pvlvrt_compliance.cli.main import run
from pvlvrt_compliance.controllers.projects import KINDS, project
from pvlvrt_compliance.data.search_path import known_profiles
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.study.baseline.entries import Baseline
from pvlvrt_compliance.study.baseline.text import written

SCHEMAS = Path(__file__).parents[1] / "schemas"
EVERY = pytest.mark.parametrize("kind", KINDS)
REQUIREMENTS = "requirements.txt"
OUTPUT = "pvlvrt-report"


def texts(kind, install_from=None):
    """Files of a project by name, as text."""
    files = project(kind, install_from).files
    return {name: content.decode() for name, content in files.items() if not name.endswith(".whl")}


def requirement(kind, install_from=None):
    """The line that says where the package comes from."""
    (line,) = (x for x in texts(kind, install_from)[REQUIREMENTS].splitlines() if re.search("pvlvrt.compliance", x))
    return line


def validator(name):
    """Validator by a public schema."""
    schema = json.loads((SCHEMAS / name).read_text("utf-8"))
    return jsonschema.validators.validator_for(schema)(schema)


@pytest.mark.parametrize(
    ("name", "schema", "right", "wrong"),
    [
        (GITHUB, "github-workflow.json", "timeout-minutes: 40", "timeout: 40"),
        (GITHUB, "github-workflow.json", "[push, pull_request]", "[push, merge]"),
        (GITLAB, "gitlab-ci.json", "when: always", "when: ever"),
        (GITLAB, "gitlab-ci.json", "codequality:", "code_quality:"),
    ],
)
def test_files_keep_to_the_public_schemas(name, schema, right, wrong):
    """Workflow and pipeline of each kind are valid; with a word that the service does not have they are not."""
    check = validator(schema)
    for kind in KINDS:
        assert list(check.iter_errors(loaded(texts(kind)[name]))) == []
        assert list(check.iter_errors(loaded(texts(kind)[name].replace(right, wrong, 1)))) != []


@EVERY
def test_every_service_does_the_same(kind):
    """Each installs, builds and gates by the same commands, but for the format that it reads."""
    files, folder = texts(kind), Path("/checkout")
    jobs = [github_job(files[GITHUB], folder).commands, gitlab_job(files[GITLAB], folder).commands]
    jobs.append([command for command in jenkins_commands(files[JENKINS]) if not command.startswith("python3 -m venv")])
    same = [[re.sub(r" --format \w+$", "", command) for command in job] for job in jobs]
    assert same[0] == same[1] == same[2]
    build = [f"make {Path(json.loads(spec_line(files)))}"] if kind != "python" else []
    install, gate = "python -m pip install -r requirements.txt", "timeout -k 2m 30m pvlvrt-check --config pvlvrt.toml"
    assert same[0] == [f"rm -rf {OUTPUT}", install, *build, gate]


def spec_line(files):
    """The controller that the settings name, as JSON has it."""
    return json.dumps(tomllib.loads(files["pvlvrt.toml"])["controller"])


@EVERY
def test_jobs_have_limits_caches_and_reports(kind):
    """A job and its gate end in time, the gate first; the report is kept, red or green, and so is the compiled code."""
    files, folder = texts(kind), Path("/checkout")
    (job,) = loaded(files[GITHUB])["jobs"].values()
    *_, gate = github_job(files[GITHUB], folder).commands
    killed, ended = map(int, re.match(r"timeout -k (\d+)m (\d+)m pvlvrt-check ", gate).groups())
    limits = [job["timeout-minutes"], int(loaded(files[GITLAB])["compliance"]["timeout"].removesuffix(" minutes"))]
    limits += [int(time) for time in re.findall(r"timeout\(time: (\d+), unit: 'MINUTES'\)", files[JENKINS])]
    assert len(limits) == 3
    assert ended + killed < min(limits)
    used = {step["uses"].split("@")[0]: step for step in job["steps"] if "uses" in step}
    assert used["actions/upload-artifact"]["if"] == "always()"
    assert used["actions/upload-artifact"]["with"]["path"] == OUTPUT
    kept = str(folder / used["actions/cache/restore"]["with"]["path"])
    assert github_job(files[GITHUB], folder).variables["NUMBA_CACHE_DIR"] == kept
    assert used["actions/cache/save"]["if"].startswith("always() &&")

    (job,) = loaded(files[GITLAB]).values()
    assert job["artifacts"]["when"] == "always"
    assert job["artifacts"]["paths"] == [OUTPUT]
    kept = {str(folder / path) for path in job["cache"]["paths"]}
    variables = gitlab_job(files[GITLAB], folder).variables
    assert {variables["NUMBA_CACHE_DIR"], variables["PIP_CACHE_DIR"]} == kept
    assert job["cache"]["key"]["files"] == [REQUIREMENTS]


@EVERY
def test_jenkinsfile_is_a_pipeline(kind):
    """Its braces and quotes close, in the order of its stages; the report is kept whatever happened."""
    text = re.sub(r"//.*", "", texts(kind)[JENKINS])
    depths, depth = [], 0
    for sign in re.sub(r"'[^'\n]*'|\"[^\"\n]*\"", "", text):
        depth += {"{": 1, "}": -1}.get(sign, 0)
        depths.append(depth)
    assert min(depths) == depths[-1] == 0
    assert "'" not in re.sub(r"'[^'\n]*'|\"[^\"\n]*\"", "", text)
    stages = re.findall(r"stage\('(\w+)'\)", text)
    assert stages == [name for name in ("Install", "Build", "Compliance") if name != "Build" or kind != "python"]
    always = text[text.index("always {") :]
    assert "archiveArtifacts artifacts: 'pvlvrt-report/**'" in always


@EVERY
def test_the_hook_runs_for_what_the_controller_is_made_from(kind):
    """It looks at every source of the project, and at nothing that is built or only says something."""
    files = texts(kind)
    (repository,) = yaml.safe_load(files[".pre-commit-config.yaml"])["repos"]
    (hook,) = repository["hooks"]
    assert (repository["repo"], hook["language"], hook["pass_filenames"]) == ("local", "system", False)
    sources = {name for name in files if Path(name).suffix in {".c", ".py", ".toml"} or name == "Makefile"}
    assert {name for name in files if re.search(hook["files"], name)} == sources - {"pyproject.toml"} | {
        "pvlvrt-baseline.txt"
    }
    assert hook["entry"] == ("make gate" if "Makefile" in files else quick_gate(files))


def quick_gate(files):
    """The command that a project runs before a commit; it stands in one of its files, which the README names."""
    found = {name: re.search(r"pvlvrt-check .*\.cache/gate$", text, re.MULTILINE) for name, text in files.items()}
    ((place, command),) = ((name, hit[0]) for name, hit in found.items() if hit and name != "README.md")
    assert f"The first stands in `{place}`" in files["README.md"]
    return command


@EVERY
def test_the_hook_goes_with_every_profile(kind, capsys):
    """What is run before a commit can be run whichever profile the settings are changed to."""
    program, *arguments = shlex.split(quick_gate(texts(kind)))
    assert program == "pvlvrt-check"
    for profile in known_profiles():
        assert (run([*arguments, "--profile", profile, "--list"]), profile) == (0, profile)
        said = capsys.readouterr()
        assert (said.out.splitlines()[-1], said.err) == (f"1 test of {profile}", "")


@EVERY
def test_what_is_made_is_not_committed(kind, tmp_path):
    """Reports, caches and what is built are ignored, and neither the wheel nor a file of the project is."""
    files = project(kind).files
    for name, content in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(content)
    subprocess.run(["git", "init", "-q"], cwd=tmp_path, check=True)
    built = Path(json.loads(spec_line(texts(kind)))).name if kind != "python" else "__pycache__/x.pyc"
    made = {
        f"{OUTPUT}/report.html",
        "pvlvrt-comparison/new/results.json",
        ".cache/kernels/x",
        ".venv/bin/python",
        built,
    }
    asked = [*files, "wheels/a-1-py3-none-any.whl", *made]
    ignored = subprocess.run(
        ["git", "check-ignore", "--no-index", *asked], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert set(ignored.stdout.splitlines()) == made


@EVERY
def test_the_baseline_begins_empty(kind):
    """It is the file that `baseline update` writes when nothing is known."""
    assert texts(kind)["pvlvrt-baseline.txt"] == written(Baseline({}))


@EVERY
def test_without_a_source_no_index_is_named(kind):
    """As long as nobody says that an index has the package, a project installs a wheel of its own, and says which."""
    begun, wheel = project(kind), f"wheels/pvlvrt_compliance-{version('pvlvrt-compliance')}-py3-none-any.whl"
    extras = "[fmi]" if kind == "fmu" else ""
    assert requirement(kind) == f"./{wheel}{extras}"
    assert begun.missing == wheel
    assert wheel not in begun.files
    assert f"`{wheel}`, which is not there yet" in texts(kind)["README.md"]
    assert not [name for name, text in texts(kind).items() if re.search(r"install [^\n]*pvlvrt-compliance", text)]


@pytest.mark.parametrize(
    ("spec", "line"),
    [
        ("pvlvrt-compliance", "pvlvrt-compliance[fmi]"),
        ("pvlvrt-compliance==0.2.0", "pvlvrt-compliance[fmi]==0.2.0"),
        ("PVLVRT_compliance[pdf]>=0.2,<1", "pvlvrt-compliance[fmi,pdf]>=0.2,<1"),
        ("git+https://host.example/a/b@v0.2.0", "pvlvrt-compliance[fmi] @ git+https://host.example/a/b@v0.2.0"),
        ("git+ssh://git@host.example/a/b.git@v1", "pvlvrt-compliance[fmi] @ git+ssh://git@host.example/a/b.git@v1"),
        ("https://host.example/x.whl", "pvlvrt-compliance[fmi] @ https://host.example/x.whl"),
        (
            "git+https://ci:${TOKEN}@host.example/a@1",
            "pvlvrt-compliance[fmi] @ git+https://ci:${TOKEN}@host.example/a@1",
        ),
    ],
)
def test_source_is_what_the_user_says(spec, line):
    """An index, an address or a repository stands in one place, with what this kind needs besides."""
    assert requirement("fmu", spec) == line
    assert project("fmu", spec).missing == ""
    without = {name: text for name, text in texts("fmu").items() if name not in {REQUIREMENTS, "README.md"}}
    assert {name: text for name, text in texts("fmu", spec).items() if name in without} == without


@pytest.mark.parametrize(
    ("spec", "says"),
    [
        ("", "is empty"),
        ("pvlvrt-compliance==1 # x", "is empty, or has a blank"),
        ("pvlvrt-compliance==1\n--index-url=x", "is empty, or has a blank"),
        ("pvlvrt-complaince==1", 'did you mean "pvlvrt-compliance"?'),
        ("numpy==1", "allowed are pvlvrt-compliance==VERSION, a wheel"),
        ("pvlvrt-compliance==", "allowed are pvlvrt-compliance==VERSION, a wheel"),
        ("file:///home/me/x.whl", "is on this machine only"),
        ("http://host.example/x.whl", "addresses begin with https://, git+https://, git+ssh://"),
        ("git+https://host.example", "names no host, or nothing on it"),
        ("https://[x/y", "is no address"),
        ("git@host.example:a/b.git", 'did you mean "git+ssh://git@host.example/a/b.git"?'),
        (".", "build a wheel of it and name that (python -m pip wheel --no-deps --wheel-dir dist .)"),
        ("numpy-1-py3-none-any.whl", "is no wheel of this package"),
        ("nowhere/pvlvrt_compliance-1-py3-none-any.whl", "cannot be read (No such file or directory)"),
    ],
)
def test_source_that_a_runner_cannot_use_is_refused(spec, says):
    """What is no source, or one of this machine only, is told with what is allowed."""
    with pytest.raises(UsageError, match=re.escape(says)):
        project("c", spec)


def test_a_password_is_not_written_down():
    """An address with a secret in it is refused, and not repeated."""
    with pytest.raises(UsageError, match=r"has a password.*\$\{NAME\}") as error:
        project("c", "git+https://me:hunter2@host.example/a/b@v1")
    assert "hunter2" not in str(error.value)


def test_a_wheel_is_copied_into_the_project(tmp_path):
    """Under its own name, byte for byte; one that is damaged, or of something else, is not."""
    folder = tmp_path / "a folder"
    folder.mkdir()
    wheel = folder / "pvlvrt_compliance-9.1-py3-none-any.whl"
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr("pvlvrt_compliance/__init__.py", "")
    begun = project("c", str(wheel))
    assert begun.files[f"wheels/{wheel.name}"] == wheel.read_bytes()
    assert (begun.missing, requirement("c", str(wheel))) == ("", f"./wheels/{wheel.name}")
    (folder / "other").write_bytes(wheel.read_bytes()[:40])
    shutil.copy(folder / "other", wheel)
    with pytest.raises(UsageError, match="is no wheel of this package, or a damaged one"):
        project("c", str(wheel))
