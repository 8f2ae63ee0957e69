"""What a run says behind its verdicts: what is not verified, and which files it has written."""

import re
from pathlib import Path

import pytest

from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
from pvlvrt_compliance.cli.showing import show
from pvlvrt_compliance.data.marks import VERIFIED
from pvlvrt_compliance.profile.loading import load_profile
from pvlvrt_compliance.results.reading import read_results

FILE = Path(__file__).parents[1] / "golden" / "results-0.1.0" / "results.json"


@pytest.fixture(scope="module")
def results():
    """Results of a run without a controller of one's own, one of its profiles with all that is not verified."""
    profile = load_profile("iec61400-21", INSTALLED_KINDS)
    notes = profile.unverified()
    one = read_results(FILE)
    return one.model_copy(update={"profiles": (one.profiles[0].model_copy(update={"notes": notes}),)})


@pytest.fixture
def said(capsys, results):
    """Lines that begin so: ``said(beginning, results=results, **options)``."""

    def said(beginning, results=results, formats=(), **options):
        show(results, Path("out"), formats, **({"quiet": False, "own_controller": False} | options))
        return [line for line in capsys.readouterr().out.splitlines() if line.startswith(beginning)]

    return said


def test_what_is_not_verified_is_said_once_and_short(said, results):
    """One line that fits a terminal, whose counts make up all that there is, each mark for itself."""
    (line,) = said("Not verified")
    assert len(line) <= 80
    counts = {mark: int(count) for count, mark in re.findall(r"(\d+) ([a-z-]+)", line)}
    notes = results.profiles[0].notes
    assert sum(counts.values()) == len(notes)
    assert counts == {mark: sum(f": {mark} (" in note for note in notes) for mark in counts}
    assert not VERIFIED & set(counts)


def test_verbose_names_each_with_its_source(said, results):
    """All of it, what the project has chosen too, a line each."""
    assert said("Not verified", verbose=True) == [f"Not verified: {note}" for note in results.profiles[0].notes]


def test_several_profiles_are_one_line(said, results):
    """They are counted together; in full each line says of which profile it is."""
    (profile,) = results.profiles
    both = results.model_copy(update={"profiles": (profile, profile.model_copy(update={"id": "other"}))})
    once, twice = (re.findall(r"\d+", said("Not verified", of)[0]) for of in (results, both))
    assert [2 * int(count) for count in once] == [int(count) for count in twice]
    lines = said("Not verified", both, verbose=True)
    assert sum(line.startswith("Not verified in other: ") for line in lines) == len(profile.notes)


def test_nothing_is_said_where_all_is_verified(said, results):
    """A profile without doubts has no such line, in full or not."""
    sure = results.model_copy(update={"profiles": (results.profiles[0].model_copy(update={"notes": ()}),)})
    assert said("Not verified", sure) == said("Not verified", sure, verbose=True) == []


@pytest.mark.parametrize(("formats", "files"), [((), ""), (("html", "junit"), ""), (("pdf",), ", out/report.pdf")])
def test_every_report_that_was_asked_for_is_named(said, formats, files):
    """Behind the page stand the files that are only written when they are asked for."""
    assert said("Report: ", formats=formats) == [f"Report: out/report.html{files}"]


@pytest.mark.parametrize("name", ["COLUMNS", "LINES"])
@pytest.mark.parametrize("size", ["9" * 5000, "\u00b2", "0", "-80", "wide", ""])
def test_a_size_that_is_none_is_as_no_size(command, name, size):
    """Whatever the environment says of a terminal, a table is printed as it is without."""
    assert command("profiles", "list", **{name: size}) == command("profiles", "list")


def test_a_width_of_the_help_that_is_none(program):
    """The help is drawn as wide as without."""
    ended = program("profiles", "--help", TERMINAL_WIDTH="wide")
    assert (ended.status, ended.err) == (0, "")
    assert ended == program("profiles", "--help")
