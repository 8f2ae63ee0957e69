"""`verdicts.csv`: a row a verdict with all its numbers, for whoever files, filters or counts them in a table."""

import csv
import io
import re
from collections.abc import Mapping

from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.gate import Told, told
from pvlvrt_compliance.report.verdicts import left_aside
from pvlvrt_compliance.results import Results
from pvlvrt_compliance.results.files import VERDICTS_CSV

FILE = VERDICTS_CSV
ASKED_FOR = True

_NUMBERS = ("measured", "limit", "tolerance", "margin", "uncertainty", "at_s")
_TEXTS = ("bound", "unit", "stretch", "clause", "confidence", "message", "known_reason", "worse")
COLUMNS = ("profile", "test", "check", "status", "gate", "marginal", *_NUMBERS, *_TEXTS, "title", "run_id", "selection")

_FORMULA = re.compile(r"\s*[=+\-@]")


def render(results: Results, drawings: Mapping[str, Drawing] | None = None) -> str:  # noqa: ARG001
    """Return all verdicts as CSV (RFC 4180), numbers in full, as `results.json` has them; what is none is empty."""
    file = io.StringIO()
    rows = csv.writer(file)
    rows.writerow(COLUMNS)
    aside = "; ".join(left_aside(results))  # in each row: a table is filtered, and a part must not look like the whole
    rows.writerows([*_row(each, results), _text(aside)] for each in told(results))
    return file.getvalue()


def _row(each: Told, results: Results) -> list[str]:
    verdict = each.verdict
    of_test = [each.test.profile, each.test.id, each.name]
    return [
        *map(_text, of_test),
        verdict.status.value,
        each.outcome.value,
        "yes" if verdict.is_marginal else "no",
        *("" if (value := getattr(verdict, name)) is None else repr(value) for name in _NUMBERS),
        *(_text(getattr(verdict, name) or "") for name in _TEXTS),
        _text(each.test.title),
        results.run_id,
    ]


def _text(text: str) -> str:
    """A text that a program for tables takes as one: such a program computes what begins like a formula."""
    return f"'{text}" if _FORMULA.match(text) else text
