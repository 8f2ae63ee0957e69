"""Annotations as GitHub's runner reads them, and that nothing else is read as one."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.report import workflow_commands
from pvlvrt_compliance.report.formats import github
from pvlvrt_compliance.texts import harmless
from runner import commands
from told import FAILED, KNOWN, PASSED, UNJUDGED, WORSE, run_of, test_of

ATTACK = "at 90 %25, a:b\r\n::set-output name=x::y\n  ::add-mask::z ##[set-env name=PATH]/bin"

anything = st.text(alphabet=st.sampled_from("a:#[]%\r\n \t,=0A25D\u00a0\u2028"), max_size=40) | st.text(max_size=40)


def annotations(results):
    """What the runner makes of a run."""
    return commands("\n".join(github.annotations(results)))


def test_what_fails_the_run_is_an_error_and_what_is_known_a_notice():
    """Each has the test and the check as its title, and its reason with all numbers as its message."""
    found = annotations(run_of((PASSED, FAILED), (KNOWN,), (WORSE, UNJUDGED)))
    assert [each.name for each in found] == ["error", "error", "error", "notice", "error"]
    titles = [each.properties["title"] for each in found]
    assert titles[:2] == ["my-code.t2 oscillation", "my-code.t0 reactive_support"]
    assert titles[3:] == ["my-code.t1 reactive_support", "Grid code"]
    assert found[1].message.splitlines()[0] == FAILED.message
    assert "margin -10.0 kvar" in found[1].message
    assert found[3].message.startswith("known failure: waits for the new filter\n")
    assert found[4].message.startswith("NOT EVALUATED: 3 tests; checks: 1 not evaluated, 2 fail (1 known), 2 pass")


@pytest.mark.parametrize("count", [0, 1, 9, 10, 300])
def test_github_shows_ten_of_a_kind(count):
    """Nine, and one on the run, which tells how many more there are; the nine are the worst."""
    verdicts = [FAILED.model_copy(update={"check": f"c{k}", "margin": -1.0 - k}) for k in range(count)]
    known = [KNOWN.model_copy(update={"check": f"k{k}", "known_reason": f"reason {k}"}) for k in range(20)]
    *shown, last = annotations(run_of((PASSED, *verdicts, *known)))
    errors = [each for each in shown if each.name == "error"]
    assert len(errors) == min(count, 9)
    assert len([each for each in shown if each.name == "notice"]) == 9
    assert [each.properties["title"].split()[-1] for each in errors] == [
        f"c{count - 1 - k}" for k in range(len(errors))
    ]
    assert last.name == ("error" if count else "notice")
    assert last.message.endswith(f"; {max(count - 9, 0) + 11} more are in the reports")


def test_the_file_is_that_of_the_controller():
    """An annotation stands at the controller's file where that lies in the repository, else at none."""
    at_a_file, _ = annotations(run_of((FAILED,), files={"controller": "src/a,b:c.py"}))
    assert at_a_file.properties["file"] == "src/a,b:c.py"
    assert all("file" not in each.properties for each in annotations(run_of((FAILED,))))


@given(text=anything)
def test_any_text_comes_out_as_it_went_in(text):
    """Percent signs, ends of lines, colons and commas of others are neither command nor property."""
    line = workflow_commands.workflow_command("error", text, title=text)
    (found,) = commands(line)
    as_read = text.replace("##[", "## [")
    assert found.message == as_read
    assert found.properties.get("title", "") == as_read


@given(text=anything)
def test_a_harmless_text_has_no_command(text):
    """Whatever lines and white space come before them, of any kind that ends a line or begins one."""
    assert commands(harmless(text)) == []


def test_what_is_no_command_stays_as_it_is():
    """Only what the runner would obey is changed, and can still be read."""
    text = "a::b\n: :c\nat 12::30, # [x]\n"
    assert harmless(text) == text
    assert harmless("x\n  ::error::y ##[group]z") == "x\n  : :error::y ## [group]z"


def test_texts_of_others_command_nothing():
    """Names, reasons and messages with commands in them give the annotations that they belong to, and no other."""
    bad = FAILED.model_copy(update={"check": ATTACK, "message": ATTACK, "clause": ATTACK})
    known = KNOWN.model_copy(update={"check": ATTACK, "known_reason": ATTACK})
    found = annotations(run_of(test_of(ATTACK, bad, known, title=ATTACK), files={"controller": ATTACK}))
    assert [each.name for each in found] == ["error", "notice", "error"]
    assert found[0].message.startswith("at 90 %25, a:b\r\n: :set-output name=x::y\n")


@pytest.mark.parametrize(("value", "read"), [("true", True), ("false", False), ("", False), (None, False)])
def test_annotations_are_printed_for_a_runner(monkeypatch, value, read):
    """Where no runner reads them they would only be noise."""
    monkeypatch.delenv(workflow_commands.RUNNER, raising=False)
    if value is not None:
        monkeypatch.setenv(workflow_commands.RUNNER, value)
    assert bool(github.console(run_of((FAILED,)))) is read


def test_the_summary_is_bounded():
    """Of thousands of failures as many are shown as there is room for."""
    results = run_of(*((FAILED.model_copy(update={"message": f"{k}: {FAILED.message}"}),) for k in range(2_500)))
    content = github.render(results)
    assert github.ROOM * 0.7 < len(content.encode()) <= github.ROOM
    assert "more: report.html has all of them." in content
