"""How wide figures are on paper, and which of them stand beside each other."""

import math

from pvlvrt_compliance.report.drawing.model import Axis, Drawing, Line, Panel, Run
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.pdf.blocks import Beside, Picture
from pvlvrt_compliance.report.pdf.figures import pictures

TURN = [2 * math.pi * k / 60 for k in range(61)]
CIRCLE = Line("circle", (Run([math.cos(a) for a in TURN], [math.sin(a) for a in TURN]),))
ROUND = Panel("Path", Axis("α"), Axis("β"), (CIRCLE,), over="other", equal=True)
FLAT = Panel("Curve", Axis("t"), Axis("u"), (Line("u", (Run([0, 1], [0, 1]),)),))


def test_a_figure_with_equal_axes_takes_half_a_line():
    """One over time takes the whole of it; the scale of what is drawn is the same, and so are letters."""
    flat, alone = pictures(Drawing((FLAT, ROUND), (0, 1)), Texts())
    assert isinstance(flat, Picture)
    assert isinstance(alone, Picture)
    assert flat.width == 1
    assert 0.4 < alone.width < 0.5


def test_two_of_them_stand_beside_each_other():
    """In their order; a third begins a line."""
    first, second, last = pictures(Drawing((ROUND, ROUND, ROUND, FLAT), (0, 1)), Texts())
    assert isinstance(first, Beside)
    assert len(first.pictures) == 2
    assert isinstance(second, Picture)
    assert isinstance(last, Picture)
