"""The code quality report as GitLab reads it."""

import json
from pathlib import Path

import jsonschema
import pytest

from pvlvrt_compliance.report.formats import gitlab
from told import BROKEN, FAILED, IDLE, KNOWN, PASSED, UNJUDGED, WORSE, run_of

SCHEMA = json.loads((Path(__file__).parents[2] / "schemas" / "gitlab-codeclimate.json").read_text("utf-8"))
SEVERITIES = ("info", "minor", "major", "critical", "blocker")


def read(results):
    """Entries of the report, each valid: GitLab leaves out whatever comes behind one that is not."""
    entries = json.loads(gitlab.render(results))
    for entry in entries:
        jsonschema.validate(entry, SCHEMA)
        assert entry["severity"] in SEVERITIES
        assert entry["location"]["path"]
        assert entry["location"]["lines"]["begin"] == 1
        assert entry["description"]
        assert entry["check_name"]
    assert len({entry["fingerprint"] for entry in entries}) == len(entries)
    return entries


@pytest.mark.parametrize(
    ("verdict", "severity"),
    [(FAILED, "critical"), (KNOWN, "info"), (WORSE, "major"), (UNJUDGED, "major"), (BROKEN, "blocker")],
    ids=lambda value: value if isinstance(value, str) else value.status,
)
def test_severity_is_by_kind(verdict, severity):
    """What could not be run weighs most, what is known is for information."""
    (entry,) = read(run_of((PASSED, verdict)))
    assert entry["severity"] == severity
    assert entry["check_name"] == verdict.check


def test_what_passed_or_does_not_apply_is_no_entry():
    """A run with nothing to look into is an empty list, which takes away what the report of before had."""
    assert read(run_of((PASSED, IDLE))) == []


def test_a_run_in_which_nothing_was_judged_is_not_clean():
    """It has an entry that says so."""
    (entry,) = read(run_of((IDLE,)))
    assert "nothing was judged" in entry["description"]


def test_a_fingerprint_is_of_what_it_speaks_of_alone():
    """Other numbers, another message, another order of tests: the same degradation; another check: another one."""
    moved = FAILED.model_copy(update={"measured": 41.0, "margin": -9.0, "message": "otherwise", "known": True})
    first, second = (read(run_of((each, PASSED)))[0]["fingerprint"] for each in (FAILED, moved))
    assert first == second
    fingerprints = [entry["fingerprint"] for entry in read(run_of((FAILED, FAILED), (FAILED, UNJUDGED)))]
    assert first == fingerprints[0]
    assert len(set(fingerprints)) == 4


def test_its_place_is_the_file_of_the_controller_or_the_name_of_the_profile():
    """A path within the repository where that is known."""
    assert read(run_of((FAILED,), files={"controller": "src/c.py"}))[0]["location"]["path"] == "src/c.py"
    assert read(run_of((FAILED,)))[0]["location"]["path"] == "my-code"
