import base64
import itertools
import json
import math

import numpy as np
import pytest

from pvlvrt_compliance.report.drawing import plotly_json
from pvlvrt_compliance.report.drawing.model import Area, Line, OnGrid, Run, Strip, values
from pvlvrt_compliance.report.drawing.plotly_traces import area_trace, line_trace, typed_array
from pvlvrt_compliance.results import Band


@pytest.fixture(scope="module")
def drawn(make_test, make_drawing):
    """The figure of the common test."""
    return plotly_json.render(make_drawing(make_test()))


def test_all_panels_share_one_time_axis(drawn):
    """Zoom in one panel is zoom in all; every panel has its own values and legend, and none overlaps another."""
    assert {trace.get("xaxis", "x") for trace in drawn["data"]} == {"x"}
    axes = sorted({trace["yaxis"] for trace in drawn["data"]})
    assert axes == ["y", "y2", "y3", "y4", "y5"]
    domains = sorted(drawn["layout"][name.replace("y", "yaxis")]["domain"] for name in axes)
    assert all(below[1] < above[0] for below, above in itertools.pairwise(domains))
    assert domains[0][0] == 0
    assert domains[-1][1] == 1


def test_it_is_small_plain_json(drawn):
    """27 figures fit into one report: under 150 kB each, and no number that JSON does not know."""
    assert len(json.dumps(drawn, allow_nan=False)) < 150_000


def test_shades_and_lines_go_through_all_panels(drawn, make_test, make_drawing):
    """Everything that is marked in the drawing is a shape on the paper's height."""
    drawing = make_drawing(make_test())
    shapes = drawn["layout"]["shapes"]
    assert {(shape["yref"], shape["y0"], shape["y1"]) for shape in shapes} == {("paper", 0, 1)}
    lines, rects = ([s["x0"] for s in shapes if s["type"] == kind] for kind in ("line", "rect"))
    assert lines == [mark.at_s for mark in drawing.marks if mark.dash]
    assert rects == [shade.begin_s for shade in drawing.shades]


@pytest.mark.parametrize("count", [0, 1, 3, 6])
def test_a_legend_does_not_cover_a_title_or_a_panel(make_test, make_drawing, count):
    """However many names it has, it stands above the title of its panel, and under the panel above it."""
    names = [f"limit of the active power, number {k}" for k in range(count)]
    common = {"check": "mine", "quantity": "active_power_kw", "t_s": (0.4, 0.6), "lower": (100.0, 100.0)}
    bands = tuple(Band(name=name, **common) for name in names)
    layout = plotly_json.render(make_drawing(make_test(bands=bands)))["layout"]
    margins = layout["margin"]
    plot_px = layout["height"] - margins["t"] - margins["b"]
    above, panel = layout["yaxis3"]["domain"][0] * plot_px, layout["yaxis4"]["domain"][1] * plot_px
    room, under = above - layout["legend4"]["y"] * plot_px, layout["legend4"]["y"] * plot_px - panel
    assert under >= (15 if count > 1 else -0.01)  # a title is 15 px high
    in_a_row = 606 // (45 + 6 * max(map(len, names), default=1))
    rows = -(-(count + 4) // in_a_row) if count > 1 else 1
    assert room >= 15 * rows - 4
    assert layout["yaxis5"]["domain"][0] == 0
    assert layout["yaxis"]["domain"][1] == 1


def numbers(packed):
    """A packed array as numbers."""
    return np.frombuffer(base64.b64decode(packed["bdata"]), f"<{packed['dtype']}")


def unpacked(trace):
    """Places and values of each piece of a packed trace, as `report.js` makes them."""
    packed, begin = trace["packed"], 0
    skip, edges = numbers(packed["skip"]), [numbers(packed[k]) for k in ("y", "lower", "upper") if k in packed]
    for first, step, count, _ in packed["pieces"]:
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
    assert np.isnan(numbers(typed_array(np.array([1e300, np.inf, -1e39, np.nan])))).all()
