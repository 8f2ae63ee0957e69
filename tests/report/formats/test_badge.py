"""The badge: right words, right widths, nothing from anywhere else."""

import re
import xml.etree.ElementTree as ET

import pytest

from pvlvrt_compliance.report.formats import badge
from told import BROKEN, FAILED, IDLE, KNOWN, PASSED, UNJUDGED, WORSE, run_of, test_of

SVG = "{http://www.w3.org/2000/svg}"
RUNS = {
    "pass 2/2": run_of((PASSED,), (PASSED, IDLE)),
    "fail 1/2": run_of((PASSED,), (FAILED,)),
    "fail 1/1": run_of((WORSE,)),
    "pass 1/2, 1 known": run_of((PASSED,), (KNOWN,)),
    "error 1/3": run_of((BROKEN,), (PASSED,), (KNOWN,)),
    "not judged 1/2": run_of((UNJUDGED,), (PASSED,)),
    "pass 1/2": run_of((UNJUDGED, PASSED), (PASSED,), allow_unjudged=True),
    "not judged": run_of((IDLE,)),
}

every_run = pytest.mark.parametrize("words", RUNS)


@every_run
def test_words(words):
    """How the run counts for a gate, and how many tests that is."""
    root = ET.fromstring(badge.render(RUNS[words]))
    assert [each.text for each in root.iter(f"{SVG}text")] == ["grid code", words]
    assert root.get("aria-label") == root.find(f"{SVG}title").text == f"grid code: {words}"
    assert root.get("role") == "img"


def _edges(outline):
    """Left edge and width of a half, from the first line of its outline and its corners: ``M3 0H61a0 0 ...``."""
    begin, end, right = map(float, re.match(r"M(\d+) 0H(\d+)a(\d+) ", outline).groups())
    left = float(re.search(r"a(\d+) \1 0 0 1 \1 -\1z$|a(0) 0 0 0 1 0 0z$", outline)[0][1:].split()[0])
    return begin - left, end + right - begin + left


@every_run
def test_each_text_stands_within_its_half(words):
    """Both halves have the width of their text and the same margins, whichever font a reader has."""
    root = ET.fromstring(badge.render(RUNS[words]))
    edges = [_edges(half.get("d")) for half in root.iter(f"{SVG}path")]
    assert edges[0][0] == 0
    assert edges[1][0] == edges[0][1]
    assert sum(width for _, width in edges) == float(root.get("width"))
    for text, (left, width) in zip(root.iter(f"{SVG}text"), edges, strict=True):
        margin = float(text.get("x")) - left
        assert margin == width - margin - float(text.get("textLength")) == 6
        per_letter = float(text.get("textLength")) / len(text.text)
        assert 4.5 < per_letter < 7.5  # of a font of 11 px


def test_states_have_colours_of_their_own():
    """Pass, fail, known failures and not judged are told apart, each white on dark enough a ground."""
    names = ("pass 2/2", "fail 1/2", "pass 1/2, 1 known", "not judged")
    colours = [list(ET.fromstring(badge.render(RUNS[name])).iter(f"{SVG}path"))[1].get("fill") for name in names]
    assert len(set(colours)) == 4
    for colour in colours:
        parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
        linear = [x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in parts]
        luminance = sum(weight * x for weight, x in zip((0.2126, 0.7152, 0.0722), linear, strict=True))
        assert 1.05 / (luminance + 0.05) >= 4.5  # WCAG 2.2, contrast of text


def test_no_text_of_others_is_in_it():
    """Names and messages do not reach a picture that stands on a page of others."""
    bad = FAILED.model_copy(update={"check": "<script>", "message": "<script>"})
    content = badge.render(run_of(test_of("<script>", bad)))
    assert "script" not in content
    assert content.count("http") == 1  # the name space
