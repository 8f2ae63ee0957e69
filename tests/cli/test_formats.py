"""What --format does at the command line: which files, what is printed, and for whom."""

import json
import xml.etree.ElementTree as ET

import pytest

from pvlvrt_compliance.cli import main as cli
from pvlvrt_compliance.report.formats import chosen_formats, formats, github, names
from runner import commands
from told import FAILED, KNOWN, PASSED, run_of, test_of

ON_GITHUB = {"GITHUB_ACTIONS": "true"}
ATTACK = f"50 %25\r\n::set-output name=x::y\n\t::add-mask::z\v ::error::a ##[set-env name=PATH]b {'::error::c ' * 40}"
ASKED = ("badge", "github", "gitlab", "markdown", "verdicts")


@pytest.fixture
def made(monkeypatch, command):
    """Run the main command on results that are made already: ``made(results, *arguments, **environment)``."""

    def run(results, *arguments, **environment):
        outputs = []

        def run_job(_job, **given):
            outputs.append(given["output"])
            return results

        monkeypatch.setattr("pvlvrt_compliance.cli.running.run_job", run_job)
        ended = command("--profile", "iec61400-21", "--sag", "90%", *arguments, **environment)
        return ended, outputs[0] if outputs else None

    return run


@pytest.fixture(scope="module")
def a_run(command, tmp_path_factory):
    """A failing run with all formats that need nothing, on GitHub; how it ended, its folder, and the step's summary."""
    folder = tmp_path_factory.mktemp("formats")
    summary = folder / "summary.md"
    summary.write_text("# From before\n", "utf-8")
    asked = [word for name in ASKED for word in ("--format", name)]
    ended = command(
        *("--profile", "iec61400-21", "--sag", "50%", "--output", folder / "out"),
        *("--set", "controller.reactive_plateau_pu=0", *asked),
        **ON_GITHUB,
        GITHUB_STEP_SUMMARY=str(summary),
    )
    return ended, folder / "out", summary


def test_all_files_of_a_run_count_the_same(a_run, reports):
    """A run that fails writes every file that was asked for, and all of them say what `results.json` does."""
    ended, folder, _ = a_run
    found = reports(folder)
    failed = [check["check"] for check in found.test["checks"] if check["status"] == "fail"]
    assert ended.status == 1
    assert {form.file for form in chosen_formats(ASKED)} <= found.files
    assert int(found.junit.get("failures")) == len(failed) > 0
    quality = json.loads((folder / "gl-code-quality-report.json").read_text("utf-8"))
    assert [entry["check_name"] for entry in quality] == failed
    assert f"**{len(failed)} verdict" in (folder / "report.md").read_text("utf-8")
    assert ET.parse(folder / "badge.svg").getroot().get("aria-label") == "grid code: fail 1/1"
    assert [each.name for each in commands(ended.out)] == ["error"] * (len(failed) + 1)
    assert commands(ended.err) == []


def test_a_test_takes_its_time(a_run, reports):
    """What is measured is wall time: it stands in `results.json` and as the time of the suite."""
    _, folder, _ = a_run
    found = reports(folder)
    assert 0 < found.test["wall_time_s"] < 600
    assert float(found.junit.find("testsuite").get("time")) == pytest.approx(found.test["wall_time_s"], abs=6e-4)


def test_the_summary_of_a_step_is_appended(a_run):
    """What stood there stays; what is added is the file in the folder of the run."""
    _, folder, summary = a_run
    assert summary.read_text("utf-8") == "# From before\n" + (folder / "github-summary.md").read_text("utf-8")


def test_names(made):
    """Formats that are always written may be named; of one that is unknown the message has the near miss and all."""
    results = run_of((PASSED,))
    _, plain = made(results)
    _, named = made(results, "--format", "html", "--format", "json", "--format", "junit")
    assert list(plain.formats) == list(named.formats)
    ended, _ = made(results, "--format", "gitlub")
    assert ended.status == 2
    assert "no format 'gitlub'; did you mean \"gitlab\"" in ended.err
    assert f"there are: {', '.join(names())}" in ended.err


def test_help_lists_the_folder(command):
    """Names of formats in the help are those of the folder, and what is said to be written in any case is."""
    words = " ".join(command("--help").out.replace("│", " ").split())
    listed, _, always = words.partition("A report, repeatable: ")[2].partition(". Written in any case: ")
    assert listed == ", ".join(names())
    assert always.startswith(", ".join(form.name for form in formats() if not form.asked_for))


@pytest.mark.parametrize("quiet", [(), ("--quiet",)], ids=["table", "quiet"])
def test_only_our_annotations_are_commands(made, quiet):
    """With texts of others that would command the runner, on either stream, wrapped or not: they do not."""
    bad = FAILED.model_copy(update={"check": ATTACK, "message": ATTACK, "clause": ATTACK, "stretch": ATTACK})
    known = KNOWN.model_copy(update={"known_reason": ATTACK})
    results = run_of(test_of(ATTACK, bad, known, title=ATTACK), files={"controller": ATTACK})
    results = results.model_copy(
        update={"profiles": (results.profiles[0].model_copy(update={"notes": (ATTACK,), "left_out": (ATTACK,)}),)}
    )
    ended, _ = made(results, "--format", "github", *quiet, **ON_GITHUB)
    ours = commands("\n".join(github.annotations(results)))
    assert commands(ended.out) == ours
    assert [each.name for each in ours] == ["error", "notice", "error"]
    assert commands(ended.err) == []
    lines = ended.out.splitlines()
    assert ("FAIL: 1 test" in lines[0]) is bool(quiet)


@pytest.mark.parametrize("option", ["--phases", "--set"])
def test_an_error_commands_nothing(command, option):
    """Nor does what is said of what cannot be used, whatever was asked for."""
    ended = command("--profile", "iec61400-21", "--sag", "90%", option, ATTACK, **ON_GITHUB)
    assert ended.status == 2
    assert commands(ended.err) == []
    assert ": :" in ended.err


def test_a_crash_commands_nothing(monkeypatch, capsys):
    """What an error of the program itself says is no command, either."""

    def crash(_arguments):
        raise ValueError(ATTACK)

    ended = []
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    monkeypatch.setattr(cli, "run", crash)
    monkeypatch.setattr(cli, "become_the_command", lambda: None)
    monkeypatch.setattr(cli, "leave", ended.append)
    cli.main()
    said = capsys.readouterr()
    assert ended == [3]
    assert "ValueError" in said.err
    assert commands(said.out + said.err) == []


def test_without_a_runner_nothing_is_annotated(made):
    """At somebody's desk the format is a file."""
    ended, output = made(run_of((FAILED,)), "--format", "github")
    assert commands(ended.out) == []
    assert "github-summary.md" in output.formats


def test_an_unwritable_summary_is_told(made, tmp_path):
    """The message names variable and file; status 3: something could not be written."""
    ended, _ = made(run_of((PASSED,)), "--format", "github", GITHUB_STEP_SUMMARY=str(tmp_path))
    assert ended.status == 3
    assert f"GITHUB_STEP_SUMMARY: {tmp_path} cannot be written" in ended.err
    assert "PASS: 1 test" in ended.out
