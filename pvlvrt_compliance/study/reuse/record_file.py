"""One record as a file: a head with its key and checksums, then the samples as they are.

Nothing in it is code: numbers and texts. The checksums find damage, not malice.
"""

import json
import struct
import uuid
import zlib
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.waveforms import Segment, Waveforms

_MAGIC = b"pvlvrt-check record 1\n"
_HEAD = struct.Struct("<III")  # length of the table, its checksum, that of the samples
_LONGEST_TABLE = 1 << 26  # bytes: no table is nearly as long
_BYTES = 8  # of a sample

UNFINISHED = ".part"
"""How the name of a file ends that is being written."""


class Kept(NamedTuple):
    """A record, and what the controller had to say in its run."""

    waveforms: Waveforms
    notes: tuple[str, ...] = ()


class Reused(Waveforms):
    """A record of an earlier run."""


class DamagedError(Exception):
    """A file does not hold what was written."""


def write_record(file: Path, key: str, kept: Kept) -> None:
    """Write a record so that others see all of it or nothing.

    Raises
    ------
    OSError
        When it cannot be written; nothing of it is left then.
    """
    unfinished = file.with_name(f"{uuid.uuid4().hex}{UNFINISHED}")
    try:
        with unfinished.open("xb") as stream:
            _write(stream, key, kept)
        unfinished.replace(file)
    except BaseException:
        with suppress(OSError):
            unfinished.unlink()
        raise


def read_record(file: Path, key: str) -> Kept:
    """Read a record, each channel as it was simulated, to the bit.

    Raises
    ------
    DamagedError
        When the file is not what `write_record` has written for this key.
    OSError
        When it cannot be read.
    """
    with file.open("rb", buffering=0) as stream:
        table, checksum = _table_in(stream)
        if table["key"] != key:
            raise DamagedError("it is another record's")
        reader = _Reader(stream)
        parts = [reader.segment(table["names"], segment) for segment in table["segments"]]
        if reader.checksum != checksum or stream.read(1):
            raise DamagedError("its samples are not what was written")
    count = table["settling"]
    return Kept(Reused(tuple(parts[count:]), tuple(parts[:count]), table["tripped_at_s"]), tuple(table["notes"]))


def size_of(kept: Kept) -> int:
    """Bytes that a record takes at most, but for its head."""
    parts = (*kept.waveforms.settling, *kept.waveforms.segments)
    return sum(_BYTES * len(part) * len(part.channels) for part in parts)


def _write(stream: BinaryIO, key: str, kept: Kept) -> None:
    waveforms = kept.waveforms
    parts = (*waveforms.settling, *waveforms.segments)
    columns = [[_bits(samples) for samples in part.channels.values()] for part in parts]
    steady = [[k for k, samples in enumerate(part) if _is_steady(samples)] for part in columns]
    table = {
        "key": key,
        "notes": kept.notes,
        "names": waveforms.names,
        "settling": len(waveforms.settling),
        "tripped_at_s": waveforms.tripped_at_s,
        "segments": [
            {"t0_s": part.t0_s, "dt_s": part.dt_s, "rows": len(part), "steady": same}
            for part, same in zip(parts, steady, strict=True)
        ],
    }
    text = json.dumps(table).encode()
    stream.write(_MAGIC + bytes(_HEAD.size) + text)
    checksum = 0
    for part, same in zip(columns, steady, strict=True):
        for k, samples in enumerate(part):
            stored = (samples[:1] if k in same else samples).data
            stream.write(stored)
            checksum = zlib.crc32(stored, checksum)
    stream.seek(len(_MAGIC))
    stream.write(_HEAD.pack(len(text), zlib.crc32(text), checksum))


def _bits(samples: NDArray[np.float64]) -> NDArray[np.int64]:
    return np.ascontiguousarray(samples, dtype=np.float64).view(np.int64)


def _is_steady(bits: NDArray[np.int64]) -> bool:
    """Whether all samples are the same to the bit: one of them is kept then."""
    return len(bits) > 1 and bits[0] == bits[-1] and bool((bits == bits[0]).all())


def _table_in(stream: Any) -> tuple[dict[str, Any], int]:
    begin = stream.read(len(_MAGIC) + _HEAD.size)
    if not begin.startswith(_MAGIC) or len(begin) != len(_MAGIC) + _HEAD.size:
        raise DamagedError("not a record" if begin else "empty")
    length, of_table, of_samples = _HEAD.unpack_from(begin, len(_MAGIC))
    text = stream.read(min(length, _LONGEST_TABLE))
    if len(text) != length or zlib.crc32(text) != of_table:
        raise DamagedError("its head is not what was written")
    return json.loads(text), of_samples


class _Reader:
    """Samples of a file one channel after the other."""

    def __init__(self, stream: Any) -> None:
        self._stream = stream
        self.checksum = 0

    def segment(self, names: Sequence[str], of: dict[str, Any]) -> Segment:
        samples = np.empty((len(names), of["rows"]))
        steady = set(of["steady"])
        for k, row in enumerate(samples):
            stored = row[:1] if k in steady else row
            self._fill(stored)
            if k in steady:
                row.view(np.int64)[:] = row.view(np.int64)[0]
        return Segment(of["t0_s"], of["dt_s"], dict(zip(names, samples, strict=True)))

    def _fill(self, samples: NDArray[np.float64]) -> None:
        if not len(samples):
            return
        memory = samples.data.cast("B")
        for part in _filled(self._stream, memory):
            if not part:
                raise DamagedError("it ends too early")
        self.checksum = zlib.crc32(memory, self.checksum)


def _filled(stream: Any, memory: memoryview) -> Iterator[int]:
    """Fill memory from a stream, which may give less at a time; the numbers of bytes as they come."""
    while memory:
        count = stream.readinto(memory)
        yield count
        memory = memory[count:]
