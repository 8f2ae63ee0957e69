"""Text as TOML; what is no TOML is told with its line and key."""

import json
import re
import tomllib
from typing import Any

from pvlvrt_compliance.data.positions import TOKEN, last_key
from pvlvrt_compliance.data.problems import dotted
from pvlvrt_compliance.data.text import UnreadableError
from pvlvrt_compliance.texts import shortened

Table = dict[str, Any]

DEEPEST = 32
"""Levels of tables and lists, one within the other, that a file may have; also the parts of a key."""

LARGEST_WHOLE_NUMBER = 2**63 - 1
"""TOML has whole numbers of 64 bits."""

TOO_DEEP = f"nested too deeply, more than {DEEPEST} levels"
TOO_LARGE = "a whole number of more than 64 bits, which TOML does not have"

# tomllib takes time in the square of the number of parts of a key.
_PART = r"""(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')"""
_LONG_KEY = re.compile(rf"(?:^|(?<=[\s\[{{,]))(?:{_PART}[ \t]*+\.[ \t]*+){{{DEEPEST}}}")
_PLACE = re.compile(r" \(at (?:line (\d+), column \d+|end of document)\)$")
_KEY_ON_LINE = re.compile(r"""\s*+(?:\[{1,2}\s*+)?((?:[\w.-]|"[^"]*"|'[^']*')+)\s*+[]=]""")
_YAML_LINE = re.compile(r"(?:---|%YAML|- |[\w-]+:(?:\s|$))")
_WHOLE_NUMBER = re.compile(r"[+-]?[0-9_]{19,}")
_AFTER_A_KEY = re.compile(r"[ \t]*[=.]")
_LONGEST_MESSAGE = 300  # of tomllib, which repeats names of any length
_OPENS = {"[": 1, "{": 1, "]": -1, "}": -1}


def parse(text: str, plural: str) -> Table:
    """Table of a document.

    Parameters
    ----------
    text : str
    plural : str
        What such files are called, for those in another language: ``profiles``.

    Raises
    ------
    UnreadableError
        When it is not TOML, or no Python could read it.
    """
    long = _LONG_KEY.search(text)
    if long is not None:
        raise UnreadableError(f"a key of too many parts, more than {DEEPEST}", _line_at(text, long.start()))
    try:
        return tomllib.loads(text)
    except RecursionError:
        location, line = last_key(text[: _end_of_depth(text)])
        raise UnreadableError(f"{dotted(location[:1])}: not TOML: {TOO_DEEP}", line) from None
    except tomllib.TOMLDecodeError as error:
        raise _syntax_error(text, str(error), plural) from None
    except ValueError:  # more digits than Python makes a number of
        location, line = last_key(text[: _end_of_large_number(text)])
        raise UnreadableError(f"{dotted(location)}: not TOML: {TOO_LARGE}", line) from None


def _end_of_depth(text: str) -> int:
    """Where the first value that is nested too deeply has become so."""
    depth = 0
    for token in TOKEN.finditer(text):
        depth += _OPENS.get(token[0], 0)
        if depth > DEEPEST:
            return token.end()
    return len(text)


def _end_of_large_number(text: str) -> int:
    """Where the first whole number ends that is too large in digits; one with another base can always be read."""
    for token in TOKEN.finditer(text):
        if _WHOLE_NUMBER.fullmatch(token[0]) and not _AFTER_A_KEY.match(text, token.end()) and _is_large(token[0]):
            return token.end()
    return len(text)


def _is_large(digits: str) -> bool:
    try:
        return abs(int(digits)) > LARGEST_WHOLE_NUMBER
    except ValueError:
        return True


def _line_at(text: str, place: int) -> int:
    return text.count("\n", 0, place) + 1


def _syntax_error(text: str, message: str, plural: str) -> UnreadableError:
    language = _other_language(text)
    if language is not None:
        return UnreadableError(f"not TOML: this looks like {language}; {plural} are TOML", 1)
    place = _PLACE.search(message)
    lines = text.removesuffix("\n").split("\n")
    line = min(int(place[1]) if place and place[1] else len(lines), len(lines))
    key = _KEY_ON_LINE.match(lines[line - 1])
    known = f"{dotted((key[1],))}: " if key else ""
    twice = ": a key or table that is there already" if "overwrite" in message or "twice" in message else ""
    return UnreadableError(f"{known}not TOML{twice}: {shortened(message, _LONGEST_MESSAGE)}", line if place else 1)


def _other_language(text: str) -> str | None:
    """The language that a text which is not TOML looks like."""
    content = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if not content:
        return None
    if content[0].lstrip()[0] in "{[":
        try:
            json.loads(text)
        except (ValueError, RecursionError):
            return "JSON" if content[0].lstrip()[0] == "{" else None
        return "JSON"
    return "YAML" if _YAML_LINE.match(content[0]) else None
