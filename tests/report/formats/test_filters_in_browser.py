"""The filters of a report's page, its links and its keys, in a browser."""

import pytest

from baselines import held
from pages_seen import EVIL, FILTERS, PHONE, beyond_the_window, seen_of, seen_tests
from pvlvrt_compliance.report.formats import html

pytestmark = pytest.mark.browser


def _rows_shown(page):
    return {text.split()[0] for text in seen_of(page, ".signs tbody .test-name")}


def test_a_filter_holds_in_all_places(visit, page):
    """Sections, matrix and contents show the same tests; how many is told aloud, and the address keeps it."""
    seen = visit(page)
    for status, wanted in FILTERS.items():
        seen.check(f"[name=status][value={status}]", force=True)
        assert seen_tests(seen) == wanted
        assert {text.split()[-1] for text in seen_of(seen, ".contents .tests li")} == wanted
        assert _rows_shown(seen) == {name.removesuffix("-1").removesuffix("-2") for name in wanted}
        assert seen.inner_text("output[aria-live=polite]") == f"Tests shown: {len(wanted)} of 6"
    seen.check("[name=status][value=failed]", force=True)
    seen.reload()
    assert seen_tests(seen) == FILTERS["failed"]


def test_what_is_known_is_filtered_from_what_is_new_or_worse(visit, results, page):
    """With a baseline there is a filter more, also on a phone, where nothing reaches beyond the window."""
    known = f"{results.tests[1].key} ride_through fail -0.2 pu # {EVIL}"
    lost = f"{results.tests[2].key} overfrequency_power pass +0.5 pu"
    seen = visit(html.render(held(results, known, lost), {}), "#status=news", **PHONE)
    assert seen_tests(seen) == {"marginal", "late"}
    assert beyond_the_window(seen) == []
    assert EVIL in seen.text_content("[aria-labelledby=baseline]")
    assert seen_tests(visit(page, "#status=news")) == FILTERS["all"]  # none without a baseline


def test_check_and_text_filter_too(visit, page):
    """A check shows the tests in which it was judged, or failed; accents and capitals do not matter to a text."""
    seen = visit(page)
    seen.select_option("[name=check]", "ride_through")
    seen.check("[name=status][value=failed]", force=True)
    assert seen_tests(seen) == {"VD3-full-2", "late"}
    seen.fill("[name=text]", "ORBITA")
    assert seen_tests(seen) == {"late"}
    assert seen.evaluate("location.hash") == "#status=failed&check=ride_through&text=ORBITA"
    seen.click("button[type=reset]")
    assert seen_tests(seen) == FILTERS["all"]
    assert visit(page, "#text=nothing%20like%20it").inner_text(".shown") == "Tests shown: 0 of 6"


def test_failures_are_one_click_away(visit, page):
    """From the first page to the first failure, from there to the next and back to its row in the matrix."""
    seen = visit(page)
    place = "(id) => Math.abs(document.getElementById(id).getBoundingClientRect().top) < innerHeight / 2"
    for link, target in (("first failure", "test-2"), ("Next failure", "test-5"), ("Previous failure", "test-2")):
        here = seen.evaluate("location.hash").removeprefix("#")
        scope = seen.locator(f"section[aria-labelledby={here}]" if here else "header")
        scope.get_by_role("link", name=link).click()
        seen.wait_for_function(place, arg=target)
    seen.locator("section[aria-labelledby=test-2]").get_by_role("link", name="Back to the matrix").click()
    seen.wait_for_function(place, arg="row-1")


def test_a_link_leads_to_what_the_filter_hides(visit, page):
    """A link to a test that is filtered out takes the filter away."""
    seen = visit(page, "#status=marginal")
    assert seen_tests(seen) == {"marginal"}
    seen.evaluate("location.hash = 'test-5'")
    seen.wait_for_function("document.querySelector('[data-test=late]').checkVisibility()")
    assert seen_tests(seen) == FILTERS["all"]


def test_runs_of_one_sag_open(visit, page):
    """They stand in one row with the symbol of each; a button shows them one by one."""
    seen = visit(page)
    assert [text.split() for text in seen_of(seen, "#row-1 > *")][:3] == [["VD3-full", "1", "2", "+"], ["✓✗"], ["✓✗"]]
    assert not seen_of(seen, ".signs .run")
    seen.focus("#row-1 .opens")
    seen.keyboard.press("Enter")
    assert seen.get_attribute("#row-1 .opens", "aria-expanded") == "true"
    assert seen_of(seen, ".signs .run .test-name") == ["VD3-full-1", "VD3-full-2"]
    assert "90°" in seen_of(seen, ".signs .run .what")[1]


def test_the_keyboard_reaches_all(visit, page):
    """The first stop leads past the first page, arrows move the filter, and what has the focus is seen to have it."""
    seen = visit(page)
    seen.keyboard.press("Tab")
    assert seen.evaluate("document.activeElement.className") == "skip"
    assert seen.evaluate("document.activeElement.getBoundingClientRect().left") >= 0
    seen.focus("[name=status][value=all]")
    seen.keyboard.press("ArrowRight")
    assert seen_tests(seen) == FILTERS["failed"]
    assert seen.evaluate("getComputedStyle(document.querySelector(':focus-visible + span')).outlineStyle") == "solid"
    for selector in (".tools select", ".tools [type=search]", ".theme", ".signs a", ".opens"):
        seen.focus(selector)
        assert seen.evaluate("getComputedStyle(document.activeElement).outlineStyle") == "solid"
