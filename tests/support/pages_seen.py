"""Pages of a report: what those of the tests hold, and what is seen of them in a browser."""

from typing import Any

from pvlvrt_compliance.results import ReportDetails, Results

PHONE = {"viewport": {"width": 390, "height": 844}}

CHECKS = (
    *("ride_through", "reactive_current", "negative_sequence_current", "support_dynamics"),
    *("active_power_recovery", "oscillation", "overfrequency_power"),
)

EVIL = "</script><script>alert(1)</script></style><img src=x onerror=alert(2)>]]>\"'{{7*7}}&amp;"


def in_language(results: Results, language: str) -> Results:
    """The same results, to be told in a language."""
    return results.model_copy(update={"report": ReportDetails(language=language)})


def seen_of(page: Any, selector: str) -> list[str]:
    """Texts of what is seen of a selector."""
    return [" ".join(e.inner_text().split()) for e in page.query_selector_all(selector) if e.is_visible()]


def beyond_the_window(page: Any) -> list[str]:
    """What reaches beyond the right edge, where it is cut; the matrix scrolls in its box."""
    return page.evaluate("""() => [...document.querySelectorAll('main *, header *')]
        .filter((e) => e.checkVisibility() && !e.closest('.wide, .unseen, .live, svg'))
        .filter((e) => e.getBoundingClientRect().right > innerWidth + 1).map((e) => e.outerHTML.slice(0, 80))""")


FILTERS = {
    "failed": {"VD3-full-2", "late"},
    "marginal": {"marginal"},
    "unjudged": {"unjudged"},
    "all": {"VD3-full-1", "VD3-full-2", "marginal", "unjudged", "late", "harmonics"},
}


def seen_tests(page: Any) -> set[str]:
    """Tests whose sections are seen."""
    return {e.get_attribute("data-test") for e in page.query_selector_all("section.test") if e.is_visible()}
