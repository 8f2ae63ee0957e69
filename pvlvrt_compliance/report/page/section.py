"""The section of a test on a page, as far as it speaks of that test alone: made where the record is."""

from typing import NamedTuple

from markupsafe import Markup

from pvlvrt_compliance.report.drawing.in_page import Figures, figures_of, styled
from pvlvrt_compliance.report.drawing.looks import Looks
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.page.environment import environment, lean
from pvlvrt_compliance.resources import resource_folder
from pvlvrt_compliance.results import TestResult, Verdict


class Section(NamedTuple):
    """What a page has of a test; where it stands there, and what leads to it, the page knows.

    Parameters
    ----------
    judged, measured : str
        What stands before and behind the figures, as markup.
    checks : tuple of Verdict, optional
        What ``judged`` speaks of: a baseline marks verdicts once all are known.
    figures : Figures, optional
    looks : tuple of str
        Those of the figures, which have them by name (`Looks`).
    """

    judged: str = ""
    measured: str = ""
    checks: tuple[Verdict, ...] | None = None
    figures: Figures | None = None
    looks: tuple[str, ...] = ()

    def without_words(self) -> "Section":
        """The figures alone."""
        return Section(figures=self.figures, looks=self.looks)


def section_of(drawing: Drawing, test: TestResult, texts: Texts) -> Section:
    """The section of a test whose record is drawn."""
    looks = Looks()
    figures = styled(figures_of(drawing, texts), looks)
    return told(Section(figures=figures, looks=looks.told), test, texts)


def told(section: Section, test: TestResult, texts: Texts) -> Section:
    """A section with the words on its test, unless it has them."""
    if section.checks == test.checks:
        return section
    judged, measured = (_rendered(name, test, texts) for name in ("judged.html.j2", "measured.html.j2"))
    return section._replace(judged=judged, measured=measured, checks=test.checks)


def _rendered(name: str, test: TestResult, texts: Texts) -> Markup:
    made = environment(resource_folder("reports"), texts.language)
    return lean(made.get_template(name).render(test=test))
