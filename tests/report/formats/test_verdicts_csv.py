"""The table of verdicts, read back."""

import csv
import io
import json

import pytest

from pvlvrt_compliance.report.formats import results_json, verdicts
from pvlvrt_compliance.texts import one_line
from told import FAILED, IDLE, KNOWN, PASSED, UNJUDGED, run_of, test_of


def read(results):
    """Rows by column."""
    return list(csv.DictReader(io.StringIO(verdicts.render(results), newline="")))


def test_numbers_are_those_of_the_results():
    """Each verdict is a row whose numbers are to the last digit those of `results.json`, with empty ones for none."""
    results = run_of((PASSED, FAILED, IDLE), (KNOWN, UNJUDGED))
    tests = json.loads(results_json.render(results))["tests"]
    rows = read(results)
    for row, check in zip(rows, [check for test in tests for check in test["checks"]], strict=True):
        assert row["check"] == check["check"]
        assert row["status"] == check["status"]
        for name in ("measured", "limit", "margin", "uncertainty", "at_s", "tolerance"):
            assert (float(row[name]) if row[name] else None) == check[name]
        for name in ("unit", "clause", "message", "known_reason"):
            assert row[name] == check[name]
    assert [row["gate"] for row in rows] == ["passed", "failure", "skipped", "skipped", "error"]


@pytest.mark.parametrize("text", ["=1+2", "+1", "-cmd|' /C calc'!A0", "@SUM(1)", "\t=1", 'say "a, b"\nand c'])
def test_no_text_is_a_formula(text):
    """A program for tables computes none of the texts of others, and quotes and ends of lines break no row."""
    bad = FAILED.model_copy(update={"message": text, "clause": text})
    (row,) = read(run_of(test_of("t", bad, title=text)))
    for name, kept in (("message", text), ("clause", text), ("title", one_line(text))):
        assert not row[name].lstrip().startswith(("=", "+", "-", "@"))
        assert row[name].removeprefix("'") == kept
    assert float(row["margin"]) == -10.0
