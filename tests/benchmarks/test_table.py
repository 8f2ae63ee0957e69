"""The table of speeds: what a row says of its runs."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

_TABLE = Path(__file__).resolve().parents[2] / "benchmarks" / "table.py"


@pytest.mark.parametrize(
    ("is_at_least", "values", "said"),
    [
        (False, [1.0, 9.0, 1.3], "must <= 1.3: yes, stretch <= 1: no"),
        (False, [1.4, 1.31, 0.1], "must <= 1.3: no, stretch <= 1: no"),
        (True, [1.2, 1.3, 9.0], "must >= 1.3: yes, stretch >= 1: yes"),
        (True, [1.1, 1.29, 9.0], "must >= 1.3: no, stretch >= 1: yes"),
    ],
)
def test_goals_are_held_against_the_median(row, is_at_least, values, said):
    """A goal that is just met is reached, one that is just missed is not, from either side."""
    made = row.Row("what", values, "x", must=1.3, stretch=1.0, is_at_least=is_at_least)
    assert made.goals == said
    assert made.as_json()["reaches_must"] is said.startswith(f"must {'>=' if is_at_least else '<='} 1.3: yes")


def test_a_table_that_was_measured_is_shown_again(row, tmp_path):
    """What one run has written as JSON, another one shows and makes the page of, without measuring anything."""
    rows = [row.Row("memory", [190.0, 210.0, 195.0], "MB", must=200, reference="numba", reference_values=[165.0])]
    machine = dict.fromkeys(("date", "processor", "cores", "system", "python", "numpy", "numba", "llvmlite"), "of old")
    known, page = tmp_path / "known.json", tmp_path / "page.md"
    known.write_text(json.dumps({"machine": machine, "rows": [made.as_json() for made in rows]}), "utf-8")
    command = [sys.executable, str(_TABLE), "--from", str(known), "--page", str(page)]
    shown = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert "| memory | 195 MB | must <= 200: yes | numba: 165 s | 3 |" in shown
    assert shown.strip() in page.read_text("utf-8")
