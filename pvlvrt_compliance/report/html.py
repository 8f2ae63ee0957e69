"""`report.html`: one file that needs no network."""

import json
from collections.abc import Mapping
from functools import cache, partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from pvlvrt_compliance.errors import PvlvrtError
from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report import measurement_table
from pvlvrt_compliance.report.provenance import provenance_groups
from pvlvrt_compliance.report.verdicts import findings, is_verified, marginal, may_decide, name_of, on_the_run, verdicts
from pvlvrt_compliance.resources import resource_folder
from pvlvrt_compliance.results import Results, Status, TestResult, Verdict


class _SummaryTable(NamedTuple):
    """Tests of one profile, each with its number on the page."""

    profile: str
    check_names: list[str]
    tests: list[tuple[int, TestResult]]

    def count(self, status: Status) -> int:
        """How many of the tests have this verdict."""
        return sum(test.status is status for _, test in self.tests)


def render(results: Results, figures: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the report as one HTML document.

    Parameters
    ----------
    results : Results
    figures : mapping
        Figures as `figure.test_figure` returns them, by the key of their test; a test without one says so.

    Raises
    ------
    PvlvrtError
        When the templates or plotly's JavaScript are missing from the installation.
    """
    folder = resource_folder("reports")
    used = {test.key: figures[test.key] for test in results.tests if test.key in figures}
    return (
        _environment(folder)
        .get_template("report.html.j2")
        .render(
            results=results,
            name=partial(name_of, results=results),
            counts=results.counts(),
            marginal=marginal(results),
            may_decide=may_decide(results),
            on_the_run=on_the_run(results),
            findings=findings(results),
            tables=_summary_tables(results),
            statuses=list(Status),
            marks=_marks(results),
            provenance=provenance_groups(results.provenance),
            figures={name: _json(figure) for name, figure in used.items()},
            plotly_js=Markup(_plotly_js()) if used else "",
            css=Markup((folder / "report.css").read_text(encoding="utf-8")),
            js=Markup((folder / "report.js").read_text(encoding="utf-8")),
        )
    )


def _environment(folder: Path) -> Environment:
    environment = Environment(
        loader=FileSystemLoader(folder),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.globals.update(
        verdicts=verdicts,
        check_of=_check_of,
        row=spell.row,
        limit_in_words=spell.limit_in_words,
        marginal_in_words=spell.marginal_in_words,
        stretch_unless_told=spell.stretch_unless_told,
        number=spell.number,
        label=spell.label,
        word=lambda status: spell.STATUS_WORD[Status(status)],
        symbol=lambda status: spell.STATUS_SYMBOL[Status(status)],
        is_verified=is_verified,
        window_headings=measurement_table.window_headings,
        measured_rows=measurement_table.measured_rows,
        belief_rows=measurement_table.belief_rows,
    )
    return environment


def _summary_tables(results: Results) -> list[_SummaryTable]:
    """Tests by profile, in order, with the names of the checks that occur among them."""
    profiles = list(dict.fromkeys(test.profile for test in results.tests))
    numbered = list(enumerate(results.tests, start=1))
    return [_summary_table(name, [(n, test) for n, test in numbered if test.profile == name]) for name in profiles]


def _summary_table(profile: str, tests: list[tuple[int, TestResult]]) -> _SummaryTable:
    names = dict.fromkeys(check.check for _, test in tests for check in verdicts(test))
    return _SummaryTable(profile, list(names), tests)


def _check_of(test: TestResult, name: str) -> list[Verdict]:
    return [check for check in verdicts(test) if check.check == name]


def _marks(results: Results) -> list[tuple[str, str]]:
    """Marks that occur beside the verdicts, with their meaning, in the order of the legend."""
    used = {check.confidence for test in results.tests for check in test.checks}
    used |= {test.confidence for test in results.tests}
    return [(mark, meaning) for mark, meaning in spell.CONFIDENCE_MEANING.items() if mark in used]


def _json(figure: Mapping[str, Any]) -> Markup:
    # A script element ends at "</script" wherever it stands; without "<" there is nothing to end it.
    text = json.dumps(figure, separators=(",", ":"), allow_nan=False)
    return Markup(text.replace("<", "\\u003c"))


@cache
def _plotly_js() -> str:
    """Plotly's JavaScript, read from the installed package without importing it (0.3 s)."""
    spec = find_spec("plotly")
    for place in (spec.submodule_search_locations or []) if spec else []:
        file = Path(place) / "package_data" / "plotly.min.js"
        if file.is_file():
            return file.read_text(encoding="utf-8").replace("</script", "<\\/script")
    raise PvlvrtError("plotly's JavaScript is missing from the installation; install plotly again")
