"""Texts of others in Markdown: a parser of its own finds no markup in them, and no service a call or a link."""

import re

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from markdown_it import MarkdownIt

from pvlvrt_compliance.report import marked
from pvlvrt_compliance.report.document.comment import comment
from pvlvrt_compliance.report.formats import github, markdown
from pvlvrt_compliance.results import exit_status
from pvlvrt_compliance.texts import printable
from told import BROKEN, FAILED, IDLE, KNOWN, PASSED, UNJUDGED, WORSE, run_of, test_of

PARSER = MarkdownIt("commonmark").enable(["table", "strikethrough"])
OURS = {"<details>", "</details>", "<summary>", "</summary>", "<code>", "</code>", "<sub>", "</sub>"}
BREAK = "\u200b"

# What GitHub and GitLab make links, calls, emoji and formulae of, on top of CommonMark.
CALLS = re.compile(r"[@#!~$%^&][\w\"']|:[\w+-]+:|://|www\.|\bGH-\d", re.IGNORECASE)

texts = st.text(alphabet=st.sampled_from("ab1 |\\`*_[]()<>!#@~$%^&:/-+.\"'\n\r\t\u202e"), max_size=30) | st.text(
    max_size=30
)


def inline(tokens):
    """All tokens within paragraphs and cells."""
    return [child for token in tokens if token.children for child in token.children]


def as_read(text):
    """What a reader sees of a text."""
    return "".join(each.content for each in inline(PARSER.parse(text)) if each.type in ("text", "text_special"))


@given(text=texts)
@example("![x](https://a.example/b.png) <img src=x onerror=1> </details> `a|b` \\| @team #1 !2 ~bug $x^2$ :smile: GH-1")
@example("&lt;b&gt; &#64;team user@host.example www.example.org")
def test_any_text_is_read_as_it_is(text):
    """White space is one space, what cannot be seen is spelled; all else comes out as it is, and is nothing more."""
    tokens = inline(PARSER.parse(f"a {marked.plain(text)} b"))
    assert {token.type for token in tokens} <= {"text", "text_special"}
    seen = " ".join(printable(text, None).split())
    assert as_read(f"a {marked.plain(text)} b").replace(BREAK, "") == f"a {seen} b"
    assert not CALLS.search(as_read(marked.plain(text)))


@given(text=texts)
@example("# a")
@example("1. a")
@example("- a")
@example("---")
@example("> a")
def test_a_text_that_a_line_begins_with_begins_nothing(text):
    """Neither as a paragraph nor as an item of a list is it a heading, a list, a quotation or a line of its own."""
    for line, around in ((marked.plain(text), set()), (f"- {marked.plain(text)}", {"bullet_list", "list_item"})):
        found = {token.type.removesuffix("_open").removesuffix("_close") for token in PARSER.parse(line)}
        assert found <= {"paragraph", "inline"} | around


def test_a_long_text_is_cut():
    """At so many characters, of which the last says that there was more; white space before it does not count."""
    assert marked.plain(" " * 20 + "abcdefgh", 4) == "abc…"
    assert marked.plain("abcd", 4) == "abcd"


@given(name=texts, message=texts, reason=texts)
def test_a_page_has_no_markup_but_its_own(name, message, reason):
    """Whatever tests, checks, clauses and reasons say: no link, no picture, no HTML, no cell more in a row."""
    bad = FAILED.model_copy(update={"check": name or "x", "message": message, "clause": message})
    known = KNOWN.model_copy(update={"known_reason": reason})
    content = comment(run_of(test_of(name, bad, known, PASSED), controller=message), 60_000)
    tokens = PARSER.parse(content)
    assert {token.content.strip() for token in inline(tokens) if token.type == "html_inline"} <= OURS
    for token in tokens:
        if token.type == "html_block":
            assert set(re.findall("<[^>]*>", token.content)) <= OURS
    assert not {token.type for token in inline(tokens)} & {"link_open", "image", "code_inline"}
    rows = [line for line in content.splitlines() if line.startswith("| ")]
    cells = {len(re.findall(r"(?<!\\)\|", line)) - 1 for line in rows}
    assert cells <= {5, 6}


def test_what_fails_stands_first_and_what_is_known_is_folded():
    """The verdict, then a table of what fails the run, worst first, then margins; known failures with their reason."""
    content = comment(run_of((PASSED, FAILED), (KNOWN, WORSE), (UNJUDGED,)), 60_000)
    assert content.startswith("### ? Grid code: NOT EVALUATED\n")
    places = [content.index(text) for text in ("3 verdicts fail the run", "Least margins", "<details>", "1 known fail")]
    assert places == sorted(places)
    rows = [line for line in content.splitlines() if line.startswith("| t")]
    assert [row.split(" | ")[0:3] for row in rows[1:4]] == [
        ["| t2", "oscillation", "not evaluated"],
        ["| t0", "reactive\\_support", "fail"],
        ["| t1", "ride\\_through", "pass (worse)"],
    ]
    assert "known failure: waits for the new filter" in content[content.index("<details>") :]


def test_a_green_run_says_so_in_short():
    """No table of failures; with known ones it says how many."""
    assert comment(run_of((PASSED, IDLE)), 60_000).splitlines()[:3] == [
        "### ✓ Grid code: PASS",
        "",
        "PASS: 1 test; checks: 1 pass, 1 not applicable",
    ]
    known = comment(run_of((PASSED,), (KNOWN,)), 60_000)
    assert known.splitlines()[0] == "### ✓ Grid code: nothing worse than the baseline (1 known failure)"
    several = comment(run_of((PASSED,), (KNOWN,), (KNOWN, IDLE)), 60_000)
    assert several.splitlines()[0] == "### ✓ Grid code: nothing worse than the baseline (2 known failures)"


@given(
    tests=st.lists(
        st.lists(st.sampled_from([PASSED, FAILED, KNOWN, WORSE, UNJUDGED, BROKEN, IDLE]), min_size=1, max_size=3),
        min_size=1,
        max_size=3,
    ),
    allowed=st.booleans(),
)
def test_no_page_contradicts_its_head(tests, allowed):
    """Whatever was found, page, line of summary and annotation begin with what the exit status goes by."""
    results = run_of(*map(tuple, tests), allow_unjudged=allowed)
    word = {0: "PASS", 1: "FAIL"}.get(exit_status(results), results.status.value.replace("_", " ").upper())
    head, _, line, *_ = comment(results, 60_000).splitlines()
    said = head.partition("Grid code: ")[2]
    if said.startswith("nothing worse than the baseline"):
        said = "PASS"
    assert said == word
    for summary in (line, list(github.annotations(results))[-1].partition("::")[2].partition("::")[2]):
        assert re.match(rf"{word}(:| by --)", summary)
        others = {"PASS", "FAIL", "ERROR", "NOT EVALUATED"} - {word}
        assert not any(other in summary for other in others)


@pytest.mark.parametrize("room", [1_000, 5_000, 64_000])
@pytest.mark.parametrize("count", [1, 50, 500])
def test_a_page_is_never_longer_than_there_is_room(room, count):
    """As many rows as fit, never a part of one, and how many are left out; folded parts end before the page does."""
    long = "ö" * 500
    tests = [
        (*(each.model_copy(update={"message": f"{k} {long}", "known_reason": f"{k} {long}"}) for each in both), PASSED)
        for k, both in enumerate([(FAILED, KNOWN)] * count)
    ]
    content = comment(run_of(*tests), room)
    assert len(content.encode()) <= room
    assert content.count("<details>") == content.count("</details>")
    shown = sum(line.startswith("| t") and "| fail" in line for line in content.splitlines())
    assert shown == 2 * count or "more: report.html has all of them." in content


def test_a_comment_is_one_that_github_takes():
    """Of the worst run that there can be it stays below 65,536 characters."""
    bad = [(FAILED.model_copy(update={"message": f"{k}{'&' * 5_000}"}),) for k in range(500)]
    assert len(markdown.render(run_of(*bad))) < 65_536
