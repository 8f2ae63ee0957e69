"""`report.html`: one file that needs no network."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import NamedTuple

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report import measurement_table
from pvlvrt_compliance.report.drawing import plotly_json
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.drawing.plotly_js import as_script, plotly_js
from pvlvrt_compliance.report.provenance import provenance_groups
from pvlvrt_compliance.report.verdicts import findings, is_verified, marginal, may_decide, name_of, on_the_run, verdicts
from pvlvrt_compliance.resources import resource_folder
from pvlvrt_compliance.results import Results, Status, TestResult, Verdict
from pvlvrt_compliance.results.files import REPORT

FILE = REPORT


class _SummaryTable(NamedTuple):
    """Tests of one profile, each with its number on the page."""

    profile: str
    check_names: list[str]
    tests: list[tuple[int, TestResult]]

    def count(self, status: Status) -> int:
        """How many of the tests have this verdict."""
        return sum(test.status is status for _, test in self.tests)


def render(results: Results, drawings: Mapping[str, Drawing]) -> str:
    """Return the report as one HTML document.

    Parameters
    ----------
    results : Results
    drawings : mapping
        Drawings of tests, by their key; a test without one says so.

    Raises
    ------
    PvlvrtError
        When the templates or plotly's JavaScript are missing from the installation.
    """
    folder = resource_folder("reports")
    used = {test.key: drawings[test.key] for test in results.tests if test.key in drawings}
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
            figures={name: Markup(as_script(plotly_json.render(drawing))) for name, drawing in used.items()},
            plotly_js=Markup(plotly_js()) if used else "",
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
