"""A comparison as one page that needs no network, in the style of the report of a run."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

from markupsafe import Markup

from pvlvrt_compliance.report.comparison.words import (
    MOST,
    cells_of,
    counted,
    kind_of,
    outcome,
    parts_of,
    profiles_in_words,
    value,
)
from pvlvrt_compliance.report.drawing import colours
from pvlvrt_compliance.report.drawing.in_page import Figures, figures_of, styled
from pvlvrt_compliance.report.drawing.looks import Looks
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.drawing.plotly_js import plotly_packed
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.page.environment import environment, read
from pvlvrt_compliance.resources import resource_folder
from pvlvrt_compliance.results.changes import Key
from pvlvrt_compliance.results.comparison import Changed, Comparison
from pvlvrt_compliance.results.verdict import Status

_TONES = {"none": Status.PASS, "regression": Status.FAIL, "unjudged": Status.ERROR, "nothing": Status.ERROR}

_COLUMNS = ("check", "was", "is", "margin_was", "margin_is", "share")
_DIFFERENCE_COLUMNS = ("path", "old", "new")


class _Overlay(NamedTuple):
    """A change with its figures; ``heads`` is the kind of it and of those behind it, where it is their first."""

    change: Changed
    heads: str
    figures: Figures


def render(comparison: Comparison, drawings: Mapping[Key, Drawing], left_out: Sequence[str], texts: Texts) -> str:
    """Return the comparison as one HTML document.

    Parameters
    ----------
    comparison : Comparison
    drawings : mapping
        Overlays of records by their change, as of `drawing.of_change`.
    left_out : sequence of str
        Why others are not drawn.
    texts : Texts
        The language.

    Raises
    ------
    PvlvrtError
        When the templates or plotly's JavaScript are missing from the installation.
    """
    folder = resource_folder("reports")
    looks = Looks()
    drawn = [change for change in comparison.changes if change.key in drawings]
    overlays = [
        _Overlay(change, heads, styled(figures_of(drawings[change.key], texts), looks))
        for change, heads in zip(drawn, _headings(drawn), strict=True)
    ]
    known = environment(folder, texts.language)
    return known.get_template("comparison.html.j2").render(
        **_words(comparison, texts),
        comparison=comparison,
        parts=parts_of(comparison),
        most=MOST,
        overlays=overlays,
        drawn={change.key: number for number, change in enumerate(drawn, start=1)},
        left_out=left_out,
        cells_of=partial(cells_of, texts=texts),
        value=value,
        word_of=known.globals["word"],
        plotly_packed=plotly_packed() if overlays else "",
        css=read(folder, "report.css", "figures.css") + Markup(colours.style() + looks.style()),
        figures_js=read(folder, "figures.js"),
    )


def _headings(drawn: Sequence[Changed]) -> list[str]:
    """The kind of each change that is not of the kind of the one before, else nothing."""
    kinds = list(map(kind_of, drawn))
    return [kind if kind != before else "" for before, kind in zip(["", *kinds], kinds, strict=False)]


def _words(comparison: Comparison, texts: Texts) -> dict[str, Any]:
    """What the page says of the comparison as a whole, and the headings of its tables."""
    came = outcome(comparison)
    names = {"old": comparison.old.name, "new": comparison.new.name}
    return {
        "title": texts("comparison.title", outcome=texts(f"comparison.outcome.{came}"), **names),
        "outcome": came,
        "tone": _TONES[came],
        "counted": counted(comparison, texts),
        "profiles": profiles_in_words(comparison.profiles, texts),
        "headings": [texts(f"comparison.column.{name}") for name in _COLUMNS],
        "difference_headings": [texts(f"comparison.difference_column.{name}") for name in _DIFFERENCE_COLUMNS],
    }
