"""What a controller says, through every door: a terminal, and every file of a run, show it and obey nothing in it."""

import json

import pytest

import worst
from pvlvrt_compliance.controllers.doors import DOORS as ALL_DOORS
from pvlvrt_compliance.report.formats import names
from sending import DOORS

QUICK = ("--set", "simulation.settling_s=0.05", "--set", "simulation.synchronising_s=0.02")
FORMATS = [word for name in names() if name != "pdf" for word in ("--format", name)]


def test_no_door_is_left_out():
    """Whoever adds a door says here how texts come through it."""
    assert {door.__module__.split(".")[-2] for door in ALL_DOORS} == set(DOORS)


@pytest.fixture(scope="module", params=sorted(DOORS))
def sends(request, tmp_path_factory):
    """A controller behind each door."""
    return DOORS[request.param](tmp_path_factory.mktemp(request.param))


def test_what_it_is(command, sends):
    """Names, units, descriptions and defaults stand in one line each, as they are written."""
    ended = command("controllers", "inspect", *sends.shown)
    assert (ended.status, ended.err) == (0, "")
    worst.of_a_terminal(ended.out)
    assert worst.MARK in ended.out
    assert "[bold]" in ended.out
    as_json = command("controllers", "inspect", *sends.shown, "--json")
    worst.data(json.loads(as_json.out))
    assert worst.MARK in json.dumps(json.loads(as_json.out), ensure_ascii=False)


def test_why_it_cannot_be_opened(command, sends):
    """An error of it is lines of text, and so is what is known of it. A library has no word of its own there."""
    if sends.refused is None:
        return
    ended = command("controllers", "inspect", *sends.refused)
    assert ended.status == 2
    worst.of_a_terminal(ended.out)
    worst.of_a_terminal(ended.err)
    assert worst.MARK in ended.err
    assert len(ended.err) < 20 * worst.LONGEST


def test_why_it_has_failed(command, sends, tmp_path):
    """The reason, and what it has printed, are in the table and in every report; nobody obeys them."""
    out = tmp_path / "out"
    run = ("--profile", "iec61400-21", "--sag", "50%", "--output", out, *QUICK, *FORMATS)
    ended = command(*run, *sends.failing, GITHUB_STEP_SUMMARY=str(tmp_path / "summary.md"))
    assert ended.status == 3
    worst.of_a_terminal(ended.out)
    worst.of_a_terminal(ended.err)
    assert worst.MARK in ended.out
    assert worst.MARK in worst.output_folder(out)
    for file in ("report.html", "junit.xml", "results.json", "report.md", "verdicts.csv", "github-summary.md"):
        assert worst.MARK in worst.text_of(out / file), file
    assert worst.MARK in worst.text_of(tmp_path / "summary.md")


@pytest.mark.slow
def test_the_sheets_of_why_it_has_failed(command, sends, tmp_path):
    """The same as PDF: read, with what no font has spelled out, and nothing that leads out of the document."""
    pytest.importorskip("typst", reason="the extra pdf is not installed")
    run = ("--profile", "iec61400-21", "--sag", "50%", "--output", tmp_path, "--waveforms", "none", *QUICK)
    ended = command(*run, *sends.failing, "--format", "pdf", "--report-field", f"client={worst.MARK} <b> #emph[x] $1$")
    assert ended.status == 3
    worst.of_a_terminal(ended.err)
    sheets = worst.text_of(tmp_path / "report.pdf")
    assert sheets.count(worst.IN_SHEETS) > 1
