"""Texts of a profile in the reports: whatever they hold, they are shown, never acted on."""

import json
import xml.etree.ElementTree as ET

import lxml.html
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pvlvrt_compliance.checks.results import ProfileSummary
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.report import html
from pvlvrt_compliance.report.profile_figure import render_html, render_svg
from pvlvrt_compliance.report.profile_words import render as render_words

# All that a profile may hold: no control characters. Blanks are left to the layout.
TEXTS = st.text(st.characters(exclude_categories=["Cs", "Cc", "Cn", "Z"]), min_size=1, max_size=40) | st.sampled_from(
    ["<script>alert(1)</script>", "</title><script>", '"onload="x', "{{7*7}}", "{%raw%}", "&lt;b&gt;", "]]>", "<!--"]
)


@pytest.fixture(scope="module")
def profile_of(tmp_path_factory):
    """Load a profile with a title and a source: ``profile_of(title, source)``."""
    path = tmp_path_factory.mktemp("profiles") / "mine.toml"

    def load(title, source):
        head = f'schema_version = 1\nid = "mine"\ntitle = {json.dumps(title, ensure_ascii=False)}\ninclude = ["iec61400-21"]\n'
        path.write_text(
            head + f"[requirements.ride_through.envelope]\nsource = {json.dumps(source, ensure_ascii=False)}\n", "utf-8"
        )
        return load_profile(str(path))

    return load


def scripts(page):
    """Scripts and elements with handlers of events in a page."""
    return page.xpath("//script | //*[@*[starts-with(name(), 'on')]]")


@settings(deadline=None, max_examples=50)
@given(TEXTS, TEXTS)
def test_the_report_shows_them(make_test, make_results, profile_of, title, source):
    """Title and sources stand in the report as texts; no element comes of them."""
    profile = profile_of(title, source)
    summary = ProfileSummary(id=profile.id, title=title, digest=profile.digest, notes=profile.unverified())
    results = make_results(make_test("mine", title=title, clause=source)).model_copy(update={"profiles": (summary,)})
    page = lxml.html.document_fromstring(html.render(results, {}))
    plain = lxml.html.document_fromstring(html.render(make_results(make_test("mine")), {}))
    assert len(scripts(page)) == len(scripts(plain))
    shown = page.text_content()
    assert title in shown
    assert f"({source})" in shown


@settings(deadline=None, max_examples=50)
@given(TEXTS, TEXTS)
def test_figure_and_words_show_them(profile_of, title, source):
    """A title is the text of the figure, which stays well-formed; words show title and source as they are."""
    profile = profile_of(title, source)
    words = render_words(profile)
    assert words.startswith(f"mine: {title}\n")
    assert f"[inferred] NTS 631 v2.0, Fig. 27; {source}\n" in words
    svg = ET.fromstring(render_svg(profile))
    assert next(svg.iter("{http://www.w3.org/2000/svg}title")).text == f"mine: {title}"
    assert not list(svg.iter("{http://www.w3.org/2000/svg}script"))


def test_the_page_of_a_figure_shows_them(profile_of):
    """A title with markup is a text of the page."""
    title = "</title><script>alert(1)</script>"
    page = lxml.html.document_fromstring(render_html(profile_of(title, "s")))
    assert page.findtext(".//title") == f"mine: {title}"
    assert page.findtext(".//h1") == f"mine: {title}"
