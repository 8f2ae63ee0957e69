"""The configuration of a COMTRADE recording (``.cfg``, a piece of ``.cff``): IEEE C37.111 of 1991, 1999 and 2013."""

import math
import re
from collections.abc import Sequence
from typing import NamedTuple

from pvlvrt_compliance.waveforms.columns import DamagedError, number

FORMS = ("ASCII", "BINARY", "BINARY32", "FLOAT32")

_OLDEST = "1991"
_STATIONS, _COUNTS = 2, 3  # fields of the first two lines, at least
_OF_ANALOG, _OF_STATUS = 7, 2  # fields of the line of a channel that are needed
_PRIMARY, _SECONDARY, _WHICH = 10, 11, 12  # where the ratio stands, which came with the second edition
_DIGITS_OF_MICROSECONDS = 6
_MOST_RATES = 100_000  # lines of rates (chosen): a recorder has a handful, a file of ours one for each change
_PIECE = re.compile(rb"^--- *file type: *(CFG|INF|HDR|DAT)\b[^\r\n]*---[ \t]*\r?\n", re.MULTILINE | re.IGNORECASE)
_NO_PIECES = "it has no lines that say where configuration (CFG) and samples (DAT) begin"
_COUNT = re.compile(r"[0-9]{1,9}")


class Analog(NamedTuple):
    """A channel with numbers: what is stored, times ``gain`` plus ``offset``, is in ``unit``, of the primary side."""

    name: str
    unit: str
    gain: float
    offset: float


class Rate(NamedTuple):
    """A sampling rate (Hz; 0: the time stamps tell) and the number of the last sample that it leads to."""

    rate_hz: float
    last: int


class Header(NamedTuple):
    """What a configuration says."""

    edition: str
    analog: tuple[Analog, ...]
    status: tuple[str, ...]  # names
    rates: tuple[Rate, ...]
    by_stamps: bool  # whether the time stamps of the samples tell the time
    stamp_s: float  # what one count of a time stamp is
    form: str  # of `FORMS`

    @property
    def samples(self) -> int:
        """How many there are."""
        return self.rates[-1].last

    @property
    def names(self) -> list[str]:
        """Names of all channels, those with numbers first."""
        return [*(channel.name for channel in self.analog), *self.status]


def read_header(content: bytes) -> Header:
    """A configuration, UTF-8 or Latin-1.

    Raises
    ------
    DamagedError
        When it is none, with the line.
    """
    lines = _Lines(content)
    stations = lines.fields("station and device", _STATIONS)
    edition = stations[2] if len(stations) > _STATIONS and stations[2] else _OLDEST
    counts = lines.fields("the numbers of channels", _COUNTS)
    analog_count, status_count = (_channels(lines, counts, letter) for letter in "AD")
    analog = tuple(_analog(lines) for _ in range(analog_count))
    status = tuple(lines.fields("a status channel", _OF_STATUS)[1] for _ in range(status_count))
    lines.fields("the frequency of the grid", 1)
    stated = lines.whole(lines.fields("the number of sampling rates", 1)[0], "the number of sampling rates")
    if stated > _MOST_RATES:
        raise lines.damaged(f"more than {_MOST_RATES} sampling rates")
    rates = _rates(lines, max(stated, 1))
    base_s = min(_stamp_s(lines.fields(f"the instant of the {what}", 1)) for what in ("first sample", "trigger"))
    form = lines.fields("the form of the samples", 1)[0].upper()
    if form not in FORMS:
        raise lines.damaged(f"the form of the samples is none of {', '.join(FORMS)}")
    multiplier = 1.0
    if edition != _OLDEST and lines.more and lines.more[0].strip():
        multiplier = lines.value(lines.fields("the factor of the time stamps", 1)[0], "the factor of the time stamps")
        if multiplier <= 0:
            raise lines.damaged("the factor of the time stamps must be above zero")
    return Header(edition, analog, status, rates, stated == 0, base_s * multiplier, form)


def pieces_of(content: bytes) -> tuple[bytes, bytes]:
    """Configuration and samples of a recording in one file (``.cff``).

    Raises
    ------
    DamagedError
        When it has not both.
    """
    marks = list(_PIECE.finditer(content))
    if not marks:
        raise DamagedError(_NO_PIECES)
    ends = [*(mark.start() for mark in marks[1:]), len(content)]
    pieces = {mark[1].upper(): content[mark.end() : end] for mark, end in zip(marks, ends, strict=True)}
    if not pieces.keys() >= {b"CFG", b"DAT"}:
        raise DamagedError(_NO_PIECES)
    return pieces[b"CFG"].rstrip(b"\r\n"), pieces[b"DAT"]


class _Lines:
    """The lines of a configuration, one after the other."""

    def __init__(self, content: bytes) -> None:
        try:
            text = content.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = content.decode("latin-1")
        self._lines = text.replace("\x1a", "").split("\n")  # some systems end a text with that character
        self.at = 0

    @property
    def more(self) -> Sequence[str]:
        """Those that are left."""
        return self._lines[self.at :]

    def fields(self, what: str, least: int) -> list[str]:
        """The fields of the next line, which are so many at least."""
        if self.at == len(self._lines):
            raise DamagedError(f"it ends before {what}, which line {self.at + 1} should have")
        self.at += 1
        found = [field.strip() for field in self._lines[self.at - 1].split(",")]
        if len(found) < least:
            raise self.damaged(
                f"{what} needs {least} fields, and there {'is' if len(found) == 1 else 'are'} {len(found)}"
            )
        return found

    def damaged(self, text: str) -> DamagedError:
        """Something that is wrong in the line that was read last."""
        return DamagedError(f"line {self.at}: {text}")

    def value(self, text: str, what: str, default: float | None = None) -> float:
        """A finite number."""
        if not text and default is not None:
            return default
        found = number(text)
        if found is None or not math.isfinite(found):
            raise self.damaged(f"{what} is no number")
        return found

    def whole(self, text: str, what: str) -> int:
        """A count."""
        if not _COUNT.fullmatch(text):
            raise self.damaged(f"{what} is no whole number below 1e9")
        return int(text)


def _channels(lines: _Lines, counts: Sequence[str], letter: str) -> int:
    """How many channels there are of a kind, ``4A``."""
    stated = next((text for text in counts[1:3] if text.upper().endswith(letter)), None)
    if stated is None:
        raise lines.damaged(f"the number of channels {letter} is missing")
    count = lines.whole(stated[:-1].strip(), f"the number of channels {letter}")
    if count > len(lines.more):
        raise lines.damaged(f"there are more channels {letter} than lines after it")
    return count


def _analog(lines: _Lines) -> Analog:
    fields = lines.fields("a channel", _OF_ANALOG)
    gain, offset = lines.value(fields[5], "its factor a"), lines.value(fields[6], "its offset b", 0.0)
    factor = _to_primary(lines, fields)
    return Analog(fields[1], fields[4], factor * gain, factor * offset)


def _to_primary(lines: _Lines, fields: Sequence[str]) -> float:
    """What makes a value that of the primary side of its transformer."""
    if len(fields) <= _WHICH or fields[_WHICH].upper() != "S":
        return 1.0
    primary, secondary = (lines.value(fields[k], "the ratio of the transformer") for k in (_PRIMARY, _SECONDARY))
    if primary <= 0 or secondary <= 0:
        raise lines.damaged("the values are secondary (S), and there is no ratio of the transformer above zero")
    return primary / secondary


def _rates(lines: _Lines, count: int) -> tuple[Rate, ...]:
    found: list[Rate] = []
    for _ in range(count):
        rate, last, *_ = lines.fields("a sampling rate and its last sample", 2)
        one = Rate(lines.value(rate, "a sampling rate"), lines.whole(last, "the last sample of a rate"))
        if one.rate_hz < 0 or one.last <= (found[-1].last if found else 0):
            raise lines.damaged("sampling rates must not be negative, nor end before those before them")
        found.append(one)
    return tuple(found)


def _stamp_s(fields: Sequence[str]) -> float:
    """What time stamps count in: microseconds, or nanoseconds where an instant is told by them."""
    fraction = fields[-1].rpartition(".")[2]
    return 1e-9 if fraction.isdigit() and len(fraction) > _DIGITS_OF_MICROSECONDS and "." in fields[-1] else 1e-6
