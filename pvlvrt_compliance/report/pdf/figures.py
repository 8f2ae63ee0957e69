"""The figures of a test as vectors, each with the sentence that says what is to be seen in it."""

import re
from collections.abc import Iterator

from pvlvrt_compliance.report.drawing import svg
from pvlvrt_compliance.report.drawing.frame import WIDTH_PX
from pvlvrt_compliance.report.drawing.model import Drawing, Panel, plain
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.pdf.blocks import Beside, Block, Paragraph, Picture

_WIDTH = re.compile(r'viewBox="0 0 ([\d.]+) ')


def pictures(drawing: Drawing | None, texts: Texts) -> Iterator[Block]:
    """A picture for each panel of a test, all on one scale; a sentence where it left no record to draw.

    Pictures that follow each other stand beside each other where a line has room for them.
    """
    if drawing is None:
        yield Paragraph(texts("section.no_figure"), small=True)
        return
    line: list[Picture] = []
    drawn = svg.figures(drawing.panels, drawing, texts, theme="plain")
    for panel, picture_of in zip(drawing.panels, drawn, strict=True):
        picture = _picture(panel, picture_of, texts)
        if line and sum(other.width for other in line) + picture.width > 1:
            yield _on_a_line(line)
            line = []
        line.append(picture)
    if line:
        yield _on_a_line(line)


def _picture(panel: Panel, drawn: str, texts: Texts) -> Picture:
    title = texts(f"figure.{panel.key}.title") if panel.key else plain(panel.title)
    says = panel.says.said(texts) if panel.says else ""
    words = texts("pdf.figure", title=title, says=says) if says else title
    return Picture(drawn, words, words, width=_share(drawn))


def _share(picture: str) -> float:
    """How much of a line a picture takes, by the width that it was drawn for."""
    found = _WIDTH.search(picture)
    return min(1.0, float(found[1]) / WIDTH_PX) if found else 1.0


def _on_a_line(line: list[Picture]) -> Block:
    return line[0] if len(line) == 1 else Beside(tuple(line))
