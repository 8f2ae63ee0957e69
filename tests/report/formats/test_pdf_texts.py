"""Texts in the report as PDF: whatever users write, and other languages."""

from typing import NamedTuple

import pypdf
import pytest

from pvlvrt_compliance.report.document.front import front
from pvlvrt_compliance.report.formats import pdf
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.pdf.blocks import Items
from pvlvrt_compliance.report.pdf.characters import SHOWN, shown
from pvlvrt_compliance.report.pdf.made import conditions_section
from pvlvrt_compliance.results import Status, Verdict
from sheets import A4, read, with_fields, words

MARGIN = 18 * 72 / 25.4  # of the right, pt

HOSTILE = r'#panic("no") $x^2$ *bold* _it_ <label> @ref \u{41} // no /* no */ `raw` ~ -- --- "quoted" = Head [x] {y}'


@pytest.fixture(scope="module")
def hostile(make_test, make_results):
    """A report whose every text is an attempt: markup, control characters, long words, letters that no font has."""
    message = f"{HOSTILE} " + "word " * 1000
    check = Verdict(
        check="my_own_check" * 9,
        status=Status.FAIL,
        clause=HOSTILE,
        stretch="x" * 300,
        confidence="#mark",
        message=message,
        unit="#u",
        measured=1,
        limit=2,
        margin=-1,
    )
    test = make_test(HOSTILE, title=HOSTILE, checks=(check,), clause=HOSTILE, waveforms=None)
    fields = {
        "client": HOSTILE,
        "object": "W" * 200,
        "author": "שלום مرحبا \U0001f600 漢字\x07\u202e\x00 \udcff",
        "number": "n" * 300,
        "remark": "one\ntwo\r\nthree",
        "logo": "data:image/png;base64,iVBORw0KGgo=",
    }
    return read(pdf.render(with_fields(make_results(test), **fields), {}))


@pytest.fixture(scope="module")
def hostile_pages(hostile):
    """Its pages with the places of their text."""
    return [placed(page) for page in hostile.pages]


class Placed(NamedTuple):
    """A page: its text, and where each piece of it begins, in pt from the lower left corner."""

    words: str
    pieces: list[tuple[float, float, str]]


def placed(page: pypdf.PageObject) -> Placed:
    """Text of a page with its places."""
    pieces: list[tuple[float, float, str]] = []
    text = page.extract_text(visitor_text=lambda text, _cm, tm, _font, _size: pieces.append((tm[4], tm[5], text)))
    return Placed(" ".join(text.replace("\u200b", "").split()), pieces)


def test_text_is_never_markup(hostile_pages):
    """What a user writes stands as it was written: on the title page, in headings, in contents, in tables."""
    text = " ".join(page.words for page in hostile_pages)
    assert text.replace(" ", "").count(HOSTILE.replace(" ", "")) >= 5


def test_what_no_font_has_is_spelled_out(hostile_pages):
    """A name in other letters is still told, as is what nobody can see; letters that fonts have stay."""
    first = hostile_pages[0].words
    assert r"[U+1F600][U+6F22][U+5B57]\x07\u202e\x00" in first.replace(" ", "")


def test_words_told_about_the_document_are_whole(hostile):
    """What is broken to fit a sheet is not broken where there is none; a byte that is no text does no harm."""
    assert hostile.metadata.title == f"Grid-code compliance report: {'W' * 200}"
    assert hostile.metadata.author.endswith(r"\x00 \xff")


def test_a_logo_that_is_none_is_said(hostile_pages):
    """The report is made all the same."""
    assert "The logo that was given cannot be shown" in hostile_pages[0].words + hostile_pages[1].words


def test_nothing_leaves_the_page(hostile_pages):
    """Long words are broken: no piece of text begins beyond the right margin or below the last line."""
    for x, y, text in (piece for page in hostile_pages for piece in page.pieces):
        if text.strip():
            assert 0 <= x < A4[0] - MARGIN, text
            assert 0 <= y < A4[1], text


def test_a_long_message_goes_on_on_the_next_page(hostile_pages):
    """None of 1000 words is lost."""
    assert sum(page.words.count("word ") for page in hostile_pages) >= 1000


def test_every_character_that_is_let_through_has_a_glyph(make_results):
    """In plain, bold and code; PDF/A refuses a document with one that has none."""
    every = " ".join(chr(code) for first, last in SHOWN for code in range(first, last + 1))
    assert "[U+" not in shown(every)
    results = with_fields(make_results(), remark=every, object=every)
    origin = results.provenance | {"command": every}
    assert pdf.render(results.model_copy(update={"provenance": origin}), {}).startswith(b"%PDF")


def test_a_name_in_a_figure_may_hold_anything(make_test, make_results, make_drawing):
    """A check of another package names its bands: markup, a control character and an emoji do not break the picture."""
    test = make_test()
    band = test.bands[0].model_copy(update={"name": '<g a="&"> \x07 \U0001f600 ]]>'})
    named = test.model_copy(update={"bands": (band,)})
    content = pdf.render(make_results(named), {named.key: make_drawing(named, buckets=50)})
    text = " ".join(words(page) for page in read(content).pages)
    assert '<g a="&"> [U+0007] [U+1F600] ]]>' in text


def test_it_speaks_spanish(make_test, make_results):
    """All words of the document; what checks and profiles say stays as it is, and a sentence tells so."""
    content = pdf.render(with_fields(make_results(make_test()), "es", object="Inversor"), {})
    reader = read(content)
    text = " ".join(words(page) for page in reader.pages)
    assert reader.root_object["/Lang"] == "es"
    assert b"/Lang (en" in content or b"/Lang(en" in content
    for part in ("CONFORME", "Alcance y limitaciones", "estudio previo", "página 1 de", "se citan en inglés", "Anexo"):
        assert part.lower() in text.lower(), part


def test_conditions_speak_spanish(make_test, make_results):
    """What all tests have in common is told in the language of the report; what differs is not."""
    one, other = make_test("one"), make_test("other")
    other = other.model_copy(update={"scenario": other.scenario | {"cell_temperature_c": 70.0}})
    told = conditions_section(
        with_fields(make_results(one, other), "es"), front(make_results(one), Texts("es")), Texts("es")
    )
    (items,) = [block for block in told.blocks if isinstance(block, Items)]
    sentences = [cell.text for cell in items.items]
    assert "La red funciona a 50 Hz antes de la perturbación." in sentences
    assert not any("temperatura" in sentence for sentence in sentences)
