"""What the file says to readers that are not ours: junitparser, and GitLab's rules."""

import io
import xml.etree.ElementTree as ET

import junitparser
import pytest

from pvlvrt_compliance.report.formats import junit
from told import BROKEN, FAILED, IDLE, KNOWN, PASSED, UNJUDGED, WORSE, run_of, test_of


def read(results):
    """The file as an independent reader takes it."""
    return junitparser.JUnitXml.fromfile(io.BytesIO(junit.render(results)))


def test_an_independent_reader_counts_the_same():
    """It finds each outcome, by its own count of the cases and in the totals as they are written."""
    found = read(run_of((PASSED, FAILED, KNOWN, WORSE), (UNJUDGED, BROKEN, IDLE)))
    assert (found.tests, found.failures, found.errors, found.skipped) == (7, 2, 2, 2)
    found.update_statistics()
    assert (found.tests, found.failures, found.errors, found.skipped) == (7, 2, 2, 2)
    cases = [case for suite in found for case in suite]
    assert [case.is_passed for case in cases] == [True, False, False, False, False, False, False]
    assert [case.is_skipped for case in cases] == [False, False, True, False, False, False, True]


@pytest.mark.parametrize("wall_time_s", [0.0, 0.001, 0.5, 12.3456])
def test_times_of_cases_add_up_to_those_of_suites(wall_time_s):
    """Whoever adds up cases, suites, or reads the total gets the wall time of the tests, to the millisecond."""
    tests = [test_of(f"t{k}", *[PASSED] * k, wall_time_s=wall_time_s, duration_s=1000.0) for k in (1, 3, 7)]
    found = read(run_of(*tests))
    assert found.time == pytest.approx(3 * round(wall_time_s, 3))
    for suite in found:
        assert suite.time == pytest.approx(round(wall_time_s, 3))
        assert sum(case.time for case in suite) == pytest.approx(suite.time)


def test_the_length_of_the_record_is_no_time():
    """What was simulated is told in words, and as a property of the suite."""
    (suite,) = read(run_of(test_of("t", PASSED, FAILED, duration_s=1.709, wall_time_s=0.25)))
    assert suite.time == 0.25
    assert {each.name: each.value for each in suite.properties()}["record_s"] == "1.709"
    texts = [each.text for case in suite for each in case.result] + [case.system_out for case in suite]
    assert sum("record 1.709 s" in (text or "") for text in texts) == 2


@pytest.mark.parametrize("verdict", [FAILED, KNOWN, UNJUDGED, BROKEN, IDLE], ids=lambda each: each.status)
def test_gitlab_shows_the_reason(verdict):
    """GitLab takes the text of what has one and leaves its message aside: the text has the reason, too."""
    root = ET.fromstring(junit.render(run_of((verdict, PASSED))))
    (found,) = root.find(f"testsuite/testcase[@name='{verdict.check}']")
    assert found.text.startswith(found.get("message"))


def test_what_the_baseline_knows_is_skipped_with_its_reason():
    """The message is the reason; what has failed, and by how much, stands in the text."""
    (skipped,) = ET.fromstring(junit.render(run_of((KNOWN,)))).iter("skipped")
    assert skipped.get("message") == "known failure: waits for the new filter"
    assert FAILED.message in skipped.text
    assert "margin -10.0 kvar" in skipped.text
    assert skipped.get("type") == "known_failure"


def test_what_is_worse_is_a_failure_of_its_own_type():
    """A margin that was lost fails a case that has passed."""
    (failure,) = ET.fromstring(junit.render(run_of((WORSE,)))).iter("failure")
    assert failure.get("type") == "worse"
    assert "+0.300 s in the baseline" in failure.get("message")
