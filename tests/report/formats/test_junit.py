import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from pvlvrt_compliance.report.formats import junit
from pvlvrt_compliance.results import Status, TestResult, Verdict, conclude, exit_status, worst

SCHEMA = etree.XMLSchema(etree.parse(Path(__file__).parents[2] / "schemas" / "junit-10.xsd"))

texts = st.text(max_size=30)
checks = st.builds(
    Verdict,
    check=texts,
    status=st.sampled_from(Status),
    measured=st.none() | st.floats(allow_nan=False, allow_infinity=False),
    message=texts,
    clause=texts,
)


@st.composite
def runs(draw):
    """Runs with arbitrary names and verdicts."""
    tests = []
    for name, found in draw(st.lists(st.tuples(texts, st.lists(checks, max_size=4)), max_size=4)):
        status = worst(check.status for check in found)
        length_s = draw(st.floats(0, 4000))
        tests.append(TestResult(id=name, profile=draw(texts), status=status, checks=found, duration_s=length_s))
    return conclude(tests, allow_unjudged=draw(st.booleans()))


@given(results=runs())
def test_valid_whatever_the_names_say(results):
    """Every run gives XML that the schema accepts, with each case named once and the totals of its cases."""
    root = etree.fromstring(junit.render(results))
    SCHEMA.assertValid(root)
    names = [(case.get("classname"), case.get("name")) for case in root.iter("testcase")]
    assert len(names) == len(set(names)) == int(root.get("tests"))
    for total, tag in (("failures", "failure"), ("errors", "error")):
        assert int(root.get(total)) == len(list(root.iter(tag)))
    assert not list(root.iterfind(".//testcase/properties"))


def test_names_and_outcomes(make_test, make_results):
    """A case is `<profile>.<test>` and the check; a failure carries message and numbers."""
    root = ET.fromstring(junit.render(make_results(make_test("VD3-full-1", Status.FAIL))))
    cases = {case.get("name"): case for case in root.iter("testcase")}
    assert {case.get("classname") for case in cases.values()} == {"iec61400-21.VD3-full-1"}
    failure = cases["reactive_support"].find("failure")
    assert failure.get("message") == "mean reactive power 156.5 kvar is 4.2 kvar below the curve at 0.700 pu"
    assert "margin -4.2 kvar" in failure.text
    assert "clause eq (9)" in failure.text
    assert cases["dc_ripple"].find("skipped").get("message").startswith("the window during the sag")
    (record,) = root.iterfind("testsuite/properties/property[@name='record_s']")
    assert record.get("value") == "1.709"
    assert "record 1.709 s" in failure.text


@pytest.mark.parametrize(
    ("given_text", "read"), [("a\x00b\x1bc", r"a\x00b\x1bc"), ("\ud800", r"\ud800"), ("1 < 2 & ü", "1 < 2 & ü")]
)
def test_characters_that_xml_cannot_hold_are_spelled(given_text, read):
    """A message with control characters still is a readable file."""
    check = Verdict.model_construct(
        check="x",
        status=Status.FAIL,
        message=given_text,
        **dict.fromkeys(["measured", "limit", "margin", "at_s"]),
        unit="",
        clause="",
        confidence="",
    )
    test = TestResult.model_construct(**(TestResult(id="t", status=Status.FAIL).__dict__ | {"checks": (check,)}))
    root = ET.fromstring(junit.render(conclude([test])))
    assert root.find(".//failure").get("message") == read


@pytest.mark.parametrize("allowed", [False, True])
def test_what_could_not_be_judged(allowed):
    """It is an error, and with the option skipped, with its reason either way; an error stays one."""
    found = (Status.PASS, Status.NOT_EVALUATED, Status.ERROR)
    checks = tuple(Verdict(check=status, status=status, message=f"why {status}") for status in found)
    tests = [TestResult(id="t", status=Status.ERROR, checks=checks)]
    root = ET.fromstring(junit.render(conclude(tests, allow_unjudged=allowed)))
    unjudged = root.find(".//testcase[@name='not_evaluated']")[0]
    assert unjudged.tag == ("skipped" if allowed else "error")
    assert (unjudged.get("type"), unjudged.get("message")) == ("not_evaluated", "why not_evaluated")
    assert root.find(".//testcase[@name='error']/error") is not None
    assert root.get("errors") == ("1" if allowed else "2")
    assert root.find("testsuite").get("skipped") == ("1" if allowed else "0")
    SCHEMA.assertValid(etree.fromstring(junit.render(conclude(tests, allow_unjudged=allowed))))


@pytest.mark.parametrize("allowed", [False, True])
@pytest.mark.parametrize("found", [(), (Status.NOT_APPLICABLE,), (Status.NOT_EVALUATED,)], ids=str)
def test_a_run_in_which_nothing_was_judged_is_not_green(found, allowed):
    """Where no case is an error the run has one, so that a reader of the file and of the exit status agree."""
    tests = [TestResult(id="t", status=x, checks=(Verdict(check="c", status=x),)) for x in found]
    results = conclude(tests, allow_unjudged=allowed)
    root = etree.fromstring(junit.render(results))
    SCHEMA.assertValid(root)
    assert root.get("errors") == "1"
    (error,) = root.iter("error")
    assert exit_status(results) == 3
    of_the_run = found != (Status.NOT_EVALUATED,) or allowed
    assert (error.get("message") == "nothing was judged: no requirement passed or failed") is of_the_run
    assert int(root.get("tests")) == len(list(root.iter("testcase"))) == len(found) + of_the_run


def test_what_passed_has_its_numbers(make_test, make_results):
    """A passed case is empty but for what was measured against which limit."""
    root = ET.fromstring(junit.render(make_results(make_test())))
    (said,) = root.find(".//testcase[@name='reactive_support']")
    assert said.tag == "system-out"
    assert "measured 235.7 kvar; limit 160.7 kvar; margin +75.0 kvar" in said.text
