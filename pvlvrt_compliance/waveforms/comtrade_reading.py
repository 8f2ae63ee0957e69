"""The samples of a COMTRADE recording (``.dat``): as text, whole numbers of 16 or 32 bits, or floating point."""

import io
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.waveforms.columns import Chosen, Column, DamagedError, chosen, in_units, number, unit_by_name
from pvlvrt_compliance.waveforms.comtrade_header import Header
from pvlvrt_compliance.waveforms.container import Samples

_BITS_A_WORD = 16
_NO_STAMP = 2**32 - 1
_LARGEST = float(np.finfo(np.float32).max)
_TYPES = {"BINARY": "<i2", "BINARY32": "<i4", "FLOAT32": "<f4"}
_MISSING = {"BINARY": -(2**15), "BINARY32": -(2**31)}
_MISSING_OF_THE_FIRST = -1  # of 16 bits, by the edition of 1991
_MISSING_IN_TEXT = ("", "99999")
_BEFORE = 2  # number and time stamp of a sample come before its channels


class _Read(NamedTuple):
    """Samples as they are stored."""

    numbers: Samples  # from 1
    stamps: Samples  # counts; NaN: missing
    columns: list[Samples]  # NaN: missing


def read_samples(header: Header, content: bytes, wanted: Sequence[str] | None) -> tuple[Samples, dict[str, Column]]:
    """Times (s) and channels, voltages and currents in V and A of the primary side.

    The sampling rates tell the time; without any, the time stamps do. What is missing is NaN.

    Parameters
    ----------
    header : Header
    content : bytes
        Of the file with the samples.
    wanted : sequence of str or None
        Names of channels; None: all that have one.

    Raises
    ------
    DamagedError
        When it does not hold what the configuration says.
    NoChannelError
        When there is no channel of a name.
    """
    channels = chosen(header.names, wanted, "channel")
    with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is told where it is used
        read = _text(header, content, channels) if header.form == "ASCII" else _binary(header, content, channels)
        return _times(header, read), _columns(header, channels, read)


def _columns(header: Header, channels: Sequence[Chosen], read: _Read) -> dict[str, Column]:
    analog = len(header.analog)
    columns = {}
    for each, samples in zip(channels, read.columns, strict=True):
        if each.place < analog:
            of = header.analog[each.place]
            columns[each.name] = in_units(of.gain * samples + of.offset, of.unit or unit_by_name(of.name))
        else:
            columns[each.name] = Column(samples, "")
    return columns


def _times(header: Header, read: _Read) -> Samples:
    """Instants of the samples (s)."""
    by_stamps = header.by_stamps & np.isfinite(read.stamps)
    lasts = np.array([rate.last for rate in header.rates], dtype=np.float64)
    rates = np.array([rate.rate_hz for rate in header.rates])
    firsts = np.array([1.0, *lasts[:-1]])  # a rate holds from the last sample of the one before
    steps = np.divide(1.0, rates, out=np.full(len(rates), np.nan), where=rates > 0)
    begins = np.concatenate([[0.0], np.cumsum((lasts - firsts) * steps)[:-1]])
    of = np.minimum(np.searchsorted(lasts, read.numbers), len(lasts) - 1)
    by_rates = begins[of] + (read.numbers - firsts[of]) * steps[of]
    times: Samples = np.where(by_stamps, read.stamps * header.stamp_s, by_rates)
    if not np.isfinite(times).all():
        number_of = int(read.numbers[np.flatnonzero(~np.isfinite(times))[0]])
        raise DamagedError(f"sample {number_of} has neither a sampling rate nor a time stamp")
    return times


def _binary(header: Header, content: bytes, channels: Sequence[Chosen]) -> _Read:
    analog, form = len(header.analog), header.form
    words = -(-len(header.status) // _BITS_A_WORD)
    row = np.dtype([("n", "<u4"), ("t", "<u4"), ("analog", _TYPES[form], (analog,)), ("status", "<u2", (words,))])
    there = len(content) // row.itemsize
    _refuse_fewer(there, header)
    rows = np.frombuffer(content, dtype=row, count=header.samples)
    columns = []
    for each in channels:
        if each.place < analog:
            columns.append(_with_gaps(rows["analog"][:, each.place], header))
        else:
            word, bit = divmod(each.place - analog, _BITS_A_WORD)
            columns.append(((rows["status"][:, word] >> np.uint16(bit)) & np.uint16(1)).astype(np.float64))
    stamps = rows["t"].astype(np.float64)
    stamps[rows["t"] == _NO_STAMP] = np.nan
    return _Read(rows["n"].astype(np.float64), stamps, columns)


def _with_gaps(stored: NDArray[np.generic], header: Header) -> Samples:
    """Numbers as they are stored, NaN where one is missing."""
    samples = stored.astype(np.float64)
    if header.form == "FLOAT32":
        samples[~(np.abs(samples) < _LARGEST)] = np.nan
        return samples
    first = header.form == "BINARY" and header.edition == "1991"
    samples[samples == (_MISSING_OF_THE_FIRST if first else _MISSING[header.form])] = np.nan
    return samples


def _text(header: Header, content: bytes, channels: Sequence[Chosen]) -> _Read:
    rows = _Rows(header, content, channels)
    values = np.fromiter(rows.values(), dtype=np.float64)
    columns = values.reshape(-1, len(channels) + _BEFORE).T
    _refuse_fewer(columns.shape[1], header)
    numbers, stamps, *others = (np.ascontiguousarray(column) for column in columns)
    return _Read(numbers, stamps, others)


class _Rows:
    """Samples of a text, one a line."""

    def __init__(self, header: Header, content: bytes, channels: Sequence[Chosen]) -> None:
        self._stream = io.TextIOWrapper(io.BytesIO(content), encoding="latin-1", newline=None)
        self._header = header
        self._fields = _BEFORE + len(header.names)
        self._places = [_BEFORE + each.place for each in channels]

    def values(self) -> Iterator[float]:
        """Number, time stamp and channels of each sample."""
        left = self._header.samples
        for line_number, line in enumerate(self._stream, start=1):
            fields = line.replace("\x1a", "").strip().split(",")
            if fields == [""]:
                continue
            if not left:
                return
            left -= 1
            if len(fields) != self._fields:
                said = f"has {len(fields)} fields where the configuration has {self._fields}"
                raise DamagedError(f"line {line_number} of the samples (.dat) {said}")
            yield self._value(fields, 0, line_number, is_needed=True)
            yield self._value(fields, 1, line_number)
            for place in self._places:
                yield self._value(fields, place, line_number)

    def _value(self, fields: Sequence[str], place: int, line_number: int, *, is_needed: bool = False) -> float:
        text = fields[place].strip()
        if not text and not is_needed:
            return np.nan
        if text in _MISSING_IN_TEXT and place >= _BEFORE and self._header.edition != "1991":
            return np.nan
        found = number(text)
        if found is None or not abs(found) < np.inf:
            raise DamagedError(f"line {line_number}, column {place + 1} of the samples (.dat) is no number")
        return found


def _refuse_fewer(there: int, header: Header) -> None:
    if there < header.samples:
        raise DamagedError(f"it holds {there} of the {header.samples} samples that its configuration counts")
