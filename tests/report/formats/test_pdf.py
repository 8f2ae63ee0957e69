"""The report as PDF: what stands on its sheets, for how long it can be kept, and that no text becomes markup."""

import hashlib
import os
import pickle
import re
import signal
import subprocess
import sys
import threading

import pypdf
import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.report.formats import pdf
from sheets import read
from waiting import PATIENCE_S


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
