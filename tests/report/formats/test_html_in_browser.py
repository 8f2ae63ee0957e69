"""The report in a real browser: figures are drawn, lazily, all of them for print, and nothing is fetched."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import lxml.html
import numpy as np
import pytest

from pvlvrt_compliance.report.drawing.model import outline, values
from pvlvrt_compliance.report.formats import html
from waiting import PATIENCE_S

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
pytestmark = [pytest.mark.browser, pytest.mark.skipif(BROWSER is None, reason="no chromium is installed")]

QUIET = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-extensions",
    "--disable-default-apps",
    "--no-pings",
]
NAMES = ("VD3-full-1", "VD3-full-2", "VD3-full-3")


# Writes down what the page asks for, whether it is answered or not.
WATCH = """<head><script>
new PerformanceObserver((list) => {
  for (const entry of list.getEntries()) document.documentElement.dataset.asked += " " + entry.name;
}).observe({ type: "resource", buffered: true });
document.documentElement.dataset.asked = "";
</script>"""


@pytest.fixture(scope="module")
def page(make_test, make_results, make_drawing):
    """A report of three tests."""
    tests = [make_test(name) for name in NAMES]
    return html.render(make_results(*tests), {test.key: make_drawing(test) for test in tests})


@pytest.fixture(scope="module")
def curves(make_test, make_drawing):
    """How many lines and areas the drawing of each has."""
    return sum(len(panel.lines) + len(panel.areas) for panel in make_drawing(make_test()).panels)


def _dom(page: str, folder: Path, *options: str):
    file = folder / "report.html"
    file.write_text(page, encoding="utf-8")
    command = [BROWSER, *QUIET, f"--user-data-dir={folder / 'profile'}", "--window-size=1280,1500"]
    command += ["--virtual-time-budget=2000", *options, "--dump-dom", file.as_uri()]
    done = subprocess.run(command, capture_output=True, timeout=PATIENCE_S, check=True)
    return lxml.html.document_fromstring(done.stdout.decode("utf-8"))


def _drawn(tree, name):
    """Number of curves and limits that a figure really shows: those with a path that leads somewhere."""
    curves = f"//section[@data-test='{name}']//g[contains(@class, 'trace scatter')]"
    return len(tree.xpath(f"{curves}[.//path[@class='js-line' and string-length(@d) > 8]]"))


def _watched(page: str) -> str:
    """Return the page with a record of what it asks for, and free to ask."""
    return re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', "", page).replace("<head>", WATCH, 1)


def test_figures_are_drawn_when_seen_and_nothing_is_fetched(page, curves, tmp_path):
    """The figure in view is drawn with all its curves, the last one waits, and the page neither asks nor tells anyone.

    Plotly would by itself offer to send the chart to its maker's server.
    """
    # The image shows that a request would have been written down.
    tree = _dom(_watched(page).replace("<main", '<img src="http://127.0.0.1:9/pixel"><main'), tmp_path)
    assert tree.get("data-asked").split() == ["http://127.0.0.1:9/pixel"]
    assert tree.xpath("//*[contains(@class, 'main-svg')]")
    assert _drawn(tree, NAMES[0]) == curves
    assert _drawn(tree, NAMES[-1]) == 0
    last = tree.xpath(f"//section[@data-test='{NAMES[-1]}']//div[@class='plot']")[0]
    assert "drawn by JavaScript" in last.text_content()
    titles = set(tree.xpath("//*[contains(@class, 'modebar-btn')]/@data-title"))
    assert any("Download" in title for title in titles)
    assert not any("Share" in title or "Cloud" in title for title in titles)


def test_all_figures_are_drawn_before_printing(page, curves, tmp_path):
    """On the way to the printer every figure is drawn, as wide as the paper, and nothing stays folded."""
    printing = '<script>window.dispatchEvent(new Event("beforeprint"))</script></body>'
    tree = _dom(page.replace("</body>", printing), tmp_path)
    assert [_drawn(tree, name) for name in NAMES] == [curves] * 3
    widths = tree.xpath("//div[contains(@class, 'svg-container')]/*[contains(@class, 'main-svg')]/@width")
    assert set(widths) == {"680"}
    assert all(details.get("open") is not None for details in tree.iter("details"))


def test_packed_samples_come_out_as_they_went_in(make_test, make_results, make_drawing, tmp_path):
    """What `report.js` makes of a curve in pieces, and of a band, is what the drawing has: places, values and gaps."""
    test = make_test(NAMES[0])
    drawing = make_drawing(test, buckets=150)
    given = "document.querySelector('.plot').data.map(({name, x, y}) => ({name, x, y}))"
    draw = f'window.dispatchEvent(new Event("beforeprint")); document.body.dataset.seen = JSON.stringify({given})'
    tell = f"<script>{draw}</script></body>"
    page = html.render(make_results(test), {test.key: drawing}).replace("</body>", tell)
    seen = json.loads(_dom(page, tmp_path).find("body").get("data-seen"))
    panel = next(panel for panel in drawing.panels if panel.title == "Phase currents")
    (line,) = (line for line in panel.lines if line.name == "i<sub>a</sub>")
    (area,) = (area for area in panel.areas if area.name == "i<sub>a</sub>")
    band, curve = (trace for trace in seen if trace["name"] == "i<sub>a</sub>")
    expected = [place for run in line.runs for place in (*values(run.x), None)][:-1]
    assert [None if y is None else x for x, y in zip(curve["x"], curve["y"], strict=True)] == [
        place if place is None else pytest.approx(place, abs=1e-9) for place in expected
    ]
    flat = [y for run in line.runs for y in run.y]
    assert [y for y in curve["y"] if y is not None] == pytest.approx(flat, rel=1e-6, abs=1e-9)
    corners = [corner for strip in area.strips for corner in outline(strip)]
    drawn = [(x, y) for x, y in zip(band["x"], band["y"], strict=True) if y is not None]
    assert np.array(drawn) == pytest.approx(np.array(corners), rel=1e-6, abs=1e-9)
