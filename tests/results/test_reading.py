"""Results of earlier versions are read for ever, and those of later ones as far as they mean the same."""

import json
from pathlib import Path

import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.report.formats import junit
from pvlvrt_compliance.results import Band, Status
from pvlvrt_compliance.results.reading import read_results

FIRST = Path(__file__).parents[1] / "golden" / "results-0.1.0" / "results.json"


def test_a_result_of_the_first_version_is_read():
    """Verdicts, measurements and provenance are there; what came later is absent, not invented."""
    results = read_results(FIRST)
    assert not results.allow_unjudged
    raw = json.loads(FIRST.read_text("utf-8"))
    assert results.provenance["versions"]["pvlvrt-compliance"] == "0.1.0"
    assert [test.id for test in results.tests] == [test["id"] for test in raw["tests"]]
    for test, given in zip(results.tests, raw["tests"], strict=True):
        for verdict, written in zip(test.checks, given["checks"], strict=True):
            later = {"bound": None, "tolerance": 0.0, "uncertainty": None, "stretch": "", "marginal": False}
            later |= {"known": False, "known_reason": "", "worse": ""}
            assert verdict.model_dump(mode="json") == later | written
        assert test.expect is None
        assert json.loads(test.measurements.model_dump_json()) == given["measurements"]
        assert test.disturbance is None
        assert test.bands == ()
    assert b'name="reactive_support"' in junit.render(results)


def test_further_keys_are_left_aside(tmp_path):
    """A later version adds keys at every level; whoever reads goes by those he knows."""
    raw = json.loads(FIRST.read_text("utf-8"))
    raw["later"] = raw["tests"][0]["later"] = raw["tests"][0]["checks"][0]["later"] = {"a": 1}
    raw["tests"][0]["measurements"]["later"] = raw["tests"][0]["measurements"]["before"]["later"] = 1
    file = tmp_path / "results.json"
    file.write_text(json.dumps(raw), "utf-8")
    assert read_results(file) == read_results(FIRST)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ('{"schema_version": 99, "status": "pass"}', "schema_version 99 is of a later version"),
        ('{"status": "good"}', "status"),
        ("{", "no results of a run"),
        (None, "cannot be read"),
    ],
)
def test_what_is_no_result_is_refused_with_the_file_and_the_reason(tmp_path, content, message):
    """One line says which file and what is wrong with it."""
    file = tmp_path / "results.json"
    if content is not None:
        file.write_text(content, "utf-8")
    with pytest.raises(UsageError, match=message) as told:
        read_results(file)
    assert str(file) in str(told.value)


@pytest.mark.parametrize("edges", [{}, {"lower": (1.0,)}, {"upper": (1.0, 2.0, 3.0)}])
def test_a_band_has_an_edge_at_every_point(edges):
    """What cannot be drawn is refused where it is made."""
    with pytest.raises(ValueError, match=r"lower"):
        Band(check="mine", quantity="current_pu", name="limit", t_s=(0.0, 1.0), **edges)


def test_statuses_are_worst_first():
    """The order of definition ranks them."""
    assert [str(status) for status in Status] == ["error", "not_evaluated", "fail", "pass", "not_applicable"]
