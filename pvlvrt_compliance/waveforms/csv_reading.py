"""Reading CSV as instruments, spreadsheets and simulators write it."""

import codecs
import csv
import io
from collections.abc import Iterator, Sequence
from itertools import chain

import numpy as np

from pvlvrt_compliance.ordinary_file import other_encoding
from pvlvrt_compliance.waveforms.columns import Chosen, Column, DamagedError, chosen, in_units, number
from pvlvrt_compliance.waveforms.container import Samples

TIME = "t_s"

_SEPARATORS = (";", "\t", ",")  # the first of these that a header has parts its names
_SAID_BY_A_SPREADSHEET = "sep="  # a line before the header that names the separator
_OF_ROWS = ";"


def read_csv(content: bytes, wanted: Sequence[str] | None) -> tuple[Samples, dict[str, Column]]:
    """Times (s) and columns of a text with a header.

    The header's separator is ``;``, a tab or ``,``; with the former two, numbers may have a decimal comma. Names and
    numbers may be quoted, lines may end in a separator, and the text is UTF-8, with or without a mark, or Latin-1.

    Parameters
    ----------
    content : bytes
    wanted : sequence of str or None
        Names of columns besides that of the times, `TIME`; None: all.

    Raises
    ------
    DamagedError
        When it cannot be read, with line and column where it can be said.
    NoChannelError
        When there is no column of a name.
    """
    lines = _Lines(content)
    names = lines.names
    if TIME not in names:
        raise DamagedError(f"line {lines.number}: there is no column {TIME}, of the times in seconds")
    times, *others = chosen(names, [TIME, *(name for name in wanted if name != TIME)] if wanted is not None else None)
    if wanted is None:
        everything = [times, *others]
        times = next(each for each in everything if each.name == TIME)
        others = [each for each in everything if each.name != TIME]
    values = _Rows(lines, [times, *others]).values()
    with np.errstate(over="ignore"):  # what is not finite is told where it is used
        columns = {
            each.name: in_units(np.ascontiguousarray(values[:, k]), each.unit) for k, each in enumerate(others, start=1)
        }
    return np.ascontiguousarray(values[:, 0]), columns


def read_as_written(content: bytes, times: Sequence[str]) -> tuple[Samples, dict[str, Samples]]:
    """Times (s) and all columns of a text with a header, numbers as they stand there, whatever units names end in.

    Parameters
    ----------
    content : bytes
        As of `read_csv`.
    times : sequence of str
        What the column of the times may be called, in small letters; the first that is there, in any letters, is it.
        It is among the columns, too.

    Raises
    ------
    DamagedError
        When it cannot be read, or two columns have one name.
    """
    lines = _Lines(content)
    by_name = {name: k for k, name in reversed(list(enumerate(lines.names))) if name}
    twice = next((k for k, name in enumerate(lines.names) if name and by_name[name] != k), None)
    if twice is not None:
        said = f"columns {by_name[lines.names[twice]] + 1} and {twice + 1} have the same name"
        raise DamagedError(f"{said}; which is meant is not known")
    own = next((name for wanted in times for name in by_name if name.casefold() == wanted), None)
    if own is None:
        known = f"{', '.join(times[:-1])} or {times[-1]}"
        raise DamagedError(f"line {lines.number}: there is no column of the times in seconds, called {known}")
    columns = [Chosen(name, place, "") for name, place in sorted(by_name.items(), key=lambda each: each[1])]
    values = _Rows(lines, columns).values()
    found = {each.name: np.ascontiguousarray(values[:, k]) for k, each in enumerate(columns)}
    return found[own], found


class _Lines:
    """A text as lines, its header read: the names of its columns, those without a name at the end left out."""

    def __init__(self, content: bytes) -> None:
        content, encoding = content.removeprefix(codecs.BOM_UTF8), _encoding(content)
        self._stream = io.TextIOWrapper(io.BytesIO(content), encoding=encoding, newline=None)
        self.number = 0
        line = self._next()
        said = line.strip().lower()
        if said.startswith(_SAID_BY_A_SPREADSHEET) and len(said) == len(_SAID_BY_A_SPREADSHEET) + 1:
            line = self._next()
        self.separator = _separator(line)
        self.names = [name.strip() for name in self._parted(line)]
        while self.names and not self.names[-1]:
            self.names.pop()

    def fields(self) -> Iterator[list[str]]:
        """The fields of every line that has any, as many as there are names.

        Raises
        ------
        DamagedError
            When a line has another number of them.
        """
        separator, count = self.separator, len(self.names)
        for line in self._stream:
            self.number += 1
            text = line.rstrip("\n")
            if not text.strip(f" \t{separator}"):
                continue
            found = self._parted(text) if '"' in text else text.split(separator)
            if len(found) != count:
                self._refuse_other_count(found, count)
            yield found

    def _refuse_other_count(self, found: list[str], count: int) -> None:
        """A separator or several at the end are no field; anything else is one too many or too few."""
        if len(found) > count and not any(field.strip() for field in found[count:]):
            return
        hint = ""
        if self.separator == "," and len(found) > count:
            hint = "; numbers with a decimal comma need another separator, ;, or quotation marks"
        raise DamagedError(f"line {self.number} has {len(found)} fields where the header has {count}{hint}")

    def _next(self) -> str:
        self.number += 1
        return self._stream.readline().rstrip("\n")

    def _parted(self, line: str) -> list[str]:
        try:
            return next(csv.reader([line], delimiter=self.separator), [])
        except csv.Error:
            raise DamagedError(f"line {self.number} is no line of CSV") from None


class _Rows:
    """The numbers of some columns."""

    def __init__(self, lines: _Lines, columns: Sequence[Chosen]) -> None:
        self._lines, self._columns = lines, columns
        self._comma_in, self._point_in = 0, 0  # the first line that has one
        self._last: list[str] = []

    def values(self) -> Samples:
        """All of them, shape (rows, columns).

        Raises
        ------
        DamagedError
            When one is none.
        """
        rows = self._rows()
        first = next(rows, None)
        if first is None:
            raise DamagedError("a recording needs two samples at least, and there is none")
        try:
            found: Samples = np.loadtxt(
                chain([first], rows), delimiter=_OF_ROWS, ndmin=2, dtype=np.float64, comments=None
            )
        except ValueError:
            raise DamagedError(self._no_number()) from None
        if self._comma_in and self._point_in:
            said = f"line {self._comma_in} has a decimal comma and line {self._point_in} a decimal point"
            raise DamagedError(f"{said}; what a number means is not known")
        return found

    def _rows(self) -> Iterator[str]:
        places = [each.place for each in self._columns]
        for fields in self._lines.fields():
            self._last = picked = [fields[place] for place in places]
            row = _OF_ROWS.join(picked)
            if "," in row:
                self._comma_in = self._comma_in or self._lines.number
                row = row.replace(",", ".")
            elif "." in row:
                self._point_in = self._point_in or self._lines.number
            yield row

    def _no_number(self) -> str:
        """Which field of the last line is none; numbers have no separator of thousands."""
        for each, text in zip(self._columns, self._last, strict=True):
            if number(text.replace(",", ".")) is None:
                what = "is empty" if not text.strip() else "is no number"
                return f"line {self._lines.number}, column {each.place + 1} {what}"
        return f"line {self._lines.number} is no line of numbers"


def _encoding(content: bytes) -> str:
    other = other_encoding(content)
    if other is not None:
        raise DamagedError(f"not UTF-8 text: it is {other}; save it as UTF-8")
    if b"\0" in content:
        raise DamagedError("no text: it has bytes that are zero")
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8"


def _separator(header: str) -> str:
    outside = "".join(header.split('"')[::2])
    return next((each for each in _SEPARATORS if each in outside), ",")
