"""The static picture of a panel shows all that the panel has, in few bytes."""

import math
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from pvlvrt_compliance.report.drawing import svg
from pvlvrt_compliance.report.drawing.canvas import UNITS_A_PX, Canvas
from pvlvrt_compliance.report.drawing.frame import LEFT_PX, RIGHT_PX, WIDTH_PX, frame_of
from pvlvrt_compliance.report.drawing.ink import Ink
from pvlvrt_compliance.report.drawing.model import Area, Axis, Bars, Drawing, Line, Panel, Run, Strip, plain
from pvlvrt_compliance.report.drawing.paths import area_ways, bars_path, line_ways
from pvlvrt_compliance.report.language import Texts

SVG = "{http://www.w3.org/2000/svg}"
TEXTS = Texts()
CANVAS = Canvas((0.0, 1.0), (0.0, 1.0), 1000.0, 400.0)


@pytest.fixture(scope="module")
def drawing(make_test, make_drawing):
    """The drawing of the common test, as a report of 500 has it."""
    return make_drawing(make_test(), buckets=300)


def points_of(path):
    """The corners of a path in units, piece by piece."""
    pieces = []
    for piece in path.split("M")[1:]:
        first, _, rest = piece.rstrip("z").partition("l")
        steps = np.array(re.findall(r"-?\d+", rest), dtype=int).reshape(-1, 2)
        begin = np.array(first.split(), dtype=int)
        pieces.append(np.vstack([begin, begin + np.cumsum(steps, axis=0)]))
    return pieces


def line(y, x=None):
    """A line over the whole width."""
    return Line("y", (Run(np.linspace(0, 1, len(y)) if x is None else x, np.asarray(y, dtype=float)),))


def line_paths(shown, canvas):
    """The paths of a line on a canvas."""
    ink = Ink()
    return line_ways(shown, canvas, ink).drawn(ink)


def area_path(shown, canvas):
    """The path around the strips of an area on a canvas."""
    ink = Ink()
    return area_ways(shown, canvas, ink, along_edges=False).drawn(ink).fill


def test_a_smooth_curve_is_where_it_should_be():
    """A bent curve of many points becomes few, none further from it than a pixel."""
    x = np.linspace(0, 1, 5000)
    y = 0.5 + 0.4 * np.tanh(20 * (x - 0.4))
    drawn = line_paths(line(y), CANVAS)
    assert drawn.fill == ""
    (points,) = points_of(drawn.stroke)
    assert len(points) < 100
    found = np.interp(1000 * x, *points.T)
    slope = np.abs(np.gradient(400 * (1 - y), 1000 * x))
    assert (np.abs(found - 400 * (1 - y)) <= UNITS_A_PX * (1 + slope)).all()


def test_a_peak_is_not_lost():
    """A single sample of a long record keeps its height."""
    y = np.full(20_000, 0.2)
    y[7777] = 0.9
    (points,) = points_of(line_paths(line(y), CANVAS).stroke)
    assert points[:, 1].min() == 40
    assert points[points[:, 1].argmin(), 0] == round(1000 * 7777 / 19_999)


def test_what_swings_too_fast_is_filled():
    """A sine of a hundred cycles in 500 px is a filled band of its height, which changes where its amplitude does."""
    x = np.linspace(0, 1, 4000)
    y = 0.5 + np.where(x < 0.5, 0.4, 0.1) * np.sin(200 * np.pi * x)
    drawn = line_paths(line(y), CANVAS._replace(instants=(500.0,)))
    outlines = points_of(drawn.fill)
    for points in outlines:
        left = points[:, 0].max() <= 500
        assert (points[:, 1].min(), points[:, 1].max()) == ((40, 360) if left else (160, 240))
    assert len(points_of(drawn.fill)) == 2
    assert sum(np.ptp(points[:, 0]) for points in outlines) > 950


def test_an_outline_follows_its_wave():
    """Where nothing was announced the outline goes down within two periods of the wave, and its edges have no ends."""
    x = np.linspace(0, 1, 4000)
    y = 0.5 + np.where(x < 0.5, 0.4, 0.1) * np.sin(200 * np.pi * x)
    drawn = line_paths(line(y), CANVAS)
    points = np.concatenate(points_of(drawn.fill))
    assert points[points[:, 0] > 500 + 20, 1].min() >= 155
    assert points[points[:, 0] < 500 - 20, 1].max() == 360
    assert len(points_of(drawn.edges)) == 2 * len(points_of(drawn.fill))
    assert "z" not in drawn.edges


@pytest.mark.parametrize("begin", [0.0050, 0.0051, 0.0061, 0.0071, 0.0146])
def test_an_outline_ends_with_its_wave(begin):
    """Wherever it begins, and even where rounding puts the edge of a last cell just beyond its end."""
    x = np.linspace(begin, begin + 0.255, 2001)
    drawn = line_paths(line(np.where(np.arange(2001) % 2, 0.1, 0.9), x=x), CANVAS)
    points = np.concatenate(points_of(drawn.fill))
    assert (points[:, 0].min(), points[:, 0].max()) == (round(1000 * x[0]), round(1000 * x[-1]))


def test_a_slow_wave_stays_a_curve():
    """Ten cycles in 500 px can be seen as such."""
    drawn = line_paths(line(0.5 + 0.4 * np.sin(20 * np.pi * np.linspace(0, 1, 4000))), CANVAS)
    assert drawn.fill == ""
    assert drawn.stroke


@pytest.mark.parametrize("at", [0.0, 0.3, 1.0])
def test_a_path_may_go_straight_up(at):
    """Of two quantities over each other one may stand still, at an edge of the panel, too."""
    y = np.linspace(0.1, 0.9, 300)
    drawn = line_paths(line(y, x=np.full(300, at)), CANVAS)
    (points,) = points_of(drawn.stroke)
    assert drawn.fill == ""
    assert set(points[:, 0]) == {1000 * at}
    assert (points[:, 1].min(), points[:, 1].max()) == (40, 360)


def test_gaps_part_lines_and_areas():
    """What is not finite is not drawn; a line beside it goes on."""
    y = [0.1, 0.2, math.nan, 0.4, 0.5]
    assert len(points_of(line_paths(line(y), CANVAS).stroke)) == 2
    strip = Strip((0.0, 0.25, 0.5, 0.75, 1.0), y, (1.0, 1.0, 1.0, 1.0, 1.0))
    assert len(points_of(area_path(Area("a", (strip,)), CANVAS))) == 2


def test_bars_stand_on_zero():
    """Each from its left to its right side, as high as it says; none where there is no number."""
    path = bars_path(Bars("h", (0.25, 0.5, 0.75), (0.5, math.nan, 1.0), width=0.1), CANVAS)
    assert path == "M200 400V200H300V400zM700 400V0H800V400z"


def test_every_name_stands_in_the_legend(drawing):
    """With words for each instant, title, numbers and names of both axes."""
    for panel in drawing.panels:
        root = ET.fromstring(svg.figure(panel, drawing, TEXTS, "plain"))
        texts = {"".join(text.itertext()).replace("\u200b", "") for text in root.iter(f"{SVG}text")}
        shown = [*panel.areas, *panel.bars, *panel.lines]
        assert {plain(TEXTS.named("curve", item.name)) for item in shown if item.in_legend} <= texts
        words = {mark.words.said(TEXTS) for mark in drawing.marks if mark.words and panel.over == "time"}
        assert {*words, *(TEXTS.named("axis", axis.label) for axis in (panel.x, panel.y))} <= texts
        assert root.findtext(f"{SVG}title") == TEXTS(f"figure.{panel.key}.title")
        assert root.findtext(f"{SVG}desc") == panel.says.said(TEXTS)


def test_marks_and_shades_are_at_their_instants(drawing):
    """A vertical line each mark, a rectangle each shade, over the whole height; those of one look in one path."""
    panel = drawing.panels[0]
    root = ET.fromstring(svg.figure(panel, drawing, TEXTS, "plain"))
    inner = root.find(f"{SVG}svg")
    height = UNITS_A_PX * (frame_of(panel, drawing, TEXTS).floor - frame_of(panel, drawing, TEXTS).top)
    paths = [path.get("d") for path in inner]
    begin, end = drawing.span

    def at(t_s):
        return f"{UNITS_A_PX * (WIDTH_PX - LEFT_PX - RIGHT_PX) * (t_s - begin) / (end - begin):.0f}"

    assert "".join(f"M{at(mark.at_s)} 0V{height}" for mark in drawing.marks if mark.dash) == paths[-1]
    shades = [f"M{at(s.begin_s)} 0H{at(s.end_s)}V{height}H{at(s.begin_s)}z" for s in drawing.shades]
    assert paths[:2] == [shades[0], "".join(shades[1:])]


def test_colours_are_variables_or_plain(drawing):
    """In a page each colour follows its theme; elsewhere none does, and the font is named."""
    page, paper = (svg.figure(drawing.panels[2], drawing, TEXTS, theme) for theme in ("page", "plain"))
    assert "var(" not in paper
    assert "font-family" in paper
    assert set(re.findall(r"#[0-9a-fA-F]{6}", page)) == set()


def test_static_pictures_of_a_test_are_small(drawing):
    """All of a test take less than 25 kB, so that 500 tests fit into one page."""
    assert sum(len(svg.figure(panel, drawing, TEXTS, "page")) for panel in drawing.panels) < 25_000


def test_a_unit_is_as_long_on_both_axes():
    """A circle is drawn as one."""
    turn = np.linspace(0, 2 * np.pi, 100)
    circle = Line("circle", (Run(np.cos(turn), np.sin(turn)),))
    panel = Panel("Path", Axis("α"), Axis("β"), (circle,), over="other", equal=True)
    root = ET.fromstring(svg.figure(panel, Drawing((panel,), (0.0, 1.0)), TEXTS, "plain"))
    (points,) = points_of(root.find(f"{SVG}svg")[-1].get("d"))
    assert np.ptp(points[:, 0]) == pytest.approx(np.ptp(points[:, 1]), abs=2)
    assert np.ptp(points[:, 1]) > 500


def test_a_record_of_one_sample_is_drawn():
    """A run that ends at once, with all its axes of no length, is a picture, too, for every drawer."""
    point = Line("y", (Run((0.0,), (0.0,)),))
    panel = Panel("One", Axis("s", (0.0, 0.0)), Axis("pu", (0.0, 0.0)), (point,))
    drawing = Drawing((panel,), (0.0, 0.0))
    root = ET.fromstring(svg.figure(panel, drawing, TEXTS, "plain"))
    assert points_of(root.find(f"{SVG}svg")[-1].get("d").replace("h0", ""))
    assert svg.render("one", "One", [panel])


@pytest.mark.parametrize("large", [1e30, 1e299, 1.7e308, math.inf])
def test_a_run_that_got_out_of_hand_is_drawn(large):
    """Whatever numbers a controller leaves, there is a picture; of what no axis can show it has a gap."""
    panel = Panel("Wild", Axis("s", (0.0, 1.0)), Axis("pu"), (line([0.0, large, -large, math.nan, 1.0, 0.5]),))
    for shown in (panel, panel._replace(y=Axis("pu", (0.0, 1.0)))):
        root = ET.fromstring(svg.figure(shown, Drawing((shown,), (0.0, 1.0)), TEXTS, "plain"))
        assert "nan" not in root.find(f"{SVG}svg")[-1].get("d")
