"""A baseline brought up to date, from files and for a file."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.data.text import LARGEST_FILE_MIB
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.results.files import RESULTS
from pvlvrt_compliance.results.reading import read_results
from pvlvrt_compliance.study.baseline.entries import Baseline
from pvlvrt_compliance.study.baseline.reading import digest_of, read_baseline
from pvlvrt_compliance.study.baseline.text import too_large, written
from pvlvrt_compliance.study.baseline.updating import Kind, Update, updated
from pvlvrt_compliance.texts import CONTROL, one_line

_MOST_TOLD, _MOST_NAMED = 100, 5


class Done(NamedTuple):
    """A file that is to be written, unless it is as it should be, and what is to be said of it."""

    file: Path
    content: bytes
    is_changed: bool
    said: tuple[str, ...]


def update_file(file: str, results: str, *, margins: bool | None = None, prune: bool = False, reason: str = "") -> Done:
    """What a baseline is after a run; nothing is written.

    Parameters
    ----------
    file : str
        The baseline; there may be none yet.
    results : str
        Folder of the run, or its `results.json`.
    margins, prune, reason
        As of `updated`.

    Raises
    ------
    UsageError
        When either cannot be read, the reason is no line of text, or the baseline would be too large.
    """
    path, of_run = Path(file), Path(results)
    if CONTROL.search(reason):
        raise UsageError("--reason: has a control character; a reason is one line of text")
    found = read_results(of_run / RESULTS if of_run.is_dir() else of_run)
    # What is there and is no baseline is never written over.
    there = read_baseline(file, "baseline") if path.exists() else None
    done = updated(
        there.baseline if there else Baseline({}), found, margins=margins, prune=prune, reason=reason.strip()
    )
    text = written(done.baseline)
    if too_large(text):
        raise UsageError(f"{file}: would be larger than {LARGEST_FILE_MIB} MiB; --no-margins leaves out what passed")
    is_changed = there is None or there.digest != digest_of(text)
    return Done(path, text.encode(), is_changed, tuple(_said(file, done, is_changed)))


def _said(file: str, done: Update, is_changed: bool) -> Iterator[str]:
    yield from (step.in_words for step in done.steps[:_MOST_TOLD])
    if len(done.steps) > _MOST_TOLD:
        yield f"... and {len(done.steps) - _MOST_TOLD} lines more"
    counts = ", ".join(f"{done.count(kind)} {kind}" for kind in Kind)
    yield f"{file}: {_count(len(done.baseline.entries), 'line')}: {counts}"
    if is_changed and not done.steps:
        yield "only the form differs: columns, order or the first lines are not as they are written"
    if done.not_run:
        tests = "its test was" if done.not_run == 1 else "their tests were"
        yield f"kept: {_count(done.not_run, 'line')}, {tests} not run (--prune drops them)"
    if done.unjudged:
        places = ", ".join(one_line(f"{check} in {test}") for test, check in done.unjudged[:_MOST_NAMED])
        more = f" and {len(done.unjudged) - _MOST_NAMED} more" if len(done.unjudged) > _MOST_NAMED else ""
        yield f"never known, since it could not be judged: {places}{more}"
    if done.without_reason:
        yield f"without a reason: {_count(done.without_reason, 'failure')}; write it behind a # at the end of the line"


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"
