"""Texts of a profile in the reports: whatever they hold, they are shown, never acted on."""

import json
import xml.etree.ElementTree as ET

import lxml.html
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.report.drawing import page as drawn_page
from pvlvrt_compliance.report.drawing import svg as drawn_svg
from pvlvrt_compliance.report.drawing.of_profile import panels
from pvlvrt_compliance.report.formats import html
from pvlvrt_compliance.report.profile_words import render as render_words
from pvlvrt_compliance.results import ProfileSummary
from pvlvrt_compliance.texts import one_line

# All that a profile may hold: no control characters. Blanks are left to the layout.
TEXTS = st.text(st.characters(exclude_categories=["Cs", "Cc", "Cn", "Z"]), min_size=1, max_size=40) | st.sampled_from(
    ["<script>alert(1)</script>", "</title><script>", '"onload="x', "{{7*7}}", "{%raw%}", "&lt;b&gt;", "]]>", "<!--"]
)

PROFILE = """
schema_version = 1
id = "mine"
title = {}
include = ["iec61400-21"]
[requirements.ride_through.envelope]
source = {}
"""


@pytest.fixture(scope="module")
def profile_of(tmp_path_factory):
    """Load a profile with a title and a source: ``profile_of(title, source)``."""
    path = tmp_path_factory.mktemp("profiles") / "mine.toml"

    def load(title, source):
        texts = [json.dumps(text, ensure_ascii=False) for text in (title, source)]
        path.write_text(PROFILE.format(*texts), "utf-8")
        return load_profile(str(path))

    return load


def scripts(page):
    """Scripts and elements with handlers of events in a page."""
    return page.xpath("//script | //*[@*[starts-with(name(), 'on')]]")


@pytest.fixture(scope="module")
def scripts_of_the_report(make_test, make_results):
    """How many scripts a report has."""
    return len(scripts(lxml.html.document_fromstring(html.render(make_results(make_test("mine")), {}))))


@draws(25)
@given(TEXTS, TEXTS)
def test_the_report_shows_them(make_test, make_results, profile_of, scripts_of_the_report, title, source):
    """Title and sources stand in the report as texts, unseen characters spelled; no element comes of them."""
    profile = profile_of(title, source)
    summary = ProfileSummary(id=profile.id, title=title, digest=profile.digest, notes=profile.unverified())
    results = make_results(make_test("mine", title=title, clause=source)).model_copy(update={"profiles": (summary,)})
    page = lxml.html.document_fromstring(html.render(results, {}))
    assert len(scripts(page)) == scripts_of_the_report
    shown = page.text_content()
    assert one_line(title) in shown
    assert f"({one_line(source)})" in shown


@draws(50)
@given(TEXTS, TEXTS)
def test_figure_and_words_show_them(profile_of, title, source):
    """A title is the text of the figure, which stays well-formed; words show title and source as they are."""
    profile = profile_of(title, source)
    words = render_words(profile)
    assert words.startswith(f"mine: {title}\n")
    assert f"[inferred] NTS 631 v2.0, Fig. 27; {source}\n" in words
    svg = ET.fromstring(drawn_svg.render(profile.id, title, panels(profile)))
    assert next(svg.iter("{http://www.w3.org/2000/svg}title")).text == f"mine: {title}"
    assert not list(svg.iter("{http://www.w3.org/2000/svg}script"))


def test_the_page_of_a_figure_shows_them(profile_of):
    """A title with markup is a text of the page."""
    title = "</title><script>alert(1)</script>"
    profile = profile_of(title, "s")
    page = lxml.html.document_fromstring(drawn_page.render(profile.id, profile.title, panels(profile)))
    assert page.findtext(".//title") == f"mine: {title}"
    assert page.findtext(".//h1") == f"mine: {title}"
