"""Every format copes with whatever a verdict may hold, and says all of it."""

import io
import json
import re
import xml.etree.ElementTree as ET

import lxml.html
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from draws import draws
from pvlvrt_compliance.checks.check import decisive
from pvlvrt_compliance.report import console
from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.formats import html, junit, results_json
from pvlvrt_compliance.results import Results, Status, TestResult, Verdict, conclude, worst

UNITS = ("kvar", "pu", "s", "%", "", "furlong")
STRETCH = "second sag, 0.20 pu, 1.10 s to 1.35 s"

numbers = st.none() | st.floats(-1e6, 1e6, allow_nan=False)
verdicts = st.builds(
    Verdict,
    check=st.sampled_from(["ride_through", "current_limit", "active_power_recovery"]),
    status=st.sampled_from(Status),
    measured=numbers,
    limit=numbers,
    margin=numbers,
    at_s=numbers,
    unit=st.sampled_from(UNITS),
    bound=st.sampled_from([None, "at_least", "at_most", "band"]),
    tolerance=st.sampled_from([0.0, 0.02, 8.8]),
    uncertainty=st.none() | st.sampled_from([0.0, 0.005, 2.5]),
    stretch=st.sampled_from(["", STRETCH]),
    message=st.sampled_from(["", "said", f"{STRETCH}: said"]),
)


def _terminal(results, width=80):
    out = io.StringIO()
    Console(file=out, width=width).print(console.render(results))
    return out.getvalue()


def _case(results):
    return ET.fromstring(junit.render(results)).find(".//testcase")


def _run(*checks, **fields):
    test = TestResult(id="t", status=worst(check.status for check in checks), checks=checks, **fields)
    return conclude([test])


@draws(60)
@given(
    found=st.lists(st.lists(verdicts, min_size=1, max_size=3), min_size=1, max_size=3),
    expect=st.sampled_from([None, "ride_through", "may_trip", "must_trip"]),
)
@pytest.mark.slow
def test_any_number_may_be_missing(found, expect):
    """Whatever is None, all formats are written, agree on what is marginal, and nothing reads `None` or is cut."""
    tests = [
        TestResult(id=f"t{k}", expect=expect, status=worst(c.status for c in checks), checks=checks)
        for k, checks in enumerate(found)
    ]
    results = conclude(tests)
    text, page, xml = _terminal(results, 200), html.render(results, {}), junit.render(results)
    assert "None" not in text + page.split("</style>")[1] + xml.decode()
    assert "…" not in text
    assert Results.model_validate_json(results_json.render(results)) == results
    count = sum(check.is_marginal for checks in found for check in checks)
    rows = lxml.html.document_fromstring(page).xpath("//tr[@data-check]")
    assert sum(row.get("data-marginal") is not None for row in rows) == count
    assert sum("marginal; " in "".join(case.itertext()) for case in ET.fromstring(xml).iter("testcase")) == sum(
        check.is_marginal for checks in found for check in checks
    )
    assert text.count("(marginal)") == count
    written = json.loads(results_json.render(results))
    assert [c["marginal"] for t in written["tests"] for c in t["checks"]] == [c.is_marginal for cs in found for c in cs]


@given(found=st.lists(verdicts, min_size=1, max_size=6))
def test_the_decisive_verdict_is_the_worst(found):
    """None is worse by status; of failed ones, one without a margin comes before all, then the least margin.

    Of margins that are equal within rounding, which is a part of the limits' size, the first is taken.
    """
    chosen = decisive(found)
    assert chosen.status is worst(check.status for check in found)
    alike = [check.margin for check in found if check.status is chosen.status]
    if chosen.status is Status.FAIL and None in alike:
        assert chosen.margin is None
    elif any(margin is not None for margin in alike):
        rounding = 1e-9 * max(abs(check.limit or 0.0) for check in found if check.status is chosen.status)
        assert 0 <= chosen.margin - min(margin for margin in alike if margin is not None) <= rounding


def _recomputed(bound, measured, limit, tolerance):
    """What the kind of a limit means, written a second time."""
    if bound == "at_least":
        return measured - (limit - tolerance)
    return limit + tolerance - (measured if bound == "at_most" else abs(measured))


@given(
    bound=st.sampled_from(["at_least", "at_most", "band"]),
    measured=st.floats(-600, 600),
    limit=st.floats(0, 600),
    tolerance=st.sampled_from([0.0, 0.02, 8.8, 12.5]),
    unit=st.sampled_from(["kvar", "pu", "s"]),
)
def test_a_reader_recomputes_the_margin(bound, measured, limit, tolerance, unit):
    """From the words and from the signs, to the last digit shown; what is shown is the margin but for rounding."""
    margin = _recomputed(bound, measured, limit, tolerance)
    status = Status.PASS if margin >= 0 else Status.FAIL
    check = Verdict(
        check="x",
        status=status,
        measured=measured,
        limit=limit,
        tolerance=tolerance,
        margin=margin,
        unit=unit,
        bound=bound,
    )
    shown = spell.row(check)
    decimals = len(spell.bare(shown.measured).partition(".")[2])
    words = spell.limit_in_words(check)
    kind, of_limit, of_tolerance = re.fullmatch(
        rf"(at least |at most |within ±)([-.\d]+) {unit}(?:, tolerance ([-.\d]+))?", words
    ).groups()
    assert {"at least ": "at_least", "at most ": "at_most", "within ±": "band"}[kind] == bound
    told = _recomputed(bound, float(spell.bare(shown.measured)), float(of_limit), float(of_tolerance or 0))
    # All but the last bits of binary fractions: the last digit shown is the same.
    assert told == pytest.approx(float(spell.bare(shown.margin)), abs=10 ** -(decimals + 3))
    assert abs(told - margin) <= 1.51 * 10**-decimals
    signs = spell.limit_in_signs(check)
    assert signs.isascii()
    assert signs.startswith({"at_least": ">=", "at_most": "<=", "band": "+-"}[bound])
    if of_tolerance and bound != "band":
        assert signs[2:] == f"{of_limit}{'-' if bound == 'at_least' else '+'}{of_tolerance}"


@pytest.mark.parametrize(
    ("fidelity", "measured", "status"), [("averaged", 1.023, Status.FAIL), ("switched", 1.017, Status.PASS)]
)
def test_a_verdict_that_flips_with_the_fidelity_is_marginal_in_both(fidelity, measured, status):
    """30 % at SCR 3: 3 mpu beyond the limit averaged, 3 within it switched; both say so, and what may decide."""
    margin = 1.02 - measured
    check = Verdict(
        check="current_limit",
        status=status,
        measured=measured,
        limit=1.0,
        tolerance=0.02,
        margin=margin,
        uncertainty=0.005,
        unit="pu",
        bound="at_most",
        stretch=STRETCH,
    )
    test = TestResult(id="sag-30pct", status=status, checks=(check,))
    results = conclude([test], provenance={"parameters": {"simulation": {"fidelity": fidelity}}})
    text = " ".join(_terminal(results).split())
    assert f"{status} (marginal)" in text
    assert "marginal: 1 verdict is nearer to the limit than the uncertainty" in text
    assert f"current_limit in sag-30pct, {STRETCH}: margin {margin:+.3f} pu, uncertainty 0.005 pu" in text
    assert console.summary_line(results).endswith("; 1 marginal")
    page = lxml.html.document_fromstring(html.render(results, {}))
    badge = page.xpath("//tr[@data-check]//span[contains(@class, 'badge marginal')]")[0].text_content()
    assert " ".join(badge.split()) == f"≈ marginal: margin {margin:+.3f} pu, uncertainty 0.005 pu"
    top = " ".join(page.find(".//header").text_content().split())
    assert "1 ≈ marginal" in top
    case = _case(results)
    assert "".join(case.itertext()).strip().startswith("marginal; measured")
    assert "limit at most 1.000 pu, tolerance 0.020" in "".join(case.itertext())
    assert f"stretch {STRETCH}" in "".join(case.itertext())
    for told in (text, top):
        assert ("--fidelity switched may decide" in told) is (fidelity == "averaged")


def test_connection_demanded_throughout_has_no_limit():
    """A trip after clearing fails without limit and margin; every format says what was demanded."""
    check = Verdict(check="ride_through", status=Status.FAIL, measured=0.837, unit="s", bound="at_least")
    results = _run(check)
    assert re.search(r"ride_through +0\.837 s +throughout +fail", _terminal(results))
    row = lxml.html.document_fromstring(html.render(results, {})).xpath("//tr[@data-check='ride_through']")[0]
    assert "throughout" in row.text_content()
    assert "limit throughout" in _case(results).find("failure").text
    assert spell.limit_in_words(Verdict(check="x", status=Status.NOT_APPLICABLE, bound="at_least")) == ""


def test_what_a_row_demands_is_told():
    """A row that may trip says so beside its verdicts."""
    check = Verdict(check="x", status=Status.PASS)
    results = conclude(_run(check, expect=expect).tests[0] for expect in ("may_trip", None))
    assert "may trip" in _terminal(results)
    page = lxml.html.document_fromstring(html.render(results, {}))
    told = [section.text_content() for section in page.xpath("//div[@class='scenario']")]
    assert ["the inverter may let go" in text for text in told] == [True, False]
    assert [p.get("value") for p in ET.fromstring(junit.render(results)).iterfind(".//property[@name='expect']")] == [
        "may_trip"
    ]


@pytest.mark.parametrize("name", ["current_limit", "phase_jump_ride_through"])
@pytest.mark.parametrize("marginal", [False, True])
@pytest.mark.parametrize("tests", [1, 2])
def test_nothing_is_cut_at_80_columns(name, marginal, tests):
    """Long names, wide numbers, tolerances and marginal verdicts still leave every number and mark whole."""
    check = Verdict(
        check=name,
        status=Status.FAIL,
        measured=-160.7,
        limit=-160.7,
        tolerance=8.8,
        margin=-12.5,
        uncertainty=25.0 if marginal else None,
        unit="kvar",
        bound="at_least",
        clause="paper eq (9)",
        confidence="memory-low",
    )
    made = [TestResult(id=f"VD{k}", status=Status.FAIL, checks=(check,)) for k in range(tests)]
    text = _terminal(conclude(made))
    assert max(map(len, text.splitlines())) <= 80
    assert "…" not in text
    for piece in (name, "-160.7 kvar", ">=-160.7-8.8", "-12.5", "fail", "memory-low"):
        assert piece in text
    assert ("(marginal)" in text) is marginal
