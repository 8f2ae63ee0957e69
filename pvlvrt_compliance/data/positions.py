"""Lines of the keys in a TOML file. `tomllib`, which reads the file, does not tell them."""

import re
import tomllib
from collections.abc import Mapping
from contextlib import suppress
from typing import NamedTuple

from pvlvrt_compliance.data.problems import dotted

Location = tuple[int | str, ...]

TOKEN = re.compile(
    r'''
    (?P<blank>[ \t\r]+ | \#[^\n]*)
  | (?P<string>"""(?:[^\\]|\\.)*?"{3,5} | \'\'\'.*?\'{3,5} | "(?:[^"\\\n]|\\.)*" | '[^'\n]*')
  | (?P<mark>[\n\[\]{},=.])
  | (?P<bare>[^\s\[\]{},=.\#"']+ | .)
    ''',
    re.VERBOSE | re.DOTALL,
)


class Places(NamedTuple):
    """Where the keys of a file stand, to tell its problems."""

    origin: str  # the file as it is shown
    lines: Mapping[Location, int]  # empty of what was not read from a file

    def line_of(self, location: Location) -> int:
        """Line of a key, or of the innermost table around it that the file has."""
        while location and location not in self.lines:
            location = location[:-1]
        return self.lines.get(location, 1)

    def problem(self, location: Location, text: str) -> str:
        """A problem in words: file, line, key, what is wrong."""
        return f"{self.origin}:{self.line_of(location)}: {dotted(location)}{': ' if location else ''}{text}"


class _Token(NamedTuple):
    text: str
    line: int


def key_lines(text: str) -> dict[Location, int]:
    """Line of every key, element of a list and table header of a TOML document, by its location.

    A table that no header opens stands where the first of its keys does. Lists of tables count from 0.

    Parameters
    ----------
    text : str
        A document that `tomllib` accepts; of any other, the lines up to what is wrong.
    """
    scanner = _Scanner(text)
    with suppress(IndexError, RecursionError, ValueError):  # not TOML from there on: the lines so far are right
        scanner.scan()
    return scanner.lines


def last_key(text: str) -> tuple[Location, int]:
    """Location and line of the key or element at which a document is broken off."""
    return list(key_lines(text).items())[-1]


class _Scanner:
    def __init__(self, text: str) -> None:
        self.tokens = _tokens(text)
        self.next = 0
        self.lines: dict[Location, int] = {(): 1}
        self.sizes: dict[Location, int] = {}  # of the lists of tables

    def scan(self) -> None:
        table: Location = ()
        while self.next < len(self.tokens):
            if self._at("["):
                table = self._header()
            elif not self._skip("\n"):
                self._pair(table)

    def _at(self, mark: str) -> bool:
        return self.next < len(self.tokens) and self.tokens[self.next].text == mark

    def _skip(self, mark: str) -> bool:
        found = self._at(mark)
        self.next += found
        return found

    def _header(self) -> Location:
        line = self.tokens[self.next].line
        self._skip("[")
        is_list = self._skip("[")
        *parents, last = self._key()
        table: Location = ()
        for part in parents:
            table = self._inside((*table, part), line)
        table = (*table, last)
        if is_list:
            self.lines.setdefault(table, line)
            self.sizes[table] = self.sizes.get(table, 0) + 1
            table = (*table, self.sizes[table] - 1)
        self.lines[table] = line
        self.next += 1 + is_list
        return table

    def _inside(self, table: Location, line: int) -> Location:
        """The table that a part of a header means: of a list of tables, the last."""
        self.lines.setdefault(table, line)
        return (*table, self.sizes[table] - 1) if table in self.sizes else table

    def _pair(self, table: Location) -> None:
        line = self.tokens[self.next].line
        for part in self._key():
            table = (*table, part)
            self.lines.setdefault(table, line)
        self.next += 1  # the equals sign
        self._value(table)

    def _key(self) -> list[str]:
        parts = [_name(self.tokens[self.next].text)]
        self.next += 1
        while self._skip("."):
            parts.append(_name(self.tokens[self.next].text))
            self.next += 1
        return parts

    def _value(self, location: Location) -> None:
        if self._skip("["):
            self._elements(location)
        elif self._skip("{"):
            while not self._skip("}"):
                if not (self._skip(",") or self._skip("\n")):
                    self._pair(location)
        else:
            self.next += 1
            while self.next < len(self.tokens) and self.tokens[self.next].text not in {"\n", ",", "]", "}"}:
                self.next += 1

    def _elements(self, location: Location) -> None:
        index = 0
        while not self._skip("]"):
            if self._skip(","):
                index += 1
            elif not self._skip("\n"):
                self.lines[(*location, index)] = self.tokens[self.next].line
                self._value((*location, index))


def _tokens(text: str) -> list[_Token]:
    tokens, line = [], 1
    for match in TOKEN.finditer(text):
        if match.lastgroup != "blank":
            tokens.append(_Token(match[0], line))
        line += match[0].count("\n")
    return tokens


def _name(token: str) -> str:
    return next(iter(tomllib.loads(f"{token} = 0"))) if token[0] in "\"'" else token
