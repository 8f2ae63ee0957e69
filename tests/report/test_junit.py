import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from pvlvrt_compliance.report import junit
from pvlvrt_compliance.results import Status, TestResult, Verdict, conclude, worst

SCHEMA = etree.XMLSchema(etree.parse(Path(__file__).parents[1] / "schemas" / "junit-10.xsd"))

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
    return conclude(tests)


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
    assert root.find("testsuite").get("time") == "1.709"


@pytest.mark.parametrize(
    ("given_text", "read"), [("a\x00b\x1bc", "a\ufffdb\ufffdc"), ("\ud800", "\ufffd"), ("1 < 2 & ü", "1 < 2 & ü")]
)
def test_characters_that_xml_cannot_hold_are_replaced(given_text, read):
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
