import base64
import html as escaping
import itertools
import re
import zlib

import lxml.html
import pytest

from pvlvrt_compliance.report.drawing.model import Area, Axis, Line, Mark, Panel, Run, Text
from pvlvrt_compliance.report.formats import html
from pvlvrt_compliance.results import ReportDetails, Status, Verdict


@pytest.fixture(scope="module")
def page(make_test, make_results, make_drawing):
    """A report of two tests, one of them failed."""
    tests = [make_test("VD3-full-1"), make_test("VD3-full-2", Status.FAIL)]
    return html.render(make_results(*tests), {test.key: make_drawing(test) for test in tests})


@pytest.fixture(scope="module")
def tree(page):
    """The same, parsed."""
    return lxml.html.document_fromstring(page)


def _words(element):
    return " ".join(" ".join(element.itertext()).split())


def test_it_stands_alone(tree):
    """Nothing is loaded from anywhere: no address in any attribute, and the page forbids itself to fetch."""
    assert not tree.xpath("//link | //iframe | //img | //script[@src]")
    assert all(link.get("href").startswith("#") for link in tree.xpath("//a"))
    policy = tree.xpath("//meta[@http-equiv='Content-Security-Policy']")[0].get("content")
    assert policy.startswith("default-src 'none'")
    (plotly,) = tree.xpath("//script[@id='plotly']")
    assert b"plotly.js v" in zlib.decompress(base64.b64decode(plotly.text))


def test_verdict_comes_first(tree):
    """The first heading is the verdict, with counts, the profile and the command to run it again."""
    assert tree.xpath("//h1|//h2|//h3")[0].text_content().strip() == "✗ FAIL"
    header = _words(tree.find(".//header"))
    for piece in (
        "2 tests",
        "IEC 61400-21 voltage drops",
        "--sag 90% --phases c",
        "1 ✗ fail",
        "5 ✓ pass",
        "2 – not applicable",
    ):
        assert piece in header


def test_what_is_not_verified_is_said_first(tree):
    """How much is not verified stands in the header, with a way to the list; each weak mark is set off."""
    header = tree.find(".//header")
    assert "Not verified: 2 numbers" in _words(header)
    assert header.xpath(".//a[@href='#unverified']")
    notes = tree.xpath("//section[@class='unverified']//li/text()")
    assert "ride_through envelope: inferred (NTS 631 Fig. 27)" in notes
    marks = {mark.text: "unverified" in mark.get("class") for mark in tree.xpath("//span[starts-with(@class, 'mark')]")}
    assert marks == {"inferred": True, "chosen": True, "confirmed": False, "memory": True}


def test_it_can_be_read_by_all(tree):
    """One main heading, no level skipped, unique ids, links that lead somewhere, headers with a scope."""
    levels = [int(heading.tag[1]) for heading in tree.xpath("//h1|//h2|//h3|//h4")]
    assert levels.count(1) == 1
    assert all(after <= before + 1 for before, after in itertools.pairwise(levels))
    ids = tree.xpath("//@id")
    assert len(ids) == len(set(ids))
    assert {link.get("href")[1:] for link in tree.xpath("//a")} <= set(ids)
    assert {name for names in tree.xpath("//@aria-labelledby") for name in names.split()} <= set(ids)
    assert all(cell.get("scope") in {"col", "row", "rowgroup"} for cell in tree.iter("th"))
    assert all(table.find("caption") is not None for table in tree.iter("table"))


def test_a_section_a_test(tree):
    """Each test shows its scenario, checks, measurements in three windows and its figure."""
    sections = tree.xpath("//section[@class='test']")
    assert [section.get("data-test") for section in sections] == ["VD3-full-1", "VD3-full-2"]
    text = _words(sections[0])
    sag = "Phase c loses 90 % of its voltage for 0.309 s; 10 % is left."
    for piece in (sag, "The grid is stiff", "235.7 kvar", "during 0.409 s to 0.589 s", "0.700 pu"):
        assert piece in text
    assert len(sections[0].xpath(".//div[@class='plot']")) == 7


def test_provenance_is_shown_whole(tree):
    """Versions, digests and every parameter, however deep, can be read at the end."""
    text = _words(tree.xpath("//section[@class='provenance']")[0])
    for piece in (
        "5f1c9a" * 10,
        "numpy 2.4.6",
        "controller.sogi_gain 1.414213562",
        "plant.C 0.065",
        "plant.curve (0, 0), (1.5, 0.85)",
    ):
        assert piece in text


def test_what_identifies_a_run_is_named_in_words(tree, make_results):
    """The command, to be copied, is the one of the results, on the first page and with the provenance."""
    section = tree.xpath("//section[@class='provenance']")[0]
    names = section.xpath(".//h3[1]/following-sibling::dl[1]//dt/text()")
    assert "made on" in names
    assert set(names).isdisjoint(make_results().provenance.keys() - {"command", "controller", "profile"})
    commands = [command.text_content() for command in tree.xpath("//code[@class='command']")]
    assert commands == 2 * [make_results().provenance["command"]]


def test_a_passing_report_does_not_speak_of_what_is_not_a_pass(make_test, make_results):
    """Where all that is to be told is what did not apply the section is called so, in the contents, too."""
    passed = Verdict(check="ride_through", status=Status.PASS)
    idle = Verdict(check="harmonics", status=Status.NOT_APPLICABLE, message="no window")
    page = html.render(make_results(make_test(checks=(passed, idle))), {})
    assert "What is not a pass" not in page
    tree = lxml.html.document_fromstring(page)
    assert tree.get_element_by_id("findings").text == "What did not apply, and why"
    assert tree.xpath("//nav//a[@href='#findings']/text()") == ["What did not apply, and why"]


def test_the_worst_margin_of_every_check_is_on_the_first_page(make_test, make_results):
    """Five are seen at once, the others, further from failing, unfold below them."""
    checks = [
        Verdict(check=f"c{n}", status=Status.PASS, measured=1 - n / 10, limit=1.0, margin=n / 10, bound="at_most")
        for n in range(7)
    ]
    tree = lxml.html.document_fromstring(html.render(make_results(make_test(checks=tuple(checks))), {}))
    card = tree.get_element_by_id("worst").getparent()
    assert [_words(entry).split()[1] for entry in card.xpath("./ul/li")] == [f"c{n}," for n in range(5)]
    assert [_words(entry).split()[1] for entry in card.xpath("./details/ul/li")] == ["c5,", "c6,"]
    assert _words(card.find(".//summary")) == "2 further checks"


def test_text_is_text(make_test, make_results, make_drawing):
    """Whatever a name or message holds, it can neither become markup nor end a script."""
    evil = "</script><script>alert(1)</script><b>&"
    checks = (
        Verdict(check=evil, status=Status.FAIL, message=evil, clause=evil, confidence=evil, unit=evil, measured=1.0),
    )
    test = make_test(evil, checks=checks, title=evil, scenario={evil: evil})
    drawing = make_drawing(make_test())
    drawing = drawing._replace(zooms=tuple(zoom._replace(name=evil) for zoom in drawing.zooms))
    bad = Line(evil, (Run((0.0, 1.0), (0.0, 1.0)),))
    panels = (
        Panel(
            evil,
            Axis(evil),
            Axis(evil),
            (bad,),
            (Area(evil, ()),),
            says=Text("plot.described", dict.fromkeys(("title", "says"), evil)),
        ),
    )
    marks = (Mark(0.1, "#222222", "dash", Text("mark.opening_by", {"at": evil, "cause": evil})),)
    drawing = drawing._replace(panels=panels, marks=marks)
    page = html.render(make_results(test), {test.key: drawing})
    assert "<script>alert" not in page
    assert escaping.escape(evil) in page
    assert len(re.findall(r"<script[ >]", page)) == 4
    assert not lxml.html.document_fromstring(page).xpath("//b")


def test_same_results_same_bytes(make_test, make_results):
    """The only date in the report is the one that its provenance carries."""
    results = make_results(make_test())
    assert html.render(results, {}) == html.render(results, {})
    assert "No figure" in html.render(results, {})
    assert "Plotly" not in html.render(results, {})


def test_an_empty_run_is_a_page(make_results):
    """A run without tests says so."""
    assert "No test was run." in html.render(make_results(), {})


PIXEL = (
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNgAAAAAgABSK+kcQAAAABJRU5ErkJggg=="
)


@pytest.mark.parametrize(("logo", "shown"), [(PIXEL, [PIXEL]), ("https://example.org/logo.png", []), ("", [])])
def test_a_logo_stands_on_the_first_page(make_test, make_results, logo, shown):
    """One that was read from a file; an address that leads elsewhere is none."""
    report = ReportDetails(fields={"logo": logo, "client": "Solar Norte"})
    results = make_results(make_test()).model_copy(update={"report": report})
    header = lxml.html.document_fromstring(html.render(results, {})).find(".//header")
    assert header.xpath(".//img/@src") == shown
    assert "client Solar Norte" in _words(header)


def test_another_language_tells_all_but_the_data(make_test, make_results):
    """The page of a Spanish report is Spanish; what checks and profiles say is marked as English, and that is said."""
    results = make_results(make_test(reactive=Status.FAIL))
    told = results.model_copy(update={"report": ReportDetails(language="es")})
    tree = lxml.html.document_fromstring(html.render(told, {}))
    assert tree.get("lang") == "es"
    assert tree.get_element_by_id("verdict").text_content().strip() == "✗ NO CONFORME"
    messages = [check.message for check in results.tests[0].checks if check.message]
    assert {_words(e) for e in tree.xpath("//*[@lang='en']")} >= {*messages, results.profiles[0].title}
    assert "figuran en inglés" in _words(tree) or "en inglés" in _words(tree.find(".//header"))
    english = lxml.html.document_fromstring(html.render(results, {}))
    ours = english.xpath("//h2[not(ancestor::*[@lang])]/text() | //th[@scope='col']/text()")
    same = {word.strip() for word in ours if word.strip()} & {
        t.strip() for t in tree.xpath("//h2/text() | //th/text()")
    }
    assert same <= {"iec61400-21", "sag-90pct-c"}
