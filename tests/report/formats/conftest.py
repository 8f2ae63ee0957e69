"""A real browser for the tests that look at a page in it."""

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from waiting import PATIENCE_S

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """The machine's chromium, without a window, for the tests of one module.

    No longer than that: while playwright has it no other test of the process can run an event loop of its own.
    """
    playwright = pytest.importorskip("playwright.sync_api")
    if BROWSER is None:
        pytest.skip("no chromium is installed")
    with playwright.sync_playwright() as driver:
        running = driver.chromium.launch(executable_path=BROWSER, args=["--no-sandbox", "--disable-gpu"])
        yield running
        running.close()


@pytest.fixture
def visit(browser: Any, tmp_path: Path) -> Iterator[Callable[..., Any]]:
    """Open a page as a reader does: ``visit(html, hash="", **options of the context)``.

    At the end nothing may have been asked of any network, and nothing complained of.
    """
    file = tmp_path / "report.html"
    found: list[str] = []

    def go(text: str, hash: str = "", **options: Any) -> Any:
        file.write_text(text, encoding="utf-8")
        page = browser.new_context(**{"viewport": {"width": 1440, "height": 1000}} | options).new_page()
        page.set_default_timeout(1000 * PATIENCE_S)
        page.on("request", lambda request: found.append(request.url))
        page.on("console", lambda message: found.append(message.text))
        page.on("pageerror", lambda error: found.append(str(error)))
        page.on("dialog", lambda dialog: found.append(dialog.message))
        page.goto(file.as_uri() + hash)
        return page

    yield go
    for context in browser.contexts:
        context.close()
    assert [each for each in found if each.partition("#")[0] != file.as_uri()] == []
