"""The page of a report as readers meet it: wide, on a phone, in the dark, by keyboard, without JavaScript, on paper."""

import io

import pypdf
import pytest

from baselines import held
from pvlvrt_compliance.report.formats import html
from pvlvrt_compliance.results import ReportDetails, Status, Verdict

pytestmark = pytest.mark.browser

PHONE = {"viewport": {"width": 390, "height": 844}}
A4_PX = 680  # 180 mm between the margins
CHECKS = (
    *("ride_through", "reactive_current", "negative_sequence_current", "support_dynamics"),
    *("active_power_recovery", "oscillation", "overfrequency_power"),
)
EVIL = "</script><script>alert(1)</script></style><img src=x onerror=alert(2)>]]>\"'{{7*7}}&amp;"


def _verdict(check, status=Status.PASS, **fields):
    numbers = {"measured": 0.98, "limit": 1.02, "margin": 0.04, "unit": "pu", "bound": "at_most", "at_s": 0.4}
    return Verdict(check=check, status=status, clause="NTS 631 v2.0, 5.11.2.2.4", **numbers | fields)


@pytest.fixture(scope="module")
def results(make_test, make_results):
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
def page(results):
    """Its page, without figures."""
    return html.render(results, {})


def _in_language(results, language):
    return results.model_copy(update={"report": ReportDetails(language=language)})


def _shown(page, selector):
    """Texts of what is seen of a selector."""
    return [" ".join(e.inner_text().split()) for e in page.query_selector_all(selector) if e.is_visible()]


def _beyond_the_window(page):
    """What reaches beyond the right edge, where it is cut; the matrix scrolls in its box."""
    return page.evaluate("""() => [...document.querySelectorAll('main *, header *')]
        .filter((e) => e.checkVisibility() && !e.closest('.wide, .unseen, .live, svg'))
        .filter((e) => e.getBoundingClientRect().right > innerWidth + 1).map((e) => e.outerHTML.slice(0, 80))""")


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
    seen = visit(html.render(_in_language(results, language), drawings), "#test-1", **options)
    if drawings:
        seen.evaluate("document.querySelector('.plot').scrollIntoView()")
        seen.wait_for_selector(".figures .main-svg")
    assert seen.evaluate("document.documentElement.scrollWidth") <= seen.viewport_size["width"]
    assert _wider_than_itself(seen) == []
    assert _beyond_the_window(seen) == []
    assert seen.locator(".badge").count() > 20
    assert _broken(seen) == []
    assert _cut(seen) == []
    if not options:
        assert seen.evaluate("document.querySelector('.tools').offsetHeight") < 60


def test_on_a_phone_one_symbol_stands_for_runs_of_one_row(visit, page):
    """The worst of them, until they are unfolded; what it stands for is said above."""
    seen = visit(page, **PHONE)
    assert [text.split() for text in _shown(seen, "#row-1 > *")][:3] == [["VD3-full", "+"], ["✗"], ["✗"]]
    assert "The worst of their symbols" in _shown(seen, ".legend")[0]
    seen.click("#row-1 .opens")
    assert [text for text in _shown(seen, ".signs .run td:nth-child(2)")] == ["✓", "✗"]


def test_on_paper_the_matrix_fits(visit, page):
    """Seven checks, their test and what happens stand between the margins of an A4 page."""
    seen = visit(page, viewport={"width": A4_PX, "height": 900})
    seen.emulate_media(media="print")
    assert seen.evaluate("document.querySelector('.signs').getBoundingClientRect().right") <= A4_PX
    assert seen.evaluate("document.documentElement.scrollWidth") <= A4_PX
    assert len(_shown(seen, ".signs thead th")) == 2 + len(CHECKS) + 1


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


FILTERS = {
    "failed": {"VD3-full-2", "late"},
    "marginal": {"marginal"},
    "unjudged": {"unjudged"},
    "all": {"VD3-full-1", "VD3-full-2", "marginal", "unjudged", "late", "harmonics"},
}


def _tests_shown(page):
    return {e.get_attribute("data-test") for e in page.query_selector_all("section.test") if e.is_visible()}


def _rows_shown(page):
    return {text.split()[0] for text in _shown(page, ".signs tbody .test-name")}


def test_a_filter_holds_in_all_places(visit, page):
    """Sections, matrix and contents show the same tests; how many is told aloud, and the address keeps it."""
    seen = visit(page)
    for status, wanted in FILTERS.items():
        seen.check(f"[name=status][value={status}]", force=True)
        assert _tests_shown(seen) == wanted
        assert {text.split()[-1] for text in _shown(seen, ".contents .tests li")} == wanted
        assert _rows_shown(seen) == {name.removesuffix("-1").removesuffix("-2") for name in wanted}
        assert seen.inner_text("output[aria-live=polite]") == f"Tests shown: {len(wanted)} of 6"
    seen.check("[name=status][value=failed]", force=True)
    seen.reload()
    assert _tests_shown(seen) == FILTERS["failed"]


def test_what_is_known_is_filtered_from_what_is_new_or_worse(visit, results, page):
    """With a baseline there is a filter more, also on a phone, where nothing reaches beyond the window."""
    known = f"{results.tests[1].key} ride_through fail -0.2 pu # {EVIL}"
    lost = f"{results.tests[2].key} overfrequency_power pass +0.5 pu"
    seen = visit(html.render(held(results, known, lost), {}), "#status=news", **PHONE)
    assert _tests_shown(seen) == {"marginal", "late"}
    assert _beyond_the_window(seen) == []
    assert EVIL in seen.text_content("[aria-labelledby=baseline]")
    assert _tests_shown(visit(page, "#status=news")) == FILTERS["all"]  # none without a baseline


def test_check_and_text_filter_too(visit, page):
    """A check shows the tests in which it was judged, or failed; accents and capitals do not matter to a text."""
    seen = visit(page)
    seen.select_option("[name=check]", "ride_through")
    seen.check("[name=status][value=failed]", force=True)
    assert _tests_shown(seen) == {"VD3-full-2", "late"}
    seen.fill("[name=text]", "ORBITA")
    assert _tests_shown(seen) == {"late"}
    assert seen.evaluate("location.hash") == "#status=failed&check=ride_through&text=ORBITA"
    seen.click("button[type=reset]")
    assert _tests_shown(seen) == FILTERS["all"]
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
    assert _tests_shown(seen) == {"marginal"}
    seen.evaluate("location.hash = 'test-5'")
    seen.wait_for_function("document.querySelector('[data-test=late]').checkVisibility()")
    assert _tests_shown(seen) == FILTERS["all"]


def test_runs_of_one_sag_open(visit, page):
    """They stand in one row with the symbol of each; a button shows them one by one."""
    seen = visit(page)
    assert [text.split() for text in _shown(seen, "#row-1 > *")][:3] == [["VD3-full", "1", "2", "+"], ["✓✗"], ["✓✗"]]
    assert not _shown(seen, ".signs .run")
    seen.focus("#row-1 .opens")
    seen.keyboard.press("Enter")
    assert seen.get_attribute("#row-1 .opens", "aria-expanded") == "true"
    assert _shown(seen, ".signs .run .test-name") == ["VD3-full-1", "VD3-full-2"]
    assert "90°" in _shown(seen, ".signs .run .what")[1]


def test_the_keyboard_reaches_all(visit, page):
    """The first stop leads past the first page, arrows move the filter, and what has the focus is seen to have it."""
    seen = visit(page)
    seen.keyboard.press("Tab")
    assert seen.evaluate("document.activeElement.className") == "skip"
    assert seen.evaluate("document.activeElement.getBoundingClientRect().left") >= 0
    seen.focus("[name=status][value=all]")
    seen.keyboard.press("ArrowRight")
    assert _tests_shown(seen) == FILTERS["failed"]
    assert seen.evaluate("getComputedStyle(document.querySelector(':focus-visible + span')).outlineStyle") == "solid"
    for selector in (".tools select", ".tools [type=search]", ".theme", ".signs a", ".opens"):
        seen.focus(selector)
        assert seen.evaluate("getComputedStyle(document.activeElement).outlineStyle") == "solid"


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
    assert _tests_shown(seen) == FILTERS["all"]
    assert not _shown(seen, "button, select, input")
    assert len(_shown(seen, ".signs tbody tr")) == 5
    assert "VD3-full 1 2" in _shown(seen, ".signs tbody .test-name")


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
