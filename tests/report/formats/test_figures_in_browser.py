"""Figures in a real browser: static pictures first, drawn over when seen, zoomed together, in colours of the page."""

import itertools
from functools import partial

import numpy as np
import pytest

from pvlvrt_compliance.report.drawing.colours import BLACK, ON_DARK, PAPER, PHASES
from pvlvrt_compliance.report.drawing.model import outline, values
from pvlvrt_compliance.report.formats import html
from waiting import PATIENCE_S, wait_until

pytestmark = pytest.mark.browser

NAMES = ("VD3-full-1", "VD3-full-2", "VD3-full-3")
PANELS, OVER_TIME = 7, 6  # the hodograph has no time
BACKGROUND = "one => getComputedStyle(one).backgroundColor"


@pytest.fixture(scope="module")
def file(make_test, make_results, make_drawing, tmp_path_factory):
    """A report of three tests."""
    tests = [make_test(name) for name in NAMES]
    drawing = make_drawing(tests[0], buckets=150)
    path = tmp_path_factory.mktemp("page") / "report.html"
    path.write_text(html.render(make_results(*tests), {test.key: drawing for test in tests}), encoding="utf-8")
    return path


def opened(browser, file, **options):
    """The page in a context of its own; what it asks for and what it complains of are its lists."""
    page = browser.new_context(viewport={"width": 1280, "height": 900}, **options).new_page()
    page.set_default_timeout(1000 * PATIENCE_S)
    page.asked, page.complaints = [], []
    page.on("request", lambda request: page.asked.append(request.url))
    page.on("console", lambda message: page.complaints.append(message.text))
    page.on("pageerror", lambda error: page.complaints.append(str(error)))
    page.goto(file.as_uri())
    return page


@pytest.fixture(scope="module")
def page(browser, file):
    """The page with all figures of the first test drawn, one after the other, after the first has been zoomed."""
    page = opened(browser, file)
    plot = page.locator(".plot").first
    plot.scroll_into_view_if_needed()
    plot.locator(".live .xtick").first.wait_for(state="attached")
    page.locator(".zooms button").nth(2).click()
    drawn(page)
    yield page
    page.context.close()


def drawn(page, test=0):
    """The figures of a test, all of them drawn."""
    box = page.locator(".figures").nth(test)
    for number in range(PANELS):
        plot = box.locator(".plot").nth(number)
        plot.scroll_into_view_if_needed()
        plot.locator(".live .xaxislayer-above .xtick").first.wait_for(state="attached")
    return box


def ranges(box):
    """What part of the time each figure over time shows."""
    return box.locator("[data-over=time] .live").evaluate_all(
        "all => all.map(plot => plot.layout.xaxis.range.map(Number))"
    )


def test_figures_are_drawn_when_seen_and_nothing_is_fetched(page, file):
    """What is far below is not even a picture yet; the page neither asks nor complains, and offers to tell nobody."""
    assert page.locator(".figures").nth(2).locator(".live").count() == 0
    assert page.locator(".figures").nth(2).locator(".plot svg").count() == 0
    assert {url for url in page.asked if not url.startswith("blob:")} == {file.as_uri()}
    assert page.complaints == []
    titles = page.locator(".modebar-btn").evaluate_all("all => all.map(one => one.dataset.title)")
    assert any("Download" in title for title in titles)
    assert not any("Share" in title or "Cloud" in title for title in titles)


def test_without_javascript_every_figure_is_seen(browser, file):
    """Static pictures stand in the page, with all curves, and no button that does nothing."""
    page = opened(browser, file, java_script_enabled=False)
    pictures = page.locator(".plot > noscript > svg")
    assert pictures.count() == PANELS * len(NAMES)
    assert all(pictures.nth(k).is_visible() for k in range(pictures.count()))
    assert page.locator(".zooms button").first.is_hidden()
    page.context.close()


def test_what_is_printed_are_the_static_pictures(page):
    """Drawn or not, on paper each figure is its static picture, in the colours of a light ground."""
    page.evaluate("document.documentElement.dataset.theme = 'dark'")
    page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    page.emulate_media(media="print")
    pictures = page.locator(".plot > .still > svg")
    assert pictures.count() == PANELS * len(NAMES)
    assert all(pictures.nth(k).is_visible() for k in range(pictures.count()))
    assert page.locator(".live").first.is_hidden()
    assert page.locator(".zooms").first.is_hidden()
    colour = pictures.first.evaluate("picture => getComputedStyle(picture).fill")
    assert colour == rgb(BLACK)
    page.emulate_media(media="screen")
    page.evaluate("delete document.documentElement.dataset.theme")


def test_figures_of_a_test_zoom_together(page):
    """A button shows one part of the time in all of its figures, so does dragging in one; other tests stay."""
    box = page.locator(".figures").first
    button = box.locator(".zooms button").nth(2)
    begin, end = (float(button.get_attribute(name)) for name in ("data-begin", "data-end"))
    assert ranges(box) == [[begin, end]] * OVER_TIME  # those drawn later, too
    whole = box.locator(".zooms button").first
    whole.focus()
    page.keyboard.press("Enter")
    begin, end = (float(whole.get_attribute(name)) for name in ("data-begin", "data-end"))
    assert ranges(box) == [[begin, end]] * OVER_TIME
    area = box.locator(".live .nsewdrag").first.bounding_box()
    page.mouse.move(area["x"] + area["width"] / 4, area["y"] + 20)
    page.mouse.down()
    page.mouse.move(area["x"] + area["width"] / 2, area["y"] + 22, steps=4)
    page.mouse.up()
    wait_until(lambda: ranges(box)[-1] != [begin, end], "the last figure follows the first")
    spans = np.array(ranges(box))
    assert spans == pytest.approx(np.tile(begin + np.array([0.25, 0.5]) * (end - begin), (OVER_TIME, 1)), abs=1e-2)
    assert page.locator(".figures").nth(2).locator(".live").count() == 0


def rgb(colour):
    """A colour as the browser tells it."""
    return f"rgb({', '.join(str(int(colour[k : k + 2], 16)) for k in (1, 3, 5))})"


def _is_on(box, ground):
    """Whether the last figure has a ground of a colour."""
    return box.locator(".live").last.locator(".main-svg").first.evaluate(BACKGROUND) == ground


def test_colours_follow_the_theme(page):
    """Curves, ground and words of figures and of static pictures are those of the theme, and go back again."""
    box = page.locator(".figures").first
    page.add_style_tag(content=":root[data-theme=dark] { color-scheme: dark } :root { color-scheme: light }")
    for theme, seen in (("dark", ON_DARK), ("light", {colour: colour for colour in ON_DARK})):
        page.evaluate(
            f"document.documentElement.dataset.theme = '{theme}'; document.dispatchEvent(new Event('themechange'))"
        )
        wait_until(partial(_is_on, box, rgb(seen[PAPER])), f"figures are {theme}")
        strokes = box.locator("[data-key=voltages] .live .js-line").evaluate_all(
            "all => all.map(one => getComputedStyle(one).stroke)"
        )
        assert {rgb(seen[colour]) for colour in PHASES.values()} <= set(strokes)
        picture = page.locator(".plot > .still > svg").first
        assert picture.evaluate("one => getComputedStyle(one).fill") == rgb(seen[BLACK])


def test_packed_samples_come_out_as_they_went_in(page, make_test, make_drawing):
    """What the page makes of a curve in pieces, and of a band, is what the drawing has, to a 65,534th of its range."""
    given = "plot => plot.data.map(({name, x, y}) => ({name, x: Array.from(x), y: Array.from(y)}))"
    seen = page.locator("[data-key=currents] .live").first.evaluate(given)
    panel = next(panel for panel in make_drawing(make_test(), buckets=150).panels if panel.key == "currents")
    (line,) = (line for line in panel.lines if line.name == "i<sub>a</sub>")
    (area,) = (area for area in panel.areas if area.name == "i<sub>a</sub>")
    band, curve, in_legend = (trace for trace in seen if trace["name"] == "i<sub>a</sub>")
    assert in_legend["y"] == [None]
    expected = [place for run in line.runs for place in (*values(run.x), None)][:-1]
    assert [None if y is None else x for x, y in zip(curve["x"], curve["y"], strict=True)] == [
        place if place is None else pytest.approx(place, abs=1e-9) for place in expected
    ]
    flat = np.array([*itertools.chain.from_iterable(run.y for run in line.runs)])
    assert [y for y in curve["y"] if y is not None] == pytest.approx(flat, abs=np.ptp(flat) / 16_382)
    corners = [corner for strip in area.strips for corner in outline(strip)]
    found = [(x, y) for x, y in zip(band["x"], band["y"], strict=True) if y is not None]
    assert np.array(found) == pytest.approx(np.array(corners), abs=5 / 16_382)
