"""Figures of a report, as a reader of it sees them."""

import re
from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.report.drawing import OF_A_TEST
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.drawing.svg import figure
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.named import Named
from pvlvrt_compliance.study.session import session
from pvlvrt_compliance.study.work import Work
from validation.places import DOCS

PROFILE = "iec61400-21"

_PATH = re.compile(r'd="M(-?\d+) (-?\d+)[^"]*"')
_NEAR = 10  # units of a path: a pixel or two, by which another machine may round otherwise


class Shown(NamedTuple):
    """A figure of the run of one sag."""

    file: Path
    sag: str
    panel: str


SHOWN = (
    Shown(DOCS / "index" / "active-power.svg", "90%", "active_power"),
    Shown(DOCS / "tutorial" / "hodograph.svg", "10%", "hodograph"),
)


def pictures() -> dict[Path, str]:
    """The figures by the files that they belong in."""
    texts = Texts("en")
    return {shown.file: _picture(_drawing(shown.sag), shown.panel, texts) for shown in SHOWN}


def _drawing(sag: str) -> Drawing:
    asked = Asked(profiles=(PROFILE,), sag=sag)
    job = make_job(asked, lambda field: f"--{field}")
    (tested,) = session(Work(job=job, each=Named(OF_A_TEST, {})))
    drawing: Drawing = tested.made
    return drawing


def _picture(drawing: Drawing, key: str, texts: Texts) -> str:
    (panel,) = (panel for panel in drawing.panels if panel.key == key)
    return figure(panel, drawing, texts, "plain")


def is_shown_by(text: str, file: Path) -> bool:
    """Whether a file shows a figure: the same words and elements, and every path from nearly the same place.

    Of a path no more can be compared: on another machine one more point of it may lie on a straight line. The sentence
    in the figure has the numbers that were judged.
    """
    old = file.read_text("utf-8") if file.exists() else ""
    if _PATH.sub("d", old) != _PATH.sub("d", text):
        return False
    pairs = zip(_begins(old), _begins(text), strict=True)
    return all(abs(one - other) <= _NEAR for one, other in pairs)


def _begins(text: str) -> list[int]:
    return [int(number) for place in _PATH.findall(text) for number in place]
