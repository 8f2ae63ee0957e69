import html as escaping
import itertools
import re

import lxml.html
import pytest

from pvlvrt_compliance.report.formats import html
from pvlvrt_compliance.results import Status, Verdict


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


def test_it_stands_alone(page, tree):
    """Nothing is loaded from anywhere: no address in any attribute, and the page forbids itself to fetch."""
    assert not tree.xpath("//link | //iframe | //img | //script[@src]")
    assert all(link.get("href").startswith("#") for link in tree.xpath("//a"))
    policy = tree.xpath("//meta[@http-equiv='Content-Security-Policy']")[0].get("content")
    assert policy.startswith("default-src 'none'")
    assert page.count("plotly.js v") == 1


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
    """The notes of the profile stand in the header, and every weak mark beside its verdict is set off."""
    header = _words(tree.find(".//header"))
    assert "Not verified: 2 numbers" in header
    assert "ride_through envelope: inferred (NTS 631 Fig. 27)" in header
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
    assert all(cell.get("scope") in {"col", "row"} for cell in tree.iter("th"))
    assert all(table.find("caption") is not None for table in tree.iter("table"))


def test_a_section_a_test(tree):
    """Each test shows its scenario, checks, measurements in three windows and its figure."""
    sections = tree.xpath("//section[@class='test']")
    assert [section.get("data-test") for section in sections] == ["VD3-full-1", "VD3-full-2"]
    text = _words(sections[0])
    for piece in ("90 % in phase c, 10 % left", "0.309 s", "stiff", "235.7 kvar", "during 0.409 s to 0.589 s", "0.700"):
        assert piece in text
    assert sections[0].xpath(".//div[@class='plot']")


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


def test_text_is_text(make_test, make_results, make_drawing):
    """Whatever a name or message holds, it can neither become markup nor end a script."""
    evil = "</script><script>alert(1)</script><b>&"
    checks = (
        Verdict(check=evil, status=Status.FAIL, message=evil, clause=evil, confidence=evil, unit=evil, measured=1.0),
    )
    test = make_test(evil, checks=checks, title=evil, scenario={evil: evil})
    drawing = make_drawing(make_test())
    drawing = drawing._replace(zooms=tuple(zoom._replace(name=evil) for zoom in drawing.zooms))
    page = html.render(make_results(test), {test.key: drawing})
    assert "<script>alert" not in page
    assert escaping.escape(evil) in page
    assert len(re.findall(r"<script[ >]", page.split("plotly.js v")[0])) == 2


def test_same_results_same_bytes(make_test, make_results):
    """The only date in the report is the one that its provenance carries."""
    results = make_results(make_test())
    assert html.render(results, {}) == html.render(results, {})
    assert "No figure" in html.render(results, {})
    assert "Plotly" not in html.render(results, {}).split("<script>")[0]


def test_an_empty_run_is_a_page(make_results):
    """A run without tests says so."""
    assert "No test was run." in html.render(make_results(), {})
