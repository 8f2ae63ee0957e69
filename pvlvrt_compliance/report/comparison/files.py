"""All files of a comparison."""

from collections.abc import Mapping, Sequence

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.report.comparison import html, junit, markdown
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.drawing.of_change import drawing
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import TestResult
from pvlvrt_compliance.results.changes import Change, Key
from pvlvrt_compliance.results.comparison import Changed, Comparison
from pvlvrt_compliance.results.files import COMPARISON, COMPARISON_PAGE, COMPARISON_TEXT, JUNIT


def render_all(
    comparison: Comparison, drawings: Mapping[Key, Drawing], left_out: Sequence[str], language: str
) -> dict[str, str | bytes]:
    """The files by their names, in the order in which they are staged; parameters as of `html.render`.

    Raises
    ------
    UsageError
        When there is no such language.
    """
    texts = Texts(language)
    return {
        COMPARISON_PAGE: html.render(comparison, drawings, left_out, texts),
        COMPARISON_TEXT: markdown.render(comparison, texts),
        JUNIT: junit.render(comparison),
        COMPARISON: comparison.model_dump_json(indent=2) + "\n",
    }


def draw(change: Changed, old: tuple[Evidence, TestResult], new: tuple[Evidence, TestResult]) -> Drawing:
    """The overlay of a change that both runs have a verdict on, by evidence and result of its test in both.

    It is drawn around the worst instant of the run that is the worse of the two.
    """
    assert change.old is not None
    assert change.new is not None
    return drawing((change.old, change.new), old, new, around="old" if change.change is Change.BETTER else "new")
