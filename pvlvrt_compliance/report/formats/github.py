"""`github-summary.md`, which GitHub shows as the summary of a step, and annotations of what fails the run."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from pvlvrt_compliance.report.console import summary_line
from pvlvrt_compliance.report.document.comment import comment
from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.report.gate import STOPS, numbers_in_words, place_of, told, worst_first
from pvlvrt_compliance.report.joining import Joined, count, few, joined
from pvlvrt_compliance.report.verdicts import interrupted_in_words
from pvlvrt_compliance.report.workflow_commands import is_read, workflow_command
from pvlvrt_compliance.results import Results, Status
from pvlvrt_compliance.results.files import SUMMARY_GITHUB

FILE = SUMMARY_GITHUB
ASKED_FOR = True
APPENDED_TO = "GITHUB_STEP_SUMMARY"

ROOM = 256 * 1024
"""Bytes, a quarter of what GitHub takes as the summary of a step, into which several runs may write."""

SHOWN = 9
"""Annotations of a kind; GitHub shows ten a step, and the last is about the run."""

_NAMED = 20  # tests, and checks, in the text of one
_ERROR, _NOTICE = "error", "notice"


def render(results: Results, drawings: Mapping[str, Drawing] | None = None) -> str:  # noqa: ARG001
    """Return the summary of a step as Markdown of at most `ROOM` bytes."""
    return comment(results, ROOM)


def console(results: Results) -> str:
    """Annotations as lines that GitHub's runner reads; nothing where none does."""
    return "".join(f"{line}\n" for line in annotations(results)) if is_read() else ""


def annotations(results: Results) -> Iterator[str]:
    """The worst of what fails the run as errors, of what the baseline knows as notices, and one on the run.

    Verdicts that share a reason have one together.
    """
    found = told(results)
    red = joined(worst_first(each for each in found if each.outcome in STOPS))
    known = joined(worst_first(each for each in found if each.verdict.is_known))
    yield from _shown(_ERROR, red, results)
    yield from _shown(_NOTICE, known, results)
    kind = _NOTICE if results.counts_as is Status.PASS else _ERROR
    said = [interrupted_in_words(results)] if results.interrupted else []
    yield workflow_command(kind, "; ".join([*said, summary_line(results), *_left_out(red, known)]), title="Grid code")


def _shown(kind: str, found: Sequence[Joined], results: Results) -> Iterator[str]:
    for group in found[:SHOWN]:
        first, tests = group.first, [test.key for test in group.tests]
        numbers = numbers_in_words(*(each.verdict for each in group.members))
        said = "\n".join(filter(None, [first.reason, numbers, *_all_of(group, tests)]))
        title = f"{few(tests)} {few(group.names)}"
        yield workflow_command(kind, said, title=title, file=place_of(first.test, results) or "")


def _all_of(group: Joined, tests: Sequence[str]) -> Iterable[str]:
    """How many verdicts an annotation stands for, and which, where it is more than one."""
    if len(group.members) > 1:
        yield f"{len(group.members)} verdicts: {few(group.names, _NAMED)} of {few(tests, _NAMED)}"


def _left_out(*kinds: Sequence[Joined]) -> Iterable[str]:
    left = sum(count(found[SHOWN:]) for found in kinds)
    return [f"{left} more are in the reports"] if left else []
