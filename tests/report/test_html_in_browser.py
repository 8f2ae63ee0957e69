"""The report in a real browser: figures are drawn, lazily, all of them for print, and nothing is fetched."""

import shutil
import socket
import subprocess
import threading
from pathlib import Path

import lxml.html
import pytest

from pvlvrt_compliance.report import html

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
pytestmark = pytest.mark.skipif(BROWSER is None, reason="no chromium is installed")

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


class Proxy:
    """Takes every connection that the browser attempts, keeps its first line, and answers nothing."""

    def __init__(self):
        self.requests = []
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port = self._server.getsockname()[1]
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self):
        while True:
            try:
                connection, _ = self._server.accept()
            except OSError:
                return
            with connection:
                connection.settimeout(5)
                self.requests.append(connection.recv(4096).split(b"\r\n")[0].decode("latin-1"))

    def close(self):
        self._server.close()


@pytest.fixture
def proxy():
    found = Proxy()
    yield found
    found.close()


@pytest.fixture(scope="module")
def page(make_test, make_results, make_figure):
    tests = [make_test(name) for name in NAMES]
    return html.render(make_results(*tests), {test.id: make_figure(test) for test in tests})


def _dom(page: str, folder: Path, *options: str):
    file = folder / "report.html"
    file.write_text(page, encoding="utf-8")
    command = [BROWSER, *QUIET, f"--user-data-dir={folder / 'profile'}", "--window-size=1280,1500"]
    command += ["--virtual-time-budget=5000", *options, "--dump-dom", file.as_uri()]
    done = subprocess.run(command, capture_output=True, timeout=90, check=True)
    return lxml.html.document_fromstring(done.stdout.decode("utf-8"))


def _drawn(tree, name):
    """Curves that a figure really shows: those with a path of some length."""
    paths = tree.xpath(f"//section[@data-test='{name}']//g[contains(@class, 'trace scatter')]//path[@class='js-line']/@d")
    return sum(len(path) > len("M0,0") for path in paths)


def test_figures_are_drawn_when_seen_and_nothing_is_fetched(page, tmp_path, proxy):
    """The figure in view is drawn with all its curves, the last one waits, and the browser asks no one for anything."""
    tree = _dom(page, tmp_path, f"--proxy-server=127.0.0.1:{proxy.port}", "--proxy-bypass-list=<-loopback>")
    assert tree.xpath("//*[contains(@class, 'main-svg')]")
    assert _drawn(tree, NAMES[0]) == 15
    assert _drawn(tree, NAMES[-1]) == 0
    assert "drawn by JavaScript" in tree.xpath(f"//section[@data-test='{NAMES[-1]}']//div[@class='plot']")[0].text_content()
    assert proxy.requests == []


def test_figures_offer_no_upload(page, tmp_path):
    """Plotly's button that sends a chart to its maker's server is not there; that to save a picture is."""
    tree = _dom(page, tmp_path)
    titles = set(tree.xpath("//*[contains(@class, 'modebar-btn')]/@data-title"))
    assert any("Download" in title for title in titles)
    assert not any("Share" in title or "Cloud" in title for title in titles)


def test_all_figures_are_drawn_before_printing(page, tmp_path):
    """On the way to the printer every figure is drawn, as wide as the paper, and nothing stays folded."""
    printing = '<script>window.dispatchEvent(new Event("beforeprint"))</script></body>'
    tree = _dom(page.replace("</body>", printing), tmp_path)
    assert [_drawn(tree, name) for name in NAMES] == [15, 15, 15]
    widths = tree.xpath("//div[contains(@class, 'svg-container')]/*[contains(@class, 'main-svg')]/@width")
    assert set(widths) == {"680"}
    assert all(details.get("open") is not None for details in tree.iter("details"))
