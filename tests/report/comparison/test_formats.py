"""A comparison as table, Markdown, JUnit and page: all say what the one object says."""

import io
import xml.etree.ElementTree as ET
from pathlib import Path

import lxml.html
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from rich.console import Console

from draws import draws
from pvlvrt_compliance.report.comparison import console, html, junit, markdown
from pvlvrt_compliance.report.comparison.words import share
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import ProfileSummary, Status, TestResult, Verdict, conclude, worst
from pvlvrt_compliance.results.comparison import Comparison, compare, comparison_status

SCHEMA = etree.XMLSchema(etree.parse(Path(__file__).parents[2] / "schemas" / "junit-10.xsd"))

texts = st.text(max_size=12)
verdicts = st.builds(
    Verdict,
    check=texts,
    status=st.sampled_from(Status),
    margin=st.none() | st.floats(-9, 9),
    limit=st.just(10.0),
    unit=st.sampled_from(["kW", "pu"]),
    message=texts,
)
tests = st.builds(
    lambda name, checks: TestResult(id=name, status=worst(c.status for c in checks), checks=checks),
    texts,
    st.lists(verdicts, max_size=3),
)
runs = st.builds(conclude, st.lists(tests, max_size=3, unique_by=lambda test: test.id))
comparisons = st.builds(compare, runs, runs, names=st.tuples(texts, texts))


def made_of(name, *statuses, margin=1.0):
    """A test with a verdict of each status."""
    checks = tuple(
        Verdict(check=f"check_{n}", status=status, margin=margin, limit=10.0, unit="kW", message=f"{status} of {name}")
        for n, status in enumerate(statuses)
    )
    return TestResult(id=name, profile="code", status=worst(statuses), checks=checks)


def run(*found, digest="a" * 16, **provenance):
    """A run of these tests against one profile."""
    return conclude(found, profiles=[ProfileSummary(id="code", title="", digest=digest)], provenance=provenance)


@pytest.fixture
def changed() -> Comparison:
    """One of each kind: worse, better, lost, gained, gone, added, no longer judged, and a profile that has changed."""
    passing, failing = Status.PASS, Status.FAIL
    old = run(
        made_of("worse", passing, passing),
        made_of("better", failing),
        made_of("lost", passing),
        made_of("gained", passing),
        made_of("gone", passing, failing),
        made_of("unjudged", passing),
        parameters={"controller": {"gain": 1.0}},
    )
    new = run(
        made_of("worse", failing, passing),
        made_of("better", passing),
        made_of("lost", passing, margin=0.5),
        made_of("gained", passing, margin=2.0),
        made_of("unjudged", Status.ERROR),
        made_of("added", passing, failing),
        digest="b" * 16,
        parameters={"controller": {"gain": 2.0}},
    )
    return compare(old, new, names=("main", "branch"))


def shown(renderable, width):
    """What a console of this width shows."""
    written = io.StringIO()
    Console(width=width, file=written, color_system=None, highlight=False, markup=False).print(renderable)
    return written.getvalue()


@draws(40)
@given(comparisons)
def test_junit_is_valid_whatever_the_names_say(comparison):
    """A case a verdict of either run, each named once; failures and errors are what the exit status goes by."""
    root = etree.fromstring(junit.render(comparison))
    SCHEMA.assertValid(root)
    cases = [(case.get("classname"), case.get("name")) for case in root.iter("testcase")]
    assert len(cases) == len(set(cases)) == int(root.get("tests"))
    assert len(cases) == len(comparison.changes) + comparison.unchanged_count + (not comparison.in_both)
    failures, errors = (len(list(root.iter(tag))) for tag in ("failure", "error"))
    assert (failures, errors) == (int(root.get("failures")), int(root.get("errors")))
    assert comparison_status(comparison) == (3 if errors else 1 if failures else 0)


@pytest.mark.parametrize(
    ("lost", "said"),
    [(-26.3788, "+2640 %"), (3.6979, "-370 %"), (-0.75334, "+75.3 %"), (-0.0157, "+1.57 %"), (0.0, "+0.00 %")],
)
def test_a_share_has_three_digits_that_count(lost, said):
    """More of them nobody has measured, nor compares."""
    assert share(lost) == said


@draws(25)
@given(comparisons)
def test_every_format_takes_any_comparison(comparison):
    """No name and no number is one that cannot be shown."""
    assert shown(console.render(comparison), 80)
    assert markdown.render(comparison, Texts())


def test_a_regression_is_a_failure_in_junit(changed):
    """What can no longer be judged is an error, and says what was and what is."""
    root = ET.fromstring(junit.render(changed))
    cases = {(case.get("classname"), case.get("name")): case for case in root.iter("testcase")}
    failed = {key for key, case in cases.items() if case.find("failure") is not None}
    assert failed == {
        ("code.worse", "check_0"),
        ("code.gone", "check_0"),
        ("code.gone", "check_1"),
        ("code.added", "check_1"),
    }
    said = cases["code.worse", "check_0"].find("failure")
    assert said.get("message") == "pass before, fail now; margin +1.0 kW -> +1.0 kW (+0.00 % of the limit)"
    assert "old: pass; pass of worse" in said.text
    assert cases["code.unjudged", "check_0"].find("error") is not None
    assert "-5.00 % of the limit" in cases["code.lost", "check_0"].findtext("system-out")


def test_the_table_tells_every_change_at_80_columns(changed):
    """No line is longer, nothing is cut; whole tests that are gone or added stand once."""
    lines = shown(console.render(changed), 80).splitlines()
    assert max(map(len, lines)) <= 80
    text = " ".join(" ".join(lines).split())
    for part in (
        "worse verdicts (2)",
        "gone (2)",
        "added (2)",
        "margins lost (1)",
        "margins gained (1)",
        "better verd",
    ):
        assert part in text
    assert "! code.gone (2)" in text
    assert text.count("code.gone") == 1
    assert "…" not in text
    assert "parameters.controller.gain: 1 -> 2" in text
    assert "profile code: another content (digest aaaaaaaaaaaa -> bbbbbbbbbbbb); its limits may have moved" in text


def test_a_long_name_is_folded_not_cut():
    """A test's name that has no room goes on in the next line."""
    name = "a-very-long-name-of-a-test-" * 3
    comparison = compare(run(made_of(name, Status.PASS)), run(made_of(name, Status.FAIL)))
    text = shown(console.render(comparison), 80)
    assert "…" not in text
    assert name in text.replace("\n", "").replace(" ", "")


def test_markdown_tells_what_the_table_tells(changed):
    """Names stand as they are, whatever signs of Markdown are in them."""
    text = markdown.render(changed, Texts())
    assert text.startswith("### NO LONGER JUDGED (fail on verdict): 5 regressions")
    assert r"| code.worse | **check\_0** | pass | fail | +1.0 kW | +1.0 kW | +0.00 % |" in text
    assert "| **code.gone** | all 2 verdicts | fail |   |   |   |   |" in text
    assert "parameters.controller.gain: 1 -&gt; 2" in text
    odd = compare(run(made_of("a|b`c", Status.PASS)), run(made_of("a|b`c", Status.FAIL)))
    assert r"| code.a\|b\`c |" in markdown.render(odd, Texts())


def test_markdown_is_a_comment_however_much_has_changed():
    """GitHub takes 65,536 characters; what has no room is counted."""
    kinds = [(Status.PASS, Status.FAIL), (Status.FAIL, Status.PASS), (Status.PASS, Status.PASS)]
    old, new = (
        run(
            *(made_of(f"{'x' * 200}{n}{k}", pair[k], margin=1 + k * (n % 7)) for n in range(400) for pair in kinds[:1]),
            *(made_of(f"{'y' * 200}{n}", *(pair[k] for pair in kinds), margin=1 + k) for n in range(400)),
            parameters={f"{'p' * 200}{n}": k for n in range(99)},
        )
        for k in (0, 1)
    )
    text = markdown.render(compare(old, new), Texts())
    assert len(text.encode()) < 65_536
    assert "360 more in comparison.json" in text
    assert len(text.splitlines()) > 100


@pytest.mark.parametrize("language", ["en", "es"])
def test_the_page_has_every_change(changed, language):
    """One file without an address in it; regressions are marked in words, too, and each part has its heading."""
    page = lxml.html.document_fromstring(html.render(changed, {}, ["no waveforms"], Texts(language)))
    assert page.get("lang") == language
    rows = {(row.get("data-test"), row.get("data-check")) for row in page.iter("tr") if row.get("data-test")}
    told = {(one.test, one.check) for one in changed.changes if one.test not in ("code.gone", "code.added")}
    assert rows == told | {("code.gone", None), ("code.added", None), ("code.added", "check_1")}
    marked = [row for row in page.iter("tr") if "data-regression" in row.attrib]
    assert all(row.xpath(".//*[@class='unseen']") for row in marked)
    assert page.get_element_by_id("verdict").get("data-outcome") == "unjudged"
    assert not page.xpath("//*[@src or @href][not(starts-with(@href, '#'))]")
    assert "no waveforms" in page.text_content()


def test_nothing_that_has_changed_is_said():
    """Runs that are alike are told so in words."""
    alike = compare(run(made_of("a", Status.PASS)), run(made_of("a", Status.PASS)))
    assert "Nothing has changed." in html.render(alike, {}, [], Texts())
    assert "NO REGRESSION" in shown(console.render(alike), 80)


def test_text_of_a_result_is_text():
    """What stands in a foreign file is shown, and is no markup."""
    name = "<script>alert(1)</script>[bold]"
    odd = compare(run(made_of(name, Status.PASS)), run(made_of(name, Status.FAIL)), names=(name, name))
    assert "<script>alert" not in html.render(odd, {}, [name], Texts())
    assert "[bold]" in shown(console.render(odd), 200)
