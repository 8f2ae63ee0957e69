"""A real browser for the tests that look at a page in it."""

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from pages_seen import CHECKS
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.formats import html, pdf
from pvlvrt_compliance.results import Rating, Results, Status, TestResult, Verdict
from sheets import FIELDS, read, with_fields, words
from waiting import PATIENCE_S

Given = tuple[Results, dict[str, Drawing]]
"""Results, and drawings of their tests."""

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


def _verdict(check: str, status: Status = Status.PASS, **fields: Any) -> Verdict:
    numbers = {"measured": 0.98, "limit": 1.02, "margin": 0.04, "unit": "pu", "bound": "at_most", "at_s": 0.4}
    return Verdict(check=check, status=status, clause="NTS 631 v2.0, 5.11.2.2.4", **numbers | fields)


@pytest.fixture(scope="module")
def results(make_test: Callable[..., TestResult], make_results: Callable[..., Results]) -> Results:
    """Six tests of seven checks: two runs of one sag, one of them failed; marginal, unjudged, failed, tripped ones."""
    passed = tuple(map(_verdict, CHECKS))
    failed = (_verdict("ride_through", Status.FAIL, margin=-0.2, message="the breaker opens"), *passed[1:])
    marginal = (*passed[:-1], _verdict("overfrequency_power", margin=0.001, uncertainty=0.005))
    unjudged = (*passed[1:], Verdict(check="ride_through", status=Status.NOT_EVALUATED, message="no voltage"))
    asked = make_test().scenario
    turned = {**asked, "point_on_wave_deg": 90.0}
    tests = [
        make_test("VD3-full-1", checks=passed, title="phase c, 90 %, 0 deg"),
        make_test("VD3-full-2", checks=failed, title="phase c, 90 %, 90 deg", scenario=turned),
        make_test("marginal", checks=marginal),
        make_test("unjudged", checks=unjudged),
        make_test("late", checks=failed, title="órbita"),
        make_test("harmonics", checks=(*passed, Verdict(check="harmonics", status=Status.NOT_APPLICABLE))),
    ]
    return make_results(*tests)


@pytest.fixture(scope="module")
def page(results: Results) -> str:
    """Its page, without figures."""
    return html.render(results, {})


@pytest.fixture(scope="session")
def given(
    make_test: Callable[..., TestResult], make_results: Callable[..., Results], make_drawing: Callable[..., Drawing]
) -> Given:
    """Results of two tests, one of them failed, and their drawings."""
    rating = Rating(apparent_power_kva=500, phase_voltage_v=230, frequency_hz=50)
    tests = [make_test("VD3-full-1", rating=rating), make_test("VD3-full-2", Status.FAIL, rating=rating)]
    results = with_fields(make_results(*tests), **FIELDS)
    return results, {test.key: make_drawing(test, buckets=200) for test in tests}


@pytest.fixture(scope="session")
def content(given: Given) -> bytes:
    """The report of them."""
    return pdf.render(*given)


@pytest.fixture(scope="session")
def pages(content: bytes) -> list[str]:
    """Text of each page."""
    return [words(page) for page in read(content).pages]
