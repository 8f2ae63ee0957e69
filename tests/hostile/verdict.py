"""What must hold of every case, whatever was given."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from tests.hostile import soundness
from tests.hostile.case import EVALUATE, Case
from tests.hostile.folder import changes, left_over, untouched

STATUSES = (0, 1, 2, 3)
"""Of a command that nobody ends, see docs/commands.md."""

INTERRUPTED = 130
LONGEST_LINE = 20_000
"""Characters of a line on standard error, chosen: a screen full of files that are named is far below."""

MOST_MEMORY = 1 << 30
"""Bytes of the command itself."""

_PREFIX = "pvlvrt-check: "
_COLOUR = re.compile(r"\x1b\[[\d;]*m")
_COLOURED = {"FORCE_COLOR", "TTY_COMPATIBLE"}  # variables that ask for colours, which are control characters
_FURTHER = re.compile(r"  +\S")
_OURS = re.compile(r"::(error|warning|notice|group|endgroup)( (title|file)=|::)")
_BROKEN = re.compile(r"Traceback \(most recent|\b\w*Warning: |Segmentation fault|^Exception ignored", re.MULTILINE)


class Ended(NamedTuple):
    """How a case ended."""

    status: int
    out: bytes
    err: bytes
    peak: int = 0  # bytes
    processes: int = 0


def wrong(case: Case, ended: Ended, place: Path, interrupted: bool = False) -> list[str]:
    """All that does not hold."""
    return [*_status(ended, interrupted), *_said(case, ended), *_written(case, ended, place), *_left(ended)]


def reached_reports(ended: Ended, place: Path) -> bool:
    """Whether a run was judged and its reports were written."""
    return ended.status in (0, 1, 3) and any(place.glob("*/report.html"))


def _status(ended: Ended, interrupted: bool) -> Iterator[str]:
    if ended.status not in ((*STATUSES, INTERRUPTED) if interrupted else STATUSES):
        yield f"status {ended.status}, which is not documented"


def _said(case: Case, ended: Ended) -> Iterator[str]:
    out, err = (text.decode(case.encoding, "surrogateescape") for text in (ended.out, ended.err))
    for name, said in (("stdout", out), ("stderr", err)):
        if broken := _BROKEN.search(said):
            last = said.strip().rpartition("\n")[2]
            yield f"{name}: {broken.group()} ... {last[:300]}"
        shown = _COLOUR.sub("", said) if _COLOURED & case.environment.keys() else said
        if (control := soundness.control_in(shown)) is not None:
            yield f"{name} has the control character {control!r}"
        yield from (f"{name} commands the runner: {line[:80]!r}" for line in said.splitlines() if _commands(line, case))
    if any(len(line) > LONGEST_LINE for line in err.split("\n")):
        yield f"stderr has a line of {max(map(len, err.split(chr(10))))} characters"
    if ended.status == 2:
        yield from _reason(out if case.arguments[:2] != _SHOWS else "", err)
    if case.arguments[:1] == (EVALUATE,) and ended.status != 2 and not soundness.finite(out.encode("utf-8", "replace")):
        yield "the results are no JSON, or have numbers that are none"


_SHOWS = ("controllers", "inspect")
"""Shows what is known of a controller that cannot be run, too."""


def _commands(line: str, case: Case) -> bool:
    """Whether GitHub's runner would obey a line that is not ours."""
    is_read = case.environment.get("GITHUB_ACTIONS") == "true"
    return (line.lstrip().startswith("::") and not (is_read and _OURS.match(line))) or (is_read and "##[" in line)


def _reason(out: str, err: str) -> Iterator[str]:
    """Of wrong usage: a reason on standard error, in one line or in one for every problem of a file."""
    lines = err.split("\n")
    if lines[-1] or not err.strip():
        yield "status 2 without a reason"
    if out:
        yield f"status 2 and stdout: {out[:80]!r}"
    strays = [line for line in lines[:-1] if not line.startswith(_PREFIX) and not _FURTHER.match(line)]
    yield from (f"a line of stderr that is none of ours: {line[:100]!r}" for line in strays[:1])


def _written(case: Case, ended: Ended, place: Path) -> Iterator[str]:
    if ended.status != 2 or case.arguments[:2] == ("profiles", "check"):
        yield from changes(case, place, case.writes)
    else:
        yield from (f"status 2, and {said}" for said in changes(case, place, ()))
    if case.arguments[:2] != ("controllers", "new"):  # a project has such files of its own
        yield from left_over(place, case)
    for name in case.writes:
        if "\x00" not in name and len(name) < 200 and name not in case.files and (place / name).exists():
            yield from _only_new(case, place, name)


def _only_new(case: Case, place: Path, name: str) -> Iterator[str]:
    """What is unsound in what was written; what a case itself has brought may be anything."""
    kept = untouched(case, place)
    for path in [place / name] if name != "." else sorted(place.iterdir()):
        yield from soundness.unsound(path, kept)


def _left(ended: Ended) -> Iterator[str]:
    if ended.processes:
        yield f"{ended.processes} processes are left"
    if ended.peak > MOST_MEMORY:
        yield f"{ended.peak / 2**30:.1f} GiB of memory"
