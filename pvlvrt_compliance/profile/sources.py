"""One file of a profile: read with care, with the lines of its keys."""

import json
import re
import tomllib
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import Any

from pvlvrt_compliance.errors import ProfileError
from pvlvrt_compliance.positions import Location, key_lines
from pvlvrt_compliance.problems import dotted
from pvlvrt_compliance.profile.search_path import origin_of

LARGEST_FILE_BYTES = 1 << 20
DEEPEST = 32

# tomllib takes time in the square of the number of parts of a key.
_PART = r"""(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')"""
_LONG_KEY = re.compile(rf"(?:^|(?<=[\s\[{{,]))(?:{_PART}[ \t]*+\.[ \t]*+){{32}}")
_PLACE = re.compile(r" \(at (?:line (\d+), column \d+|end of document)\)$")
_KEY_ON_LINE = re.compile(r"""\s*\[{0,2}\s*((?:[\w.-]|"[^"]*"|'[^']*')+)\s*[]=]""")
_YAML_LINE = re.compile(r"(?:---|%YAML|- |[\w-]+:(?:\s|$))")

# What a terminal would act on when the text is shown, and what XML cannot hold.
_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\ufffe\uffff]")

Table = dict[str, Any]


class Source:
    """A TOML file: its path, its table, and where its keys stand."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.origin = origin_of(path)
        self.text = self._text()
        self.table = self._table()

    def problem(self, location: Location, text: str) -> str:
        """A problem in words: file, line, key, what is wrong."""
        return f"{self.origin}:{self.line_of(location)}: {dotted(location)}: {text}"

    def line_of(self, location: Location) -> int:
        """Line of a key, or of the innermost table around it that the file has."""
        while location not in self._lines:
            location = location[:-1]
        return self._lines[location]

    @cached_property
    def _lines(self) -> dict[Location, int]:
        return key_lines(self.text)

    def _refuse(self, text: str, line: int | None = None) -> ProfileError:
        place = self.origin if line is None else f"{self.origin}:{line}"
        return ProfileError(self.origin, [f"{place}: {text}"])

    def _text(self) -> str:
        try:
            with self.path.open("rb") as file:
                content = file.read(LARGEST_FILE_BYTES + 1)
        except OSError as error:
            raise self._refuse(f"cannot be read: {error.strerror}") from None
        if len(content) > LARGEST_FILE_BYTES:
            raise self._refuse("larger than 1 MiB; a profile is a few kilobytes")
        try:
            return content.decode("utf-8-sig").replace("\r\n", "\n")
        except UnicodeDecodeError as error:
            line = content.count(b"\n", 0, error.start) + 1
            raise self._refuse(f"not UTF-8 text: byte {error.start} cannot be decoded", line) from None

    def _table(self) -> Table:
        long = _LONG_KEY.search(self.text)
        if long is not None:
            raise self._refuse("a key of too many parts", self.text.count("\n", 0, long.start()) + 1)
        try:
            table = tomllib.loads(self.text)
        except RecursionError:
            raise self._refuse("not TOML: nested too deeply", 1) from None
        except ValueError as error:
            raise self._syntax_error(str(error)) from None
        deep = _too_deep(table)
        if deep is not None:
            raise ProfileError(self.origin, [f"{self.origin}:{self.line_of(deep)}: {deep[0]}: nested too deeply"])
        for location, what in _control_characters(table, ()):
            raise ProfileError(self.origin, [self.problem(location, f"{what} must not have control characters")])
        return table

    def _syntax_error(self, message: str) -> ProfileError:
        language = _other_language(self.text)
        if language is not None:
            return self._refuse(f"not TOML: this looks like {language}; profiles are TOML", 1)
        place = _PLACE.search(message)
        lines = self.text.splitlines() or [""]
        line = int(place[1]) if place and place[1] else len(lines)
        key = _KEY_ON_LINE.match(lines[min(line, len(lines)) - 1])
        known = f"{key[1]}: " if key else ""
        twice = ": a key or table that is there already" if "overwrite" in message or "twice" in message else ""
        return self._refuse(f"{known}not TOML{twice}: {message}", line if place else 1)


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


def _too_deep(table: Table) -> Location | None:
    """Location of something nested deeper than any profile is."""
    level: list[tuple[Location, Any]] = [((), table)]
    for _ in range(DEEPEST):
        level = [
            ((*location, key), value)
            for location, content in level
            for key, value in (content.items() if isinstance(content, dict) else enumerate(content))
            if isinstance(value, (dict, list))
        ]
    return level[0][0] if level else None


def _control_characters(content: Any, location: Location) -> Iterator[tuple[Location, str]]:
    """Where control characters are; of a key that has them, the table."""
    if isinstance(content, str) and _CONTROL.search(content):
        yield location, "a text"
    elif isinstance(content, dict):
        for key, value in content.items():
            if _CONTROL.search(key):
                yield location, "a key"
            yield from _control_characters(value, (*location, key))
    elif isinstance(content, list):
        for index, value in enumerate(content):
            yield from _control_characters(value, (*location, index))
