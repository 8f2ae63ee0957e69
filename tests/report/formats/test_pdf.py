"""The report as PDF: what stands on its sheets, for how long it can be kept, and that no text becomes markup."""

import base64
import hashlib
import io
import os
import pickle
import re
import signal
import subprocess
import sys
import threading
from typing import NamedTuple

import pypdf
import pytest

from pictures import png
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.report.document.front import front
from pvlvrt_compliance.report.formats import pdf
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.report.pdf.blocks import Items
from pvlvrt_compliance.report.pdf.characters import SHOWN, shown
from pvlvrt_compliance.report.pdf.made import conditions_section
from pvlvrt_compliance.results import Rating, ReportDetails, Results, Status, Verdict
from waiting import PATIENCE_S

A4 = (595.0, 842.0)
MARGIN = 18 * 72 / 25.4  # of the right, pt
PNG = "data:image/png;base64," + base64.b64encode(png()).decode()
FIELDS = {
    "client": "Huerta Solar, S.A.",
    "object": "Inverter 4.2",
    "number": "R-17",
    "revision": "B",
    "author": "A. Ingeniera",
    "approval": "B. Jefa",
    "logo": PNG,
}
HOSTILE = r'#panic("no") $x^2$ *bold* _it_ <label> @ref \u{41} // no /* no */ `raw` ~ -- --- "quoted" = Head [x] {y}'


def with_fields(results: Results, language: str = "en", **fields: str) -> Results:
    """The same results with what whoever files them has given."""
    return results.model_copy(update={"report": ReportDetails(language=language, fields=fields)})


def read(content: bytes) -> pypdf.PdfReader:
    """A PDF, parsed."""
    return pypdf.PdfReader(io.BytesIO(content))


def words(page: pypdf.PageObject) -> str:
    """Its text, with one space where there are several."""
    return " ".join(page.extract_text().replace("\u200b", "").split())


@pytest.fixture(scope="session")
def given(make_test, make_results, make_drawing):
    """Results of two tests, one of them failed, and their drawings."""
    rating = Rating(apparent_power_kva=500, phase_voltage_v=230, frequency_hz=50)
    tests = [make_test("VD3-full-1", rating=rating), make_test("VD3-full-2", Status.FAIL, rating=rating)]
    results = with_fields(make_results(*tests), **FIELDS)
    return results, {test.key: make_drawing(test, buckets=200) for test in tests}


@pytest.fixture(scope="session")
def content(given):
    """The report of them."""
    return pdf.render(*given)


@pytest.fixture(scope="session")
def pages(content):
    """Text of each page."""
    return [words(page) for page in read(content).pages]


def test_the_title_page_says_what_was_filed(pages, given):
    """Fields in their order, the verdict, and room for those who sign."""
    first = pages[0]
    for text in ("Inverter 4.2", "Huerta Solar, S.A.", "R-17", "FAIL", "A. Ingeniera", "B. Jefa", "signature"):
        assert text in first
    assert given[0].run_id in first
    assert "IEC 61400-21 voltage drops, Spanish demands" in first


def test_every_page_has_its_number_and_its_document(pages):
    """Page n of N on all; number, revision and title above all but the first."""
    for number, text in enumerate(pages, start=1):
        assert f"page {number} of {len(pages)}" in text
        assert ("R-17, revision B" in text.partition("Grid-code")[2][:200]) == (number > 1)


def test_contents_name_the_pages(pages):
    """Where the contents say that a section begins, its heading is; all sections and tests are among them."""
    contents = pages[1].partition("Contents")[2]
    lines = re.findall(r"((?:\d+(?:\.\d+)?|[AB](?:\.\d+)?) [^.]{3,80}?) ?(?:\. ?){4,}(\d+)", contents)
    assert len(lines) >= 14
    for heading, page in lines:
        assert heading in pages[int(page) - 1], heading


def test_all_parts_are_there(pages):
    """What a report that is filed has to say."""
    text = " ".join(pages[2:])
    for part in (
        "This report is a pre-study.",  # scope
        "IEC 61400-21-1, not checked against the document",  # what is not verified
        "read in the official text",  # meaning of the marks
        "500 kVA",  # conditions
        "docs/measurements.md",  # method
        "mean reactive power 156.5 kvar is 4.2 kvar below the curve at 0.700 pu",  # findings
        "156.5 kvar 160.7 kvar -4.2 kvar",  # rows of verdicts
        "section 4 <3>",  # clauses
        "positive-sequence voltage",  # measurements
        "pr_integral_gain",  # parameters
        "5f1c9a" * 10,  # digests, whole
        "pvlvrt-check --profile iec61400-21 --sag 90% --phases c",  # the command
    ):
        assert part in text, part


def test_figures_are_vectors(content, pages):
    """None is made of pixels, as the logo on the first page is, and no text of one is lost."""
    with_pixels = [has_pixels(page["/Resources"].get_object()) for page in read(content).pages]
    assert with_pixels == [True] + [False] * (len(pages) - 1)
    assert "Figure 1" in " ".join(pages)
    assert "time from the start of the record (s)" in " ".join(pages)


def test_outline_leads_to_every_test(content):
    """A reader's list of bookmarks."""

    def titles(entries):
        for entry in entries:
            yield from titles(entry) if isinstance(entry, list) else [entry.title]

    found = " ".join(titles(read(content).outline))
    for name in ("Summary", "Scope and disclaimer", "Results", "VD3-full-1: pass", "VD3-full-2: fail", "Parameters"):
        assert name in found


def test_it_says_what_it_is(content, given):
    """Title, author, language and time of the document; the time is that of the run."""
    reader = read(content)
    assert reader.metadata.title == "Grid-code compliance report: Inverter 4.2"
    assert reader.metadata.author == "A. Ingeniera"
    assert reader.metadata.creation_date.isoformat()[:19] == given[0].provenance["created"][:19]
    assert reader.root_object["/Lang"] == "en"


def test_it_can_be_kept_and_read_aloud(content):
    """It claims PDF/A-2a and PDF/UA-1, is tagged, and has every font within it."""
    reader = read(content)
    claims = reader.root_object["/Metadata"].get_data().decode("utf-8")
    assert re.search(r"pdfaid:part[^0-9]+2\b", claims)
    assert re.search(r"pdfaid:conformance\W+A\b", claims)
    assert re.search(r"pdfuaid:part[^0-9]+1\b", claims)
    assert reader.root_object["/MarkInfo"]["/Marked"]
    fonts = [font for page in reader.pages for font in fonts_of(page["/Resources"].get_object())]
    assert fonts
    for font in fonts:
        descriptor = font["/DescendantFonts"][0].get_object()["/FontDescriptor"]
        assert {"/FontFile2", "/FontFile3"} & set(descriptor.get_object())


def has_pixels(resources):
    """Whether there is a picture of pixels on a page, or in a figure on it."""
    parts = [part.get_object() for part in resources.get("/XObject", {}).values()]
    return any(
        part["/Subtype"] == "/Image" or has_pixels(part.get("/Resources", pypdf.generic.DictionaryObject()))
        for part in parts
    )


def fonts_of(resources):
    """Fonts of a page and of the figures on it."""
    yield from (font.get_object() for font in resources.get("/Font", {}).values())
    for part in resources.get("/XObject", {}).values():
        if "/Resources" in part.get_object():
            yield from fonts_of(part.get_object()["/Resources"].get_object())


def test_the_run_before_is_known_by_its_pdf(content, given):
    """The output folder looks for the id of the run in the file as it is."""
    assert given[0].run_id.encode() in content


def test_another_process_makes_the_same_bytes(content, given, tmp_path):
    """Nothing of the time, of the place or of chance is in it."""
    (tmp_path / "given.pickle").write_bytes(pickle.dumps(given))
    program = (
        "import hashlib, pickle, sys\n"
        "from pvlvrt_compliance.report.formats import pdf\n"
        "given = pickle.loads(open('given.pickle', 'rb').read())\n"
        "print(hashlib.sha256(pdf.render(*given)).hexdigest())\n"
    )
    environment = os.environ | {"PYTHONHASHSEED": "7", "TZ": "Asia/Tokyo", "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == hashlib.sha256(content).hexdigest()


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


def test_of_nothing_there_is_a_report(make_results):
    """No test, no field, no provenance."""
    bare = make_results().model_copy(update={"provenance": {}, "profiles": ()})
    assert read(pdf.render(bare, {})).pages


def test_without_typst_the_extra_is_named(monkeypatch):
    """Before anything is run."""
    monkeypatch.setitem(sys.modules, "typst", None)
    with pytest.raises(UsageError, match=r"--format pdf needs the extra: pip install 'pvlvrt-compliance\[pdf\]'"):
        pdf.needs()


def test_ctrl_c_need_not_wait_for_it(monkeypatch, make_results):
    """Laying out thousands of pages takes a while and hears no signal: it is done in a thread of its own."""
    released, ended = threading.Event(), []

    def compile_for_long(*_, **__):
        os.kill(os.getpid(), signal.SIGINT)
        ended.append(released.wait(PATIENCE_S))
        return b""

    monkeypatch.setattr("typst.compile", compile_for_long)
    with pytest.raises(KeyboardInterrupt):
        pdf.render(make_results(), {})
    assert not ended  # it goes on, and nobody waits for it
    released.set()
