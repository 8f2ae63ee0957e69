"""The first page: what was tested against what, and what its verdict rests on."""

import datetime

import pytest

from pvlvrt_compliance.report.document.front import front, margin_in_words
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import ProfileSummary, ReportDetails, Status, TestResult, Verdict, conclude
from pvlvrt_compliance.results.profile import AppliesToSummary
from pvlvrt_compliance.results.results import Rating

PASS, FAIL = Status.PASS, Status.FAIL


def _verdict(check, margin, status=PASS, **fields):
    return Verdict(check=check, status=status, limit=1.0, measured=1.0 - margin, margin=margin, unit="pu", **fields)


def _test(name, *checks, **fields):
    return TestResult(id=name, status=min((c.status for c in checks), key=list(Status).index), checks=checks, **fields)


def _facts(facts):
    return {fact.name: fact.text for fact in facts}


def _front(*tests, profiles=(), provenance=None, language="en", **fields):
    report = ReportDetails(language=language, fields=fields)
    return front(conclude(tests, profiles, provenance, report=report), Texts(language))


def test_the_worst_margin_of_each_check_nearest_first():
    """Of sister runs that fail alike one is told, so that every check that has a margin comes to word."""
    tests = [_test(f"t{n}", _verdict("a", -0.5, FAIL), _verdict("b", 0.1 * n)) for n in (1, 2, 3)]
    assert [(p.verdict.check, p.number) for p in _front(*tests).worst] == [("a", 1), ("b", 1)]
    many = _test("t", *(_verdict(f"c{n}", 0.1 * n) for n in reversed(range(9))), Verdict(check="none", status=PASS))
    assert [p.verdict.check for p in _front(many).worst] == [f"c{n}" for n in range(9)]


@pytest.mark.parametrize(
    ("margin", "fields", "told"),
    [
        (-0.0456, {}, "margin -0.046 pu, -4.6 % of the limit"),
        (-13.0, {}, "margin -13.000 pu, -1300 % of the limit"),
        (0.5, {"limit": None, "measured": None}, "margin +0.500 pu"),
    ],
)
def test_a_margin_is_told_with_its_share(margin, fields, told):
    """One decimal of a percent, none from the whole limit on; without a limit there is no share."""
    assert margin_in_words(_verdict("a", margin).model_copy(update=fields), Texts()) == told


def test_failed_tests_are_those_with_a_failure_or_an_error():
    """By their number in the report."""
    broken = TestResult(id="broken", status=Status.ERROR)
    assert _front(_test("a", _verdict("x", 0.1)), _test("b", _verdict("x", -1, FAIL)), broken).failed == (2, 3)


def test_what_was_tested_is_identified():
    """Fields of the device, the rating with all frequencies, the controller with its kind, file and digest."""
    rating = Rating(apparent_power_kva=500, phase_voltage_v=230, frequency_hz=50)
    tests = [
        _test(f"t{hz}", _verdict("x", 0.1), rating=rating.model_copy(update={"frequency_hz": hz})) for hz in (60, 50)
    ]
    own = {"controller": "./lib.so", "controller_name": "PV 7", "controller_kind": "c", "controller_digest": "abc"}
    found = _front(*tests, provenance=own, serial="7", firmware="4.2", client="Solar", logo="x")
    assert _facts(found.tested) == {
        "serial number": "7",
        "firmware": "4.2",
        "plant": "PV inverter, 500 kVA, 230 V phase to neutral, 50, 60 Hz",
        "controller": "PV 7",
        "its interface": "c",
        "its file": "./lib.so",
        "digest of the controller": "abc",
    }
    assert _facts(found.document) == {"client": "Solar"}
    assert found.logo == ""
    bundled = {"controller": "bundled", "controller_digest": "d1", "versions": {"pvlvrt-compliance": "9.8"}}
    told = _facts(_front(*tests, provenance=bundled).tested)
    assert "9.8" in told["controller"]
    record = _facts(_front(*tests, provenance={"record": "field.csv", "record_digest": "e2"}).tested)
    assert (record["record"], record["digest of the record"]) == ("field.csv", "e2")


def test_a_code_is_told_with_its_edition():
    """What the profile knows of its text, and nothing where it knows nothing."""
    known = ProfileSummary(
        id="p",
        title="The code",
        digest="0123456789abcdef0123",
        edition="v2.0",
        jurisdiction="Spain",
        applies_to=AppliesToSummary(plant="PV plants", power="above 0.1 MW"),
        read_on=datetime.date(2024, 5, 6),
    )
    (code,) = _front(_test("t", _verdict("x", 0.1)), profiles=[known]).against
    assert code.title == "The code"
    assert _facts(code.facts) == {
        "edition": "v2.0",
        "in force in": "Spain",
        "applies to": "PV plants",
        "power": "above 0.1 MW",
        "read on": "2024-05-06",
        "profile": "p",
        "digest": "0123456789abcdef",
    }


@pytest.mark.parametrize("language", ["en", "es"])
def test_the_scope_is_of_what_was_done(language):
    """An averaged model, a switched one and a record say different things of themselves."""
    told = [
        _front(_test("t", _verdict("x", 0.1)), provenance=provenance, language=language).scope
        for provenance in (
            {"parameters": {"simulation": {"fidelity": "averaged"}}},
            {"parameters": {"simulation": {"fidelity": "switched"}}},
            {"record": "field.csv"},
        )
    ]
    assert len({sentences[1] for sentences in told}) == 3
    assert len({(sentences[0], sentences[2]) for sentences in told}) == 1


def test_the_run_as_a_whole_is_spoken_of():
    """That nothing was judged, and as what it counts, stand beside the verdict."""
    unjudged = _test("t", Verdict(check="x", status=Status.NOT_EVALUATED))
    assert _front(unjudged).on_the_run == (Texts()("front.nothing_judged"),)
    both = conclude([unjudged, _test("s", _verdict("y", 0.1))], allow_unjudged=True)
    assert front(both, Texts()).on_the_run == ("Counts as pass (--allow-unjudged).",)
