"""The page of a report as readers meet it: wide, on a phone, in the dark, by keyboard, without JavaScript, on paper."""

import io

import pypdf
import pytest

from pages_seen import CHECKS, EVIL, FILTERS, PHONE, beyond_the_window, in_language, seen_of, seen_tests
from pvlvrt_compliance.report.formats import html
from pvlvrt_compliance.results import ReportDetails, Status, Verdict

pytestmark = pytest.mark.browser


A4_PX = 680  # 180 mm between the margins


def _wider_than_itself(page):
    """What can be scrolled sideways within the page, by its class."""
    return page.evaluate("""() => [...document.querySelectorAll('body *')]
        .filter((e) => e.scrollWidth > e.clientWidth + 1)
        .filter((e) => ['auto', 'scroll'].includes(getComputedStyle(e).overflowX)).map((e) => e.className)""")


def _cut(page):
    """Fields of the toolbar that are narrower than what stands in them."""
    return page.evaluate("""() => [...document.querySelectorAll('.tools select, .tools [type=search]')].filter((e) => {
        const given = e.offsetWidth;
        Object.assign(e.style, { fieldSizing: 'content', width: 'auto', maxWidth: 'none' });
        const needed = e.offsetWidth;
        e.removeAttribute('style');
        return needed > given + 1;
    }).map((e) => e.name)""")


def _broken(page):
    """Badges and arguments of a command that stand on more than one line."""
    return page.evaluate("""() => [...document.querySelectorAll('.badge, .command span')]
        .filter((e) => e.checkVisibility())
        .filter((e) => e.getClientRects().length > 1 || e.offsetHeight > 2 * parseFloat(getComputedStyle(e).fontSize))
        .map((e) => e.textContent)""")


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize("options", [{}, PHONE], ids=["wide", "phone"])
def test_nothing_is_wider_than_the_window(visit, results, make_drawing, options, language):
    """At 1440 px and on a phone nothing scrolls sideways, seven checks and runs in one row included.

    No badge and no option of a command is broken over lines, and no field cuts its words; at 1440 px the toolbar is one
    line.
    """
    first = results.tests[0]
    drawings = {first.key: make_drawing(first)} if language == "en" else {}
    seen = visit(html.render(in_language(results, language), drawings), "#test-1", **options)
    if drawings:
        seen.evaluate("document.querySelector('.plot').scrollIntoView()")
        seen.wait_for_selector(".figures .main-svg")
    assert seen.evaluate("document.documentElement.scrollWidth") <= seen.viewport_size["width"]
    assert _wider_than_itself(seen) == []
    assert beyond_the_window(seen) == []
    assert seen.locator(".badge").count() > 20
    assert _broken(seen) == []
    assert _cut(seen) == []
    if not options:
        assert seen.evaluate("document.querySelector('.tools').offsetHeight") < 60


def test_on_a_phone_one_symbol_stands_for_runs_of_one_row(visit, page):
    """The worst of them, until they are unfolded; what it stands for is said above."""
    seen = visit(page, **PHONE)
    assert [text.split() for text in seen_of(seen, "#row-1 > *")][:3] == [["VD3-full", "+"], ["✗"], ["✗"]]
    assert "The worst of their symbols" in seen_of(seen, ".legend")[0]
    seen.click("#row-1 .opens")
    assert [text for text in seen_of(seen, ".signs .run td:nth-child(2)")] == ["✓", "✗"]


def test_on_paper_the_matrix_fits(visit, page):
    """Seven checks, their test and what happens stand between the margins of an A4 page."""
    seen = visit(page, viewport={"width": A4_PX, "height": 900})
    seen.emulate_media(media="print")
    assert seen.evaluate("document.querySelector('.signs').getBoundingClientRect().right") <= A4_PX
    assert seen.evaluate("document.documentElement.scrollWidth") <= A4_PX
    assert len(seen_of(seen, ".signs thead th")) == 2 + len(CHECKS) + 1


def test_the_first_column_and_the_headings_stay(visit, page):
    """Wherever a matrix without room is scrolled to, its row and its column can be read."""
    seen = visit(page, viewport={"width": 240, "height": 300})
    seen.evaluate("document.querySelector('.wide').scrollTo(60, 60)")
    assert seen.evaluate("[document.querySelector('.wide').scrollLeft, document.querySelector('.wide').scrollTop]") == [
        60,
        60,
    ]
    corner = seen.evaluate("""() => { const box = document.querySelector('.wide').getBoundingClientRect();
        const head = document.querySelector('.signs thead th').getBoundingClientRect();
        const row = document.querySelector('.signs tbody:last-child th').getBoundingClientRect();
        return [head.left - box.left, head.top - box.top, row.left - box.left]; }""")
    assert corner == pytest.approx([0, 0, 0], abs=2)


CONTRAST = """() => {
  const rgb = (text) => text.match(/[\\d.]+/g).map(Number);
  const luminance = ([r, g, b]) => [r, g, b].map((v) => v / 255)
    .map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
    .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
  const ground = (e) => {
    for (; e; e = e.parentElement) {
      const found = rgb(getComputedStyle(e).backgroundColor);
      if (found.length < 4 || found[3] === 1) return found;
    }
    return [255, 255, 255];
  };
  const found = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const e = node.parentElement;
    if (!node.textContent.trim() || !e.checkVisibility() || e.closest("script, .unseen")) continue;
    const [a, b] = [luminance(rgb(getComputedStyle(e).color)), luminance(ground(e))].sort((x, y) => y - x);
    found.push([(a + 0.05) / (b + 0.05), node.textContent.trim().slice(0, 40), e.className]);
  }
  return found;
}"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_every_word_has_contrast(visit, page, scheme):
    """At least 4.5 to 1 (WCAG 2 AA), by the colours that the browser has computed, in both themes."""
    seen = visit(page, color_scheme=scheme)
    found = seen.evaluate(CONTRAST)
    assert len(found) > 300
    assert [each for each in found if each[0] < 4.5] == []


def test_light_and_dark(visit, page):
    """The page begins as the system is; the button turns it, says so, and tells the figures."""
    seen = visit(page, color_scheme="dark")
    ground = "getComputedStyle(document.body).backgroundColor"
    dark = seen.evaluate(ground)
    assert seen.evaluate("document.documentElement.dataset.theme") == "dark"
    seen.evaluate("document.addEventListener('themechange', () => { document.body.dataset.told = 'so'; })")
    seen.click(".theme")
    assert seen.evaluate("document.documentElement.dataset.theme") == "light"
    assert seen.get_attribute(".theme", "aria-pressed") == "false"
    assert seen.get_attribute("body", "data-told") == "so"
    assert seen.evaluate(ground) != dark


def test_without_javascript(visit, page):
    """All is there to be read and no control stands about that does nothing."""
    seen = visit(page, java_script_enabled=False)
    assert seen_tests(seen) == FILTERS["all"]
    assert not seen_of(seen, "button, select, input")
    assert len(seen_of(seen, ".signs tbody tr")) == 5
    assert "VD3-full 1 2" in seen_of(seen, ".signs tbody .test-name")


def test_printing_loses_nothing(visit, results, make_drawing):
    """Filtered or not, folded or not, seen or not, all is on A4 pages that carry a title and their number."""
    drawings = {results.tests[4].key: make_drawing(results.tests[4])}
    seen = visit(html.render(results, drawings), "#status=marginal")
    paper = pypdf.PdfReader(io.BytesIO(seen.pdf(prefer_css_page_size=True)))
    texts = [" ".join(sheet.extract_text().split()) for sheet in paper.pages]
    whole = " ".join(texts)
    assert {round(float(sheet.mediabox.width) * 0.3528) for sheet in paper.pages} == {210}
    for number, text in enumerate(texts, start=1):
        assert "Grid-code compliance report · IEC 61400-21" in text
        assert f"{number} / {len(texts)}" in text
    for test in results.tests:
        assert sum(text.count(f"{test.id} ") for text in texts) >= 2
    for piece in ("ride_through envelope: inferred", "What did not apply", "curve (0, 0), (1.5, 0.85)", "5f1c9a" * 10):
        assert piece.replace(" ", "") in whole.replace(" ", "")
    assert "Show all" not in whole
    titles = seen.locator(".figure figcaption strong").all_text_contents()
    assert len(titles) > 4
    for title in titles:
        assert title in whole
    assert whole.count("time from the start of the record") == seen.locator(".plot[data-over=time]").count()


def test_text_of_users_stays_text(visit, make_test, results, make_drawing):
    """Titles, messages, fields, names and paths with markup in them are shown as they are, and run nothing."""
    checks = (
        Verdict(check=EVIL, status=Status.FAIL, message=EVIL, clause=EVIL, unit=EVIL, measured=1.0, stretch=EVIL),
    )
    test = make_test(EVIL, checks=checks, title=EVIL, clause=EVIL, waveforms=EVIL, scenario={EVIL: EVIL})
    drawing = make_drawing(make_test())
    drawing = drawing._replace(zooms=tuple(zoom._replace(name=EVIL) for zoom in drawing.zooms))
    profile = results.profiles[0].model_copy(update={"title": EVIL, "notes": (EVIL,), "left_out": (EVIL,)})
    fields = dict.fromkeys(("client", "object", "number", "remark"), EVIL) | {"logo": f'data:image/png;base64,"{EVIL}'}
    told = results.model_copy(
        update={
            "tests": (test,),
            "profiles": (profile,),
            "provenance": {"command": EVIL, "controller": EVIL, "controller_name": EVIL, EVIL: {EVIL: EVIL}},
            "report": ReportDetails(language="es", fields=fields),
        }
    )
    seen = visit(html.render(told, {test.key: drawing}), "#test-1")
    seen.wait_for_selector(".figures .main-svg")
    assert seen.evaluate("document.querySelectorAll('body script:not([type]), script[src]').length") == 2
    assert seen.evaluate("document.querySelectorAll('img:not(.logo), [onerror]').length") == 0
    assert seen.inner_text("section.test .title").startswith(EVIL)
    assert seen.inner_text("section.test .message").strip() == EVIL
    running = seen.evaluate("[...document.styleSheets[0].cssRules].filter((r) => r.type === 6).length")
    assert running == 2
