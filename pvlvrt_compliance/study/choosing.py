"""From all tests of the profiles to those that are run, and what is to be said of the others."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results.files import RESULTS
from pvlvrt_compliance.study.last_run import Unsettled, last_tests, unsettled_among
from pvlvrt_compliance.study.selection import Assignment, judge_only, keep_short, select, skip

if TYPE_CHECKING:
    from pvlvrt_compliance.study.job import Asked


class Choice(NamedTuple):
    """Which tests are run."""

    tests: tuple[Assignment, ...]
    left_out: tuple[Assignment, ...]  # long tests that nobody asked for
    not_selected: tuple[Assignment, ...]  # all others
    first: frozenset[str]  # keys of those that are run before the others
    notes: tuple[str, ...]  # what there is to know of it, a sentence each


def choose(
    everything: Sequence[Assignment],
    profiles: Sequence[Profile],
    asked: "Asked",
    spell: Callable[[str], str],
    last_run: str | None,
) -> Choice:
    """Choose among all tests what somebody asks for.

    Parameters
    ----------
    everything : sequence of Assignment
        All tests of the profiles, or the one sag in their place.
    profiles : sequence of Profile
    asked : Asked
        What is asked for.
    spell : callable
        As of `make_job`.
    last_run : str, optional
        Folder of the files of the last run.

    Raises
    ------
    UsageError
        When a pattern or a check fits nothing, no test is left, or the results of the last run cannot be read.
    """
    selected = skip(select(everything, asked.tests, spell), asked.skip, everything, spell)
    judged = judge_only(profiles, selected, asked.checks, spell)
    notes = []
    if idle := len(selected) - len(judged):
        notes.append(f"{spell('checks')}: judges nothing in {idle} of {len(selected)} tests, which are left out")
    unsettled, said = _unsettled(judged, asked, spell, last_run)
    if asked.last_failed and unsettled:  # a long one among them was asked for then
        tests = tuple(item for item in judged if item.key in unsettled)
    else:
        tests = judged if asked.include_long else keep_short(judged, asked.tests)
    if judged and not tests:
        raise UsageError(f"all {len(judged)} tests selected are long ones; they run with {spell('include_long')}")
    chosen = {item.key for item in tests}
    left_out = () if asked.last_failed and unsettled else tuple(item for item in judged if item.key not in chosen)
    known = chosen | {item.key for item in left_out}
    return Choice(
        tests=tests,
        left_out=left_out,
        not_selected=tuple(item for item in everything if item.key not in known),
        first=unsettled if asked.failed_first else frozenset(),
        notes=(*notes, *said),
    )


def _unsettled(
    found: Sequence[Assignment], asked: "Asked", spell: Callable[[str], str], last_run: str | None
) -> tuple[frozenset[str], tuple[str, ...]]:
    """Keys of the tests that were not passed the last time, where anybody wants to know, and what is to be said."""
    if not (asked.last_failed or asked.failed_first):
        return frozenset(), ()
    option = spell("last_failed" if asked.last_failed else "failed_first")
    if last_run is None:
        raise UsageError(f"{option}: needs {spell('output')}, the folder of the last run")
    last = last_tests(Path(last_run))
    unsettled = unsettled_among(found, last or ())
    if unsettled.again:
        return unsettled.again, (f"{option}: {_in_words(unsettled, len(found), bool(asked.last_failed))}",)
    why = "no results of a run yet" if last is None else "none of the tests selected failed the last time"
    return unsettled.again, (f"{option}: {Path(last_run) / RESULTS}: {why}; all are run",)


def _in_words(unsettled: Unsettled, selected: int, alone: bool) -> str:
    count, were = unsettled.not_passed, "was" if unsettled.not_passed == 1 else "were"
    if not unsettled.rows:
        said = f"{count} of the {selected} tests selected {were} not passed the last time"
        return said if alone else f"{said}; {'it goes' if count == 1 else 'they go'} first"
    tests, rows = "test" if count == 1 else "tests", "row" if unsettled.rows == 1 else "rows"
    their, those = "its" if count == 1 else "their", f"{len(unsettled.again)} of the {selected} tests selected"
    what = f"{those} are run" if alone else f"{those} go first"
    return f"{count} {tests} {were} not passed the last time; with the other runs of {their} {rows} {what}"
