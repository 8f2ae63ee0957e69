"""The file: how a baseline is written, and read with every problem at once.

A line an entry, in columns that stand at fixed places, so that a changed line moves no other one::

    # pvlvrt-baseline 1
    iec61400-21.VD1-full-1          current_limit             fail -0.086 pu      # ticket 42
"""

import json
import math
import re
from collections.abc import Iterator
from decimal import Decimal

from pvlvrt_compliance.data.text import LARGEST_FILE_BYTES
from pvlvrt_compliance.errors import did_you_mean
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.results.changes import Key
from pvlvrt_compliance.study.baseline.entries import KEPT, Baseline, Entry
from pvlvrt_compliance.texts import CONTROL

VERSION = 1

_FORMAT = "# pvlvrt-baseline"
HEAD = f"{_FORMAT} {VERSION}"
"""The first line; alone it is a baseline that knows nothing."""

_HEAD = (
    HEAD,
    "# What is known, by pvlvrt-check baseline update, which writes these three lines anew and keeps all others.",
    "# A line a verdict: test, check, fail or pass, margin  # why it is lived with",
)
_TEST_WIDTH, _CHECK_WIDTH, _VERDICT_WIDTH, _MARGIN_WIDTH = 38, 28, 6, 16
_STEP = 8  # by which a column moves on in the one line that has no room in it

_NAME = re.compile(r'(?![<=>|]{7}$)[^\s#"]+')
_WORD = re.compile(r'"(?:[^"\\]|\\.)*"|[^\s"#]+')
_MOST_DIGITS = 9  # of a whole number: no other is one of ours, and Python makes none of some thousand
_NUMBERED = re.compile(rf"\([0-9]{{1,{_MOST_DIGITS}}}\)")
_MARGIN = re.compile(r"[+-]?[0-9]+(?:\.[0-9]+)?")
_CONFLICT = re.compile(r"(?:<{7}|={7}|>{7}|\|{7})(?: |$)")
_SETTLE = (
    "a marker of a merge conflict; remove it, keep the lines of both sides, and one of those on the same verdict:"
    " pvlvrt-check baseline update corrects their margins then"
)
_ALLOWED = ", ".join(KEPT)
_SHAPE = "a line is: TEST CHECK VERDICT MARGIN # REASON, for instance p.VD1 current_limit fail -0.086 pu # ticket 42"


def written(baseline: Baseline) -> str:
    """The text of a baseline, sorted by test and check."""
    lines = [*_HEAD, ""]
    for entry in sorted(baseline.entries.values(), key=lambda entry: _order(entry.key)):
        lines += [*entry.above, _line(entry)]
    return "\n".join([*lines, *baseline.below]) + "\n"


def parsed(text: str, origin: str) -> tuple[Baseline, list[str]]:
    r"""A baseline, and the problems of its text: file, line, what is wrong and what is allowed.

    Parameters
    ----------
    text : str
        With lines that end in ``\n``.
    origin : str
        The file as problems name it.
    """
    found = _Found()
    problems: list[tuple[int, str]] = []
    lines = text.split("\n")
    problems += [(1, problem) for problem in _problems_of_head(lines[0])]
    for number, line in enumerate(lines[1:], start=2):
        try:
            found.take(number, line)
        except ValueError as problem:
            problems.append((number, str(problem)))
    return found.baseline(), [f"{origin}:{number}: {problem}" for number, problem in problems]


class _Found:
    """What has been read so far."""

    def __init__(self) -> None:
        self._entries: dict[Key, Entry] = {}
        self._lines: dict[Key, int] = {}
        self._comments: list[str] = []
        self._in_head = True

    def take(self, number: int, line: str) -> None:
        """Take one line; ValueError says what is wrong with it."""
        if _CONFLICT.match(line):
            raise ValueError(_SETTLE)
        line = line.replace("\t", " ").strip()
        if CONTROL.search(line):
            raise ValueError("has a control character; allowed is text, and a tab")
        if not line:
            self._in_head = False
        elif not line.startswith("#"):
            self._in_head = False
            self._add(number, _entry(line, tuple(self._comments)))
            self._comments.clear()
        elif not self._in_head:
            self._comments.append(line)

    def baseline(self) -> Baseline:
        """All of it."""
        return Baseline(self._entries, tuple(self._comments))

    def _add(self, number: int, entry: Entry) -> None:
        before = self._lines.setdefault(entry.key, number)
        if before != number:
            test, check = entry.key
            raise ValueError(f"{check} in {test} stands in line {before} already; allowed is one line each: remove one")
        self._entries[entry.key] = entry


def _problems_of_head(line: str) -> Iterator[str]:
    """What is wrong with the first line, which says that the file is a baseline, and of which format."""
    head, _, version = line.strip().rpartition(" ")
    if _CONFLICT.match(line):
        yield _SETTLE
    elif head != _FORMAT or not version.isdecimal():
        yield (
            f'no baseline: the first line must be "{HEAD}"; write it there, or, where nothing of the file is needed,'
            " remove it and run pvlvrt-check baseline update"
        )
    elif len(version) > _MOST_DIGITS or int(version) != VERSION:
        yield f"format {version:.{_MOST_DIGITS}} is not known to this version of the program, which reads {VERSION}"


def _entry(line: str, above: tuple[str, ...]) -> Entry:
    words, reason = _split(line)
    if len(words) < 3:
        raise ValueError(f"{len(words)} of at least 3 words; {_SHAPE}")
    test, check, *rest = words
    if _NUMBERED.fullmatch(rest[0]):
        check = f"{check} {rest.pop(0)}"
    if not rest or rest[0] not in KEPT:
        verdict = rest[0] if rest else ""
        raise ValueError(f"verdict {verdict!r} is unknown; allowed are {_ALLOWED}{did_you_mean(verdict, KEPT)}")
    margin, unit = _margin(rest[1:])
    return Entry(Key(test, check), Status(rest[0]), margin, unit, reason, above)


def _split(line: str) -> tuple[list[str], str]:
    """Words of a line, those in quotation marks as what they stand for, and what follows its ``#``."""
    words, place = [], 0
    while place < len(line) and line[place] != "#":
        if line[place].isspace():
            place += 1
            continue
        word = _WORD.match(line, place)
        if word is None:
            raise ValueError("a quotation mark that nothing closes; a name with spaces is written as in JSON")
        words.append(_name(word[0]))
        place = word.end()
    return words, line[place + 1 :].strip()


def _name(word: str) -> str:
    if not word.startswith('"'):
        return word
    try:
        return str(json.loads(word))
    except ValueError:
        raise ValueError(f"{word}: not a text as JSON has it") from None


def _margin(words: list[str]) -> tuple[Decimal | None, str]:
    if not words:
        return None, ""
    number, *unit = words
    if not _MARGIN.fullmatch(number) or not math.isfinite(float(number)):
        raise ValueError(f"margin {number!r} is not a number; allowed is one with its unit, -0.086 pu, or none")
    if len(unit) > 1:
        raise ValueError(f"{unit[1]!r} is too much; {_SHAPE}")
    return Decimal(number), "".join(unit)


def _line(entry: Entry) -> str:
    check, space, number = entry.key.check.rpartition(" ")
    name = f"{_written(check)} {number}" if space and _NUMBERED.fullmatch(number) else _written(entry.key.check)
    margin = "" if entry.margin is None else f"{entry.margin:+f}"
    cells = (
        (_written(entry.key.test), _TEST_WIDTH),
        (name, _CHECK_WIDTH),
        (entry.status.value, _VERDICT_WIDTH),
        (f"{margin} {_written(entry.unit)}" if margin and entry.unit else margin, _MARGIN_WIDTH),
    )
    line = "".join(_padded(text, width) for text, width in cells)
    return f"{line}# {entry.reason}" if entry.reason else line.rstrip()


def _padded(text: str, width: int) -> str:
    """A text as wide as its column; one that has no room in it alone moves what follows, by whole steps."""
    room = len(text) + 1
    return text.ljust(width if room <= width else width + -(-(room - width) // _STEP) * _STEP)


def _written(name: str) -> str:
    """A name as a word: as it is, or as in JSON where it would not be read back."""
    return name if _NAME.fullmatch(name) and name.isprintable() else json.dumps(name)


def _order(key: Key) -> tuple[str, str, int]:
    check, _, number = key.check.rpartition(" ")
    if check and _NUMBERED.fullmatch(number):
        return key.test, check, int(number[1:-1])
    return key.test, key.check, 1


def too_large(text: str) -> bool:
    """Whether a text is more than a baseline may have to be read again."""
    return len(text.encode()) > LARGEST_FILE_BYTES
