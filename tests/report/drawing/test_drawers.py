"""Every drawer shows every line and area of a panel, whatever it was made from."""

import io
import json
import math
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.report import drawing
from pvlvrt_compliance.report.drawing import page, png, svg
from pvlvrt_compliance.report.drawing.drawers import drawers
from pvlvrt_compliance.report.drawing.model import (
    Area,
    Axis,
    Line,
    Panel,
    Run,
    Strip,
    broken_lines,
    outlines,
    plain,
    values,
)
from pvlvrt_compliance.report.drawing.of_profile import panels
from pvlvrt_compliance.report.drawing.spans import span_of

SVG = "{http://www.w3.org/2000/svg}"
NAN = math.nan


@pytest.fixture(params=["profile", "test"])
def some(request, make_test, make_drawing) -> list[Panel]:
    """Panels of a profile with regions, or of a test with curves, bands and limits."""
    return list(
        panels(load_profile("ieee1547-cat-ii"))
        if request.param == "profile"
        else make_drawing(make_test(), buckets=150).panels
    )


@pytest.fixture
def gappy() -> Panel:
    """A line and an area with a gap each, of every look that is not the common one."""
    line = Line("i<sub>a</sub>", (Run((0, 1, 2, 3, 4), (5, 6, NAN, 8, 9)),), dash="dot", opacity=0.5)
    silent = Line("silent", (Run((0, 4), (5, 9)),), in_legend=False)
    strip = Strip((0, 1, 2, 3, 4), (1, 1, NAN, 1, 1), (2, 2, 2, 2, 2))
    return Panel("Gaps", Axis("s"), Axis("pu"), (line, silent), (Area("a < b", (strip,), opacity=0.4, edged=False),))


def drawn_in(root):
    """Points of everything that is drawn on the panels of an SVG."""
    shapes = [*root.iter(f"{SVG}polygon"), *root.iter(f"{SVG}polyline")]
    return [[tuple(map(float, point.split(","))) for point in shape.get("points").split()] for shape in shapes]


def test_svg_has_all_of_them(some):
    """A polygon each strip, a broken line each run, a text each name in a legend, without markup."""
    root = ET.fromstring(svg.render("mine", "Mine & yours", some))
    areas = [area for panel in some for area in panel.areas]
    lines = [line for panel in some for line in panel.lines]
    strips = [points for area in areas for strip in area.strips for points in outlines(strip)]
    pieces = [points for line in lines for run in line.runs for points in broken_lines(run)]
    assert len(list(root.iter(f"{SVG}polygon"))) == len(strips) >= sum(len(area.strips) for area in areas)
    assert len(list(root.iter(f"{SVG}polyline"))) == len(pieces) >= sum(len(line.runs) for line in lines)
    texts = {text.text for text in root.iter(f"{SVG}text") if text.text}
    assert {plain(item.name) for item in (*areas, *lines) if item.in_legend} <= texts
    assert not any("<" in text for text in texts)
    assert "Mine & yours" in texts


def test_svg_draws_within_the_frames(some):
    """Every coordinate is a number, within the frame of a panel."""
    text = svg.render("mine", "Mine", some)
    assert "nan" not in text
    root = ET.fromstring(text)
    frames = [frame for frame in root.iter(f"{SVG}rect") if frame.get("fill") == "none"]
    assert len(frames) == len(some)
    tops = [float(frame.get("y")) for frame in frames]
    for points in drawn_in(root):
        x, y = np.transpose(points)
        assert svg.LEFT <= x.min() <= x.max() <= svg.WIDTH - svg.RIGHT
        assert any(top <= y.min() and y.max() <= top + svg.PANEL_HEIGHT for top in tops)


def test_svg_has_gaps_and_looks(gappy):
    """A gap parts a line and an area; strokes and how much shows through are as the panel says."""
    root = ET.fromstring(svg.render("mine", "Mine", [gappy]))
    assert [len(points) for points in drawn_in(root)] == [4, 4, 2, 2, 2]
    lines = list(root.iter(f"{SVG}polyline"))
    assert [line.get("stroke-dasharray") for line in lines] == ["3 3", "3 3", None]
    assert [line.get("stroke-opacity") for line in lines] == ["0.5", "0.5", None]
    assert {area.get("stroke") for area in root.iter(f"{SVG}polygon")} == {"none"}
    texts = {text.text for text in root.iter(f"{SVG}text")}
    assert {"ia", "a < b"} <= texts
    assert "silent" not in texts


def test_svg_leaves_out_what_is_outside(gappy):
    """Where an axis ends before what is drawn, lines and areas end at the frame, on their way as it was."""
    (low, high), top = (svg.LEFT, svg.WIDTH - svg.RIGHT), 88.0
    short = gappy._replace(x=Axis("s", (0.5, 3.5)), y=Axis("pu", (1.5, 8.5)))
    area_1, area_2, line_1, line_2, silent = drawn_in(ET.fromstring(svg.render("mine", "Mine", [short])))
    assert {x for x, _ in area_1} | {x for x, _ in area_2} == {low, 178.3, 627.7, high}
    assert line_1[0] == (low, round(top + 330 * (8.5 - 5.5) / 7, 1))
    assert line_2[-1] == (high, top)
    assert [silent[0][0], silent[-1][0]] == [low, high]
    away = drawn_in(ET.fromstring(svg.render("mine", "Mine", [gappy._replace(x=Axis("s", (10, 11)))])))
    assert away == []


def test_axes_go_as_far_as_what_is_drawn(gappy):
    """Where a panel does not say it: past gaps, a little beyond in height, from zero where it asks for it."""
    x, (low, high) = span_of(gappy)
    assert x == (0, 4)
    assert 0.5 < low < 1
    assert 9 < high < 9.6
    assert span_of(gappy._replace(y=Axis("pu", from_zero=True)))[1][0] < 0
    assert span_of(gappy._replace(y=Axis("pu", (2, 3)), x=Axis("s", scale="log"))) == ((1, 4), (2, 3))


def calls_of(made):
    """What a page hands to plotly: for each figure the list of its traces."""
    calls = re.findall(r'Plotly\.newPlot\("figure-\d+", (.*)\);', made.rpartition("<script>")[2])
    return [json.JSONDecoder().raw_decode(call)[0] for call in calls]


def places_of(item):
    """Places and values of a line or an area as plotly takes them, None between pieces and in gaps."""
    x, y = [], []
    for piece in item.runs if isinstance(item, Line) else item.strips:
        there = list(values(piece.x))
        level = list(piece.y) if isinstance(item, Line) else [*piece.lower, *reversed(list(piece.upper))]
        x += ([None] if x else []) + there + ([] if isinstance(item, Line) else there[::-1])
        y += ([None] if y else []) + level
    return x, [None if v is None or math.isnan(v) else v for v in y]


def test_a_page_has_all_of_them(some):
    """A figure each panel, with every point of its lines and areas; nothing is fetched, and nothing is told."""
    made = page.render("mine", "Mine", some)
    figures = calls_of(made)
    assert len(figures) == len(some)
    for traces, panel in zip(figures, some, strict=True):
        for trace, item in zip(traces, (*panel.areas, *panel.lines), strict=True):
            assert trace["type"] == "scatter"
            assert (trace["x"], trace["y"]) == places_of(item)
            assert trace["name"] == item.name
            assert "packed" not in trace
    assert '"showSendToCloud":false' in made
    assert "src=" not in made.replace(page.plotly_js(), "")


def test_a_page_reads_no_other_markup(gappy):
    """What is set high or low stays so; any other sign stands for itself."""
    traces = calls_of(page.render("mine", "Mine", [gappy]))[0]
    assert [trace["name"] for trace in traces] == ["a &lt; b", "i<sub>a</sub>", "silent"]


def axes_of(panel):
    """What matplotlib draws of a panel."""
    figure = pytest.importorskip("matplotlib.figure").Figure()
    axes = figure.subplots()
    png._draw(axes, panel)
    return axes


def test_png_has_all_of_them(some):
    """A patch each strip, a line each run, each name in the legend once, axes as the SVG has them."""
    for panel in some:
        axes = axes_of(panel)
        assert len(axes.lines) == sum(len(line.runs) for line in panel.lines)
        assert len(axes.patches) == sum(len(outlines(strip)) for area in panel.areas for strip in area.strips)
        expected = sorted(plain(item.name) for item in (*panel.lines, *panel.areas) if item.in_legend)
        assert sorted(text.get_text() for text in axes.get_legend().get_texts()) == expected
        assert (axes.get_xlim(), axes.get_ylim()) == span_of(panel)


def test_png_has_looks(gappy):
    """Strokes and how much shows through are as the panel says; a panel without names has no legend."""
    axes = axes_of(gappy)
    assert [line.get_linestyle() for line in axes.lines] == ["--", "-"]
    assert [line.get_alpha() for line in axes.lines] == [0.5, 1.0]
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["a < b", "ia"]
    assert axes_of(gappy._replace(lines=gappy.lines[1:], areas=())).get_legend() is None


def test_png_is_a_picture(some):
    """It has a height for each panel."""
    image = pytest.importorskip("PIL.Image")
    with image.open(io.BytesIO(png.render("mine", "Mine", some))) as picture:
        assert picture.size == (960, 456 * len(some))


def test_a_profile_without_curves_says_so(tmp_path):
    """What has nothing to draw is no empty picture."""
    text = 'schema_version = 1\nid = "mine"\ntitle = "t"\ninclude = ["iec61400-21"]\n'
    (tmp_path / "mine.toml").write_text(text, "utf-8")
    profile = load_profile(str(tmp_path / "mine.toml"))
    empty = profile.model_copy(update={"requirements": type(profile.requirements)()})
    with pytest.raises(UsageError, match="mine: the profile has no envelope, regions or curve to draw"):
        panels(empty)


def test_a_drawer_is_one_file(tmp_path, monkeypatch):
    """What has a suffix is offered, whatever its name; the others of the folder are none."""
    assert [*drawers().values()] == [(".svg", svg.render), (".png", png.render), (".html", page.render)]
    (tmp_path / "a_drawer_more.py").write_text('SUFFIX = ".txt"\ndef render(name, title, panels):\n    return title\n')
    monkeypatch.setattr(drawing, "__path__", [*drawing.__path__, str(tmp_path)])
    assert drawers()[".txt"].render("mine", "Mine", []) == "Mine"
