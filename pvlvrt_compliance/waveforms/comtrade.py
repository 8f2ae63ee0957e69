"""COMTRADE, IEEE C37.111-2013 / IEC 60255-24:2013, with FLOAT32 data."""

import math
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.texts import one_line
from pvlvrt_compliance.waveforms.container import STATUS_CHANNELS, Segment, Waveforms, unit_of

EPOCH = datetime(2000, 1, 1, tzinfo=UTC)
"""Instant of t = 0 of a record that has no date."""

_FLOAT32_MAX = "3.402823466E+38"
_BITS_A_WORD = 16
_LARGEST_STAMP = 2**32 - 2  # 2**32 - 1 says that the time stamp is missing
_LONGEST_NAME = 64
_ROWS_AT_HAND = 2048
"""Rows that are filled channel by channel while a processor has all of them at hand: some 200 kB."""


def write_comtrade(
    waveforms: Waveforms,
    stem: Path,
    *,
    station: str,
    device: str,
    frequency_hz: float,
    start: datetime | None,
    trigger_s: float | None = None,
) -> list[Path]:
    """Write a record as ``<stem>.cfg`` and ``<stem>.dat``.

    Values are primary, in the unit that the end of a channel's name says, without scaling. Time is told by the sampling
    rates: every segment has its line; where a segment begins neither one of its own steps nor one of those before it
    after the last sample, one line more holds for the single step between. The time stamps of the samples, whole
    microseconds (or powers of ten of them when a record is longer than these can count), say the same more coarsely.

    Parameters
    ----------
    waveforms : Waveforms
        The record; the channels of `STATUS_CHANNELS` become status channels, high from 0.5 up.
    stem : Path
        Path without extension.
    station, device : str
        Where and by what the record was made; commas and line breaks become spaces.
    frequency_hz : float
        Nominal frequency (Hz).
    start : datetime or None
        Instant of t = 0, in UTC unless it says otherwise; None stands for `EPOCH`, so that the same record gives the
        same bytes.
    trigger_s : float, optional
        Time of the trigger (s), for instance the start of the sag; the first sample by default.

    Returns
    -------
    list of Path
        The files written, the configuration first.

    Raises
    ------
    OSError
        When a file cannot be written.
    """
    analog = [name for name in waveforms.names if name not in STATUS_CHANNELS]
    status = [name for name in waveforms.names if name in STATUS_CHANNELS]
    multiplier = _time_multiplier(waveforms.end_s - waveforms.t0_s)
    lines = [
        f"{_clean(station)},{_clean(device)},2013",
        f"{len(analog) + len(status)},{len(analog)}A,{len(status)}D",
        *(_analog_line(number, name) for number, name in enumerate(analog, start=1)),
        *(f"{number},{name},{_phase(name)},,0" for number, name in enumerate(status, start=1)),
        f"{frequency_hz:g}",
        *_rate_lines(waveforms),
        _stamp(start, waveforms.t0_s),
        _stamp(start, waveforms.t0_s if trigger_s is None else trigger_s),
        "FLOAT32",
        f"{multiplier}",
        "0,0",
        # Time quality: a simulated record has no clock (F); leap seconds: not known (3).
        "F,3" if start is None else "0,3",
    ]
    cfg, dat = (stem.with_name(f"{stem.name}.{extension}") for extension in ("cfg", "dat"))
    cfg.write_bytes("".join(f"{line}\r\n" for line in lines).encode("utf-8"))
    _write_samples(waveforms, dat, analog, status, multiplier)
    return [cfg, dat]


def _clean(text: str) -> str:
    return one_line(text).replace(",", " ")[:_LONGEST_NAME]


def _phase(name: str) -> str:
    """Phase letter of a channel: the word before the unit, where that is a, b or c."""
    words = name.split("_")
    return words[-2].upper() if len(words) > 2 and words[-2] in {"a", "b", "c"} else ""


def _analog_line(number: int, name: str) -> str:
    return f"{number},{name},{_phase(name)},,{unit_of(name)},1,0,0,-{_FLOAT32_MAX},{_FLOAT32_MAX},1,1,P"


def _rate_lines(waveforms: Waveforms) -> list[str]:
    """Number of sampling rates, then each with the last sample that it leads to."""
    # repr keeps the rate to 1 part in 1e16: 1e-9 s after 1e6 s and more.
    rates: list[tuple[float, int]] = []
    last = 0
    previous: Segment | None = None
    for segment in waveforms:
        if previous is not None and _is_step(segment.t0_s - previous.end_s, previous.dt_s):
            rates[-1] = (rates[-1][0], last + 1)
        elif previous is not None and not _is_step(segment.t0_s - previous.end_s, segment.dt_s):
            rates.append((1 / (segment.t0_s - previous.end_s), last + 1))
        last += len(segment)
        if not rates or rates[-1][1] < last:
            rates.append((1 / segment.dt_s, last))
        previous = segment
    return [f"{len(rates)}", *(f"{rate!r},{end}" for rate, end in rates)]


def _is_step(gap_s: float, dt_s: float) -> bool:
    return math.isclose(gap_s, dt_s, abs_tol=1e-10)


def _stamp(start: datetime | None, t_s: float) -> str:
    origin = EPOCH if start is None else start
    instant = origin.replace(tzinfo=UTC) if origin.tzinfo is None else origin.astimezone(UTC)
    return (instant + timedelta(seconds=t_s)).strftime("%d/%m/%Y,%H:%M:%S.%f")


def _time_multiplier(length_s: float) -> int:
    """Microseconds that one count of the 32-bit time stamps stands for."""
    multiplier = 1
    while length_s * 1e6 / multiplier > _LARGEST_STAMP:
        multiplier *= 10
    return multiplier


def _write_samples(waveforms: Waveforms, path: Path, analog: list[str], status: list[str], multiplier: int) -> None:
    words = math.ceil(len(status) / _BITS_A_WORD)
    row = np.dtype([("n", "<u4"), ("t", "<u4"), ("analog", "<f4", (len(analog),)), ("status", "<u2", (words,))])
    number = 1
    with path.open("wb") as file:
        for segment in waveforms:
            rows = np.empty(len(segment), dtype=row)
            rows["n"] = np.arange(number, number + len(segment))
            rows["t"] = np.rint((segment.t_s - waveforms.t0_s) * (1e6 / multiplier))
            rows["status"] = _status_words(segment, status, words)
            channels = [segment[name] for name in analog]
            for first in range(0, len(segment), _ROWS_AT_HAND):
                block = slice(first, first + _ROWS_AT_HAND)
                values = rows["analog"][block]
                for column, samples in enumerate(channels):
                    values[:, column] = samples[block]
            file.write(rows.view(np.uint8).data)
            number += len(segment)


def _status_words(segment: Segment, status: list[str], words: int) -> NDArray[np.uint16]:
    packed = np.zeros((len(segment), words), dtype=np.uint16)
    for index, name in enumerate(status):
        word, bit = divmod(index, _BITS_A_WORD)
        packed[:, word] |= (segment[name] >= 0.5).astype(np.uint16) << np.uint16(bit)
    return packed
