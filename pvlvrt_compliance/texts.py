r"""Texts that are not ours: the one place that they pass before anybody sees them.

What a controller says, what a file of others holds, how a file is called, what is typed: all of it may be made to be
obeyed, by a terminal, by a CI service, by the reader's eyes. `printable` makes text of it that is seen as it is. Texts
come in at few borders, and pass it there: the errors of this package (`errors.PvlvrtError`), its results
(`results.text`; those of a cluster's worker once more where they arrive, `executors.cluster.dispatch`), what the
process of a controller answers (`controllers.description`), channels of a record by others
(`waveforms.recording`), and what a command prints of anything else (`cli.telling`). What is particular to a sink stays
with it: quoting of HTML, XML, JSON and Markdown, glyphs of the PDF, lines of a stream as they fall once it has folded
them.
"""

import codecs
import io
import re
from collections.abc import Callable
from functools import cache
from typing import Annotated, Any, NamedTuple

LONGEST = 8000
"""Characters of a text, chosen: the end of what a controller has printed and what is said around it take a quarter,
and the longest command line of Windows (8191) all of it; a report of a thousand verdicts stays a file that opens."""

LONGEST_NAME = 1000
"""Characters of what is one line, a name, a unit, a title, chosen: a field of a title page may have as many, and no
hierarchy of blocks, no path that somebody has typed has come to it."""

LONGEST_ID = 400
"""Characters of an id and of the name of a check, chosen: two of them are a name."""

MOST_LINES = 200
"""Of an error, chosen: a file's hundred problems (`errors.listed`), each with a line of its own below it."""

CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f\ufffe\uffff]")
"""What a terminal would act on when it is shown, and what XML cannot hold: a file that people write has none."""

_TAB = 4
_ENDS = re.compile("\r\n?|[\v\f\x85\u2028\u2029]")

# Controls but the line feed; soft hyphen, joiners, marks and overrides of direction, fillers, annotations, tags, which
# have no width of their own; halves of a character; what is none. Two selectors stay, which tell how a sign is drawn.
_UNSEEN = (
    "[\x00-\x09\x0b-\x1f\x7f-\x9f\xad\u034f\u061c\u115f\u1160\u17b4\u17b5\u180b-\u180f\u200b-\u200f\u202a-\u202e"
    "\u2060-\u206f\u3164\ud800-\udfff\ufdd0-\ufdef\ufe00-\ufe0d\ufeff\uffa0\ufff0-\ufffb\ufffe\uffff"
    "\U0001bca0-\U0001bca3\U0001d173-\U0001d17a\U000e0000-\U000e0fff"
    + "".join(f"{chr(plane | 0xFFFE)}{chr(plane | 0xFFFF)}" for plane in range(0x10000, 0x110000, 0x10000))
    + "]"
)

_COMMAND = re.compile(r"(^|[\r\n])([^\S\r\n]*):(?=:)")
_OLDER_COMMAND = re.compile(r"##(?=\w*\[)")

_HANDLER = "pvlvrt-names"


def printable(text: str, longest: int | None = LONGEST) -> str:
    r"""The same as lines that are seen as they are: no control character, no line that commands a CI service, no end.

    What cannot be seen is spelled as in a program, ``\x1b``, ``\u202e``; a byte of a name that is no text, ``\xff``. A
    tab is blanks, and whatever ends a line is a line feed. What has passed once passes again unchanged.

    Parameters
    ----------
    text : str
    longest : int, optional
        Characters that it may have; beyond, it ends with how many there were. None: any number.
    """
    begin = text if longest is None else text[: 2 * longest + 1]  # a line's end may be two characters
    if not (begin.isascii() and begin.isprintable()):
        begin = _unseen().sub(_spelled, _ENDS.sub("\n", begin).expandtabs(_TAB))
    begin = harmless(begin)
    if longest is None or (len(begin) <= longest and len(text) <= 2 * longest + 1):
        return begin
    return _cut(begin, longest, _characters(text))


def one_line(text: str, longest: int | None = LONGEST_NAME) -> str:
    """A name, or whatever else is one line: `printable`, and its lines are joined by a blank."""
    begin = text if longest is None else text[: 2 * longest + 1]
    if begin.isascii() and begin.isprintable():
        return printable(text, longest)
    lines = printable(begin, None).split("\n")
    joined = lines[0] if len(lines) == 1 else " ".join(line.strip() for line in lines if line.strip())
    return joined if longest is None or len(joined) <= longest else _cut(joined, longest, _characters(text))


def identity(text: str) -> str:
    """A name that others are told apart by: one line, and where it is cut, then so that two of them stay two."""
    line = one_line(text, longest=None)
    if len(line) <= LONGEST_ID:
        return line
    import hashlib

    digest = hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()
    return _cut(line, LONGEST_ID, f"{len(text)} characters, SHA-256 {digest[:12]}")


def each_line(text: str) -> str:
    """What is made of many texts, a line each: every line as `one_line` has it, and not without end.

    Lines end in a line feed, as this package writes them; whatever else ends one is part of a text that is quoted.
    """
    lines = text[: MOST_LINES * LONGEST].split("\n")
    more = [f"... ({text.count(chr(10)) + 1} lines)"] if len(lines) > MOST_LINES else []
    return "\n".join([*(one_line(line, LONGEST) for line in lines[: MOST_LINES - len(more)]), *more])


def all_printable(data: Any) -> Any:
    """Plain data with every text in it `printable`."""
    if isinstance(data, str):
        return printable(data)
    if isinstance(data, dict):
        return {printable(key) if isinstance(key, str) else key: all_printable(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [all_printable(value) for value in data]
    return data


class _Kept(NamedTuple):
    """Has a model of pydantic keep what a function makes of a value; pydantic is not loaded for it."""

    as_made_by: Callable[[Any], Any]

    def __get_pydantic_core_schema__(self, source: Any, handler: Callable[[Any], Any]) -> Any:
        from pydantic_core import core_schema

        return core_schema.no_info_after_validator_function(self.as_made_by, handler(source))


Text = Annotated[str, _Kept(printable)]
"""A text of a model that anybody may be shown: `printable`, whoever has made the model."""

Name = Annotated[str, _Kept(one_line)]
"""The same on one line."""

Id = Annotated[str, _Kept(identity)]
"""A name that names are made of: of a profile, a test, a check."""

Plain = Annotated[Any, _Kept(all_printable)]
"""Plain data of a model, with texts that anybody may be shown."""

Data = Annotated[dict[str, Any], _Kept(all_printable)]
"""The same as a table."""


def shortened(text: str, longest: int) -> str:
    """A text of so many characters at most; one that was longer says how many it had."""
    return text if len(text) <= longest else _cut(text, longest, _characters(text))


def harmless(text: str) -> str:
    """Whole lines in which nothing commands a CI service; what would is kept readable.

    GitHub's runner takes a line as a command where it begins with ``::``, white space before it or not, and, in an
    older form, where ``##[`` stands anywhere in it (actions/runner, ActionCommand.cs); Azure's agent likewise where
    ``##vso[`` does, and TeamCity's ``##teamcity[``. Lines end with a line feed, a carriage return, or both.
    """
    if "::" not in text and "##" not in text:
        return text
    return _OLDER_COMMAND.sub("## ", _COMMAND.sub(r"\1\2: ", text))


def shell_word(word: str) -> str:
    r"""A word as a shell reads it back; with what cannot be seen as ``$'\xff'``, which bash, zsh and ksh know."""
    import shlex

    spelled = _unseen().sub(_spelled, word)
    if spelled == word and "\n" not in word:
        return shlex.quote(word)
    escaped = word.replace("\\", "\\\\").replace("'", "\\'").replace("\n", "\\n")
    return f"$'{_unseen().sub(_spelled, escaped)}'"


def write_any_name(stream: io.TextIOWrapper) -> Callable[[], None]:
    """Have a stream write bytes that are no text as they are, and ``?`` for a character that its encoding lacks.

    Returns
    -------
    callable
        That has it as it was.
    """
    before = stream.errors
    codecs.register_error(_HANDLER, _bytes_or_mark)
    stream.reconfigure(errors=_HANDLER)
    return lambda: stream.reconfigure(errors=before)


def _bytes_or_mark(error: UnicodeError) -> tuple[str | bytes, int]:
    try:
        return codecs.lookup_error("surrogateescape")(error)
    except UnicodeError:
        return codecs.lookup_error("replace")(error)


def _characters(text: str) -> str:
    return f"{len(text)} characters"


def _cut(text: str, longest: int, had: str) -> str:
    said = f"... ({had})"
    return f"{text[: max(longest - len(said), 0)]}{said}"


@cache
def _unseen() -> re.Pattern[str]:
    return re.compile(_UNSEEN)  # takes a millisecond, which a run of plain texts need not wait for


def _spelled(found: re.Match[str]) -> str:
    # Python has a surrogate, which no text holds, in the place of a byte that is none.
    code = ord(found[0])
    if 0xDC80 <= code <= 0xDCFF:
        return f"\\x{code - 0xDC00:02x}"
    if code <= 0xFF:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}" if code <= 0xFFFF else f"\\U{code:08x}"
