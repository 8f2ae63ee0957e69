import json
import math

import numpy as np
import pytest

from pvlvrt_compliance.disturbance.model import Step
from pvlvrt_compliance.report.drawing import plotly_json
from pvlvrt_compliance.report.drawing.colours import BLACK, GREY
from pvlvrt_compliance.report.drawing.instants import lines_at_steps
from pvlvrt_compliance.report.drawing.model import Area, Axis, Bars, Line, Mark, OnGrid, Panel, Run, Strip, values
from pvlvrt_compliance.report.drawing.packing import packed
from pvlvrt_compliance.report.drawing.plotly_traces import area_trace, line_trace, single
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import Band

TEXTS = Texts()


@pytest.fixture(scope="module")
def drawing(make_test, make_drawing):
    """The drawing of the common test."""
    return make_drawing(make_test())


@pytest.fixture(scope="module")
def figures(drawing):
    """Each panel of it as plotly draws it."""
    return [plotly_json.render(panel, drawing, TEXTS) for panel in drawing.panels]


def test_a_panel_is_a_figure_of_its_own(figures, drawing):
    """Every curve, limit and area of a panel is a trace, and each figure shows the same time."""
    for figure, panel in zip(figures, drawing.panels, strict=True):
        assert [t["name"] for t in figure["data"]] == [
            TEXTS.named("curve", item.name) for item in (*panel.areas, *panel.lines)
        ]
        if panel.over == "time":
            assert figure["layout"]["xaxis"]["range"] == pytest.approx(drawing.span, abs=1e-8)


def test_it_is_small_plain_json(figures):
    """27 figures fit into one report: under 60 kB each, and no number that JSON does not know."""
    assert len(packed(figures)) < 60_000


def test_shades_and_lines_go_through_every_panel(figures, drawing):
    """Everything that is marked in the drawing is a shape on the height of each panel over time."""
    for figure in (figure for figure, panel in zip(figures, drawing.panels, strict=True) if panel.over == "time"):
        shapes = figure["layout"]["shapes"]
        assert {(shape["yref"], shape["y0"], shape["y1"]) for shape in shapes} == {("paper", 0, 1)}
        lines, rects = ([s["x0"] for s in shapes if s["type"] == kind] for kind in ("line", "rect"))
        assert lines == pytest.approx([mark.at_s for mark in drawing.marks if mark.dash], abs=1e-8)
        assert rects == pytest.approx([shade.begin_s for shade in drawing.shades], abs=1e-8)


def test_a_panel_over_something_else_has_no_instants(drawing):
    """A path in a plane has neither steps nor windows; its unit is as long on both axes, and bars stand in it."""
    bars = Bars("h", (2.0, 3.0), (0.1, math.nan), colour="#0072B2")
    panel = Panel("Path", Axis("α"), Axis("β"), (), over="other", equal=True, bars=(bars,))
    figure = plotly_json.render(panel, drawing, TEXTS)
    assert (figure["layout"]["shapes"], figure["layout"]["annotations"]) == ([], [])
    assert figure["layout"]["yaxis"]["scaleanchor"] == "x"
    assert [(t["type"], t["x"], t["y"]) for t in figure["data"]] == [("bar", [2.0, 3.0], [0.1, None])]


def test_a_figure_is_told_in_the_language(drawing):
    """Names of curves, axes and instants are Spanish where that is asked for."""
    figure = plotly_json.render(drawing.panels[1], drawing, Texts("es"))
    text = json.dumps(figure, ensure_ascii=False, default=str)
    for piece in ("envolvente de hueco", "tiempo desde el inicio", "inicio 0.300 s (tensión)", "ventana «durante»"):
        assert piece in text


@pytest.mark.parametrize("count", [0, 1, 3, 6])
def test_there_is_room_for_words_and_legend(make_test, make_drawing, count):
    """However many names a legend has, they stand below the axis of the panel; words of instants stand above it."""
    names = [f"limit of the active power, number {k}" for k in range(count)]
    common = {"check": "mine", "quantity": "active_power_kw", "t_s": (0.4, 0.6), "lower": (100.0, 100.0)}
    drawing = make_drawing(make_test(bands=tuple(Band(name=name, **common) for name in names)))
    panel = next(panel for panel in drawing.panels if panel.key == "active_power")
    layout = plotly_json.render(panel, drawing, TEXTS)["layout"]
    plot_px = layout["height"] - layout["margin"]["t"] - layout["margin"]["b"]
    in_a_row = 606 // (45 + 6 * max(map(len, names), default=1))
    rows = -(-(count + 2) // in_a_row)
    below = layout["margin"]["b"] + layout["legend"]["y"] * plot_px
    assert below >= 15 * rows
    assert -layout["legend"]["y"] * plot_px >= 35  # ticks, and the name of the axis
    assert max(words["yshift"] for words in layout["annotations"]) + 15 <= layout["margin"]["t"]


def unpacked(trace):
    """Places and values of each piece of a packed trace, as `figures.js` makes them."""
    samples, begin = trace["packed"], 0
    skip, edges = samples["skip"], [samples[k] for k in ("y", "lower", "upper") if k in samples]
    for first, step, count, _ in samples["pieces"]:
        here = slice(begin, begin + count)
        yield first + step * np.cumsum(skip[here].astype(int)), [edge[here] for edge in edges]
        begin += count


@pytest.mark.parametrize("longest", [200, 60_000, 100_000])
def test_samples_are_packed_without_loss(longest):
    """Every place comes out to a nanosecond, every value as near as 32 bits hold it, however far points lie apart."""
    draw = np.random.default_rng(5)
    grids = [OnGrid(0.1 + 900 * k, 4e-5, 7 + np.cumsum(draw.integers(1, longest, 50))) for k in range(2)]
    y = draw.normal(size=(2, 50))
    made = line_trace(Line("x", tuple(Run(grid, values) for grid, values in zip(grids, y, strict=True))))
    for grid, expected, (x, (found,)) in zip(grids, y, unpacked(made), strict=True):
        np.testing.assert_allclose(x, values(grid), rtol=0, atol=1e-9)
        np.testing.assert_allclose(found, expected, rtol=1e-7)


def test_pieces_that_meet_are_joined():
    """A piece that begins with the sample that another ends with goes on from it, on its own step, too."""
    first = OnGrid(0.0, 1e-4, np.arange(11))
    second, apart = OnGrid(0.001, 4e-4, np.arange(5)), OnGrid(1.0, 4e-4, np.arange(5))
    for kind, piece in ((line_trace, lambda x: Run(x, np.ones(len(x.numbers)))), (area_trace, None)):
        made = [piece(x) if piece else Strip(x, *np.ones((2, len(x.numbers)))) for x in (first, second, apart)]
        trace = kind(Line("x", tuple(made)) if piece else Area("x", tuple(made)))
        assert [goes_on for *_, goes_on in trace["packed"]["pieces"]] == [0, 1, 0]


def test_a_limit_is_not_packed():
    """Points at places of their own stand as they are, with a gap in place of what is no number."""
    trace = line_trace(Line("x", (Run((0.0, 1.0, 1.0, 1.0), (2.0, 2.0, math.nan, -2.0)),)))
    assert (trace["x"], trace["y"]) == ([0.0, 1.0, 1.0, 1.0], [2.0, 2.0, None, -2.0])
    strip = area_trace(Area("x", (Strip((0.0, 1.0), (0.0, 0.1), (1.0, 1.1)),)))
    assert (strip["x"], strip["y"]) == ([0.0, 1.0, 1.0, 0.0], [0.0, 0.1, 1.1, 1.0])


def test_what_is_beyond_32_bits_is_a_gap():
    """A value that the browser's numbers do not hold is left out, without a warning."""
    assert np.isnan(single(np.array([1e300, np.inf, -1e39, np.nan]))).all()


@pytest.mark.parametrize(("number", "kinds"), [(50, ["line"] * 50), (51, ["path"])])
def test_very_many_lines_of_one_look_are_one_shape(drawing, number, kinds):
    """It goes through each instant, from the bottom of the panel to the top; a line of another look stays its own."""
    marks = (*(Mark(0.01 * k, GREY, "dash") for k in range(number)), Mark(0.123, BLACK, "solid"))
    panel = next(panel for panel in drawing.panels if panel.over == "time")
    shapes = plotly_json.render(panel, drawing._replace(marks=marks, shades=()), TEXTS)["layout"]["shapes"]
    assert [shape["type"] for shape in shapes] == [*kinds, "line"]
    if number > 50:
        assert (shapes[0]["xref"], shapes[0]["yref"]) == ("x", "paper")
        parts = shapes[0]["path"].removeprefix("M").split("M")
        assert [float(part.removesuffix(",0V1")) for part in parts] == pytest.approx([mark.at_s for mark in marks[:-1]])
    assert shapes[-1]["x0"] == pytest.approx(0.123)


@pytest.mark.parametrize(("number", "lines"), [(100, 100), (101, 51), (5000, 100)])
def test_of_very_many_steps_curves_are_seen_between_the_lines(make_test, number, lines):
    """Lines are a hundredth of what is shown apart then; steps that are not shown do not count."""
    span = (0.0, 10.0)
    instants_s = [*(0.05 + 10 * k / number for k in range(number)), *range(11, 300)]
    result = make_test()
    grid = result.disturbance.model_copy(update={"steps": tuple(Step(at_s=t, moved=("angle",)) for t in instants_s)})
    found = list(lines_at_steps(result.model_copy(update={"disturbance": grid}), span))
    assert lines - 2 <= len(found) <= lines  # a step may just miss the hundredth
    assert found[0].at_s == 0.05
    assert {(mark.colour, mark.dash) for mark in found} == {(GREY, "dash")}
