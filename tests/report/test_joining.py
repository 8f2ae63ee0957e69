"""One reason is read once: a crash that cost many verdicts is no many things to read."""

from pvlvrt_compliance.pytest_plugin.words import reasons, red_in_words
from pvlvrt_compliance.report.document.comment import comment
from pvlvrt_compliance.report.formats import github
from pvlvrt_compliance.report.gate import Outcome, numbers_in_words, told
from pvlvrt_compliance.report.joining import count, few, joined
from pvlvrt_compliance.report.verdicts import findings
from runner import commands
from told import BROKEN, FAILED, KNOWN, PASSED, UNJUDGED, run_of

KINDS = ("a", "b", "c", "d", "e", "f", "g")
CRASH = tuple(BROKEN.model_copy(update={"check": kind, "clause": f"clause {kind}"}) for kind in KINDS)
CRASHES = run_of(CRASH, CRASH, CRASH, CRASH, (FAILED,))


def test_a_crash_leaves_room_for_what_else_there_is():
    """Of 28 errors by one reason and another failure the runner shows both, and the first says how many it is."""
    crash, failure, last = commands("\n".join(github.annotations(CRASHES)))
    assert crash.properties["title"] == "my-code.t0, my-code.t1, my-code.t2 and 1 more a, b, c and 4 more"
    assert crash.message.splitlines() == [
        BROKEN.message,
        "28 verdicts: a, b, c, d, e, f, g of my-code.t0, my-code.t1, my-code.t2, my-code.t3",
    ]
    assert failure.properties["title"] == "my-code.t4 reactive_support"
    assert "28 error" in last.message
    assert "more are in the reports" not in last.message


def test_what_is_left_out_is_counted_in_verdicts():
    """Ten crashes of seven verdicts each: nine are shown, and seven verdicts more are told."""
    crashes = [tuple(each.model_copy(update={"message": f"{k}: {each.message}"}) for each in CRASH) for k in range(10)]
    *shown, last = commands("\n".join(github.annotations(run_of(*crashes))))
    assert len(shown) == 9
    assert last.message.endswith("; 7 more are in the reports")


def test_a_page_has_a_row_a_reason():
    """And counts verdicts."""
    page = comment(CRASHES, 64_000)
    assert "**29 verdicts fail the run**" in page
    rows = [line for line in page.splitlines() if line.startswith("| t")]
    assert rows[0].startswith("| test |")
    assert rows[1] == f"| t0, t1, t2 and 1 more | a, b, c and 4 more | error |   |   | {BROKEN.message} |"
    assert len(rows) == 3


def test_pytest_has_a_reason_once():
    """With the names of all that it is of; what they do not have in common is not told of all."""
    assert red_in_words(told(run_of((*CRASH, FAILED)))).splitlines() == [
        "a, b, c and 4 more error, reactive_support fail",
        f"my-code.t0, a, b, c, d, e, f, g: {BROKEN.message}",
        f"my-code.t0, reactive_support: {FAILED.message}",
        "    measured 40.0 kvar; limit at least 50.0 kvar; margin -10.0 kvar; clause eq (9)",
    ]
    others = [each.model_copy(update={"check": kind}) for each in (KNOWN, UNJUDGED) for kind in "ab"]
    said = reasons(told(run_of((PASSED, *others), allow_unjudged=True)), Outcome.SKIPPED)
    assert said == f"a, b: known failure: {KNOWN.known_reason}; a (2), b (2): {UNJUDGED.message}"


def test_joined_as_the_terminal_does():
    """What the terminal joins by reason is joined here, as far as the numbers are the same."""
    results = run_of(CRASH, CRASH, (FAILED, UNJUDGED), (FAILED,))
    of_terminal = {(finding.tests, finding.checks) for finding in findings(results)}
    groups = joined(each for each in told(results) if each.outcome is not Outcome.PASSED)
    assert {(tuple(test.id for test in group.tests), group.names) for group in groups} == of_terminal
    assert count(groups) == 17


def test_other_numbers_are_read_for_themselves():
    """Verdicts whose numbers differ stay apart, though they say the same."""
    other = FAILED.model_copy(update={"measured": 41.0, "margin": -9.0})
    assert [len(group.members) for group in joined(told(run_of((FAILED,), (other,), (FAILED,))))] == [2, 1]
    assert numbers_in_words(FAILED, other) == "limit at least 50.0 kvar; clause eq (9)"


def test_few():
    """The first of many names, with how many there are besides."""
    assert (few(["a"]), few(list("abcd")), few(list("abcd"), 4)) == ("a", "a, b, c and 1 more", "a, b, c, d")
