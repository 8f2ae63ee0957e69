"""Reading a recording of any make: CSV or COMTRADE; several steps as segments."""

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

import numpy as np

from pvlvrt_compliance.errors import MeasurementError, UsageError, did_you_mean
from pvlvrt_compliance.ordinary_file import NotOrdinaryError, TooLargeError, content_of
from pvlvrt_compliance.waveforms.columns import PER_UNIT, Column, DamagedError, NoChannelError
from pvlvrt_compliance.waveforms.comtrade_header import pieces_of, read_header
from pvlvrt_compliance.waveforms.comtrade_reading import read_samples
from pvlvrt_compliance.waveforms.container import Samples, Segment, Waveforms, unit_of
from pvlvrt_compliance.waveforms.csv_reading import read_as_written, read_csv
from pvlvrt_compliance.waveforms.joining import window_on_one_grid

LARGEST_RECORD_BYTES = 1 << 30
"""Of a record that somebody names himself: what a computer of 4 GB reads (chosen)."""

_UNEVEN = 1e-3  # largest change from one step to the next within a segment, as a fraction of it
_OURS = re.compile(r"(u0?|i)_[abc]_(k?[va]|pu)")  # names of channels that every file may be told to have


def read_recording(path: Path, channels: Sequence[str]) -> Segment:
    """Read some channels of a CSV file (column ``t_s``) or of a COMTRADE file (``.cfg``, or ``.cff``).

    Of a record of several sampling steps, the samples on the grid of the coarsest.

    Raises
    ------
    UsageError
        When the file or a channel is not there, or the samples are not on a uniform grid.
    """
    return on_one_grid(read_waveforms(path, channels), path)


def on_one_grid(waveforms: Waveforms, path: Path) -> Segment:
    """A recording as one segment, on the grid of its coarsest.

    Raises
    ------
    UsageError
        When its segments do not fit each other.
    """
    first, last = waveforms.segments[0], waveforms.segments[-1]
    try:
        return window_on_one_grid(waveforms, first.t0_s, last.end_s + last.dt_s)
    except MeasurementError as error:
        raise UsageError(f"{path}: the samples are not evenly spaced in time ({error})") from None


def read_waveforms(path: Path, channels: Sequence[str] | None = None, *, within: Path | None = None) -> Waveforms:
    """Read a file, or some channels of it, with a segment for every change of the sampling step.

    Voltages and currents are in V and A, of a COMTRADE file those of the primary side: a column in kV, by the ending of
    its name, is that in V; what a configuration has as secondary values is multiplied by the ratio of the transformer.
    All of it must lie in or below the folder ``within``, where one is given.

    Raises
    ------
    UsageError
        As `read_recording`; segments may lie on grids of their own, but are evenly spaced. Also where one of our own
        channels is per unit, or in another unit than its name says.
    """
    t, columns = read_columns(path, channels, within=within)
    _refuse_other_units(path, columns)
    return in_segments(path, t, {name: column.samples for name, column in columns.items()})


def read_columns(
    path: Path,
    channels: Sequence[str] | None = None,
    *,
    most_bytes: int = LARGEST_RECORD_BYTES,
    within: Path | None = None,
) -> tuple[Samples, dict[str, Column]]:
    """Times (s) and columns of a file.

    Parameters
    ----------
    path : Path
    channels : sequence of str, optional
        Names; all by default.
    most_bytes : int
        How large it may be, and of COMTRADE each of its files.
    within : Path, optional
        Folder that all of it must lie in or below.

    Raises
    ------
    UsageError
        When the file cannot be read or a channel is not there. It never has what is in the file: whoever names a file
        for others to read learns nothing from it.
    """

    def content(file: Path) -> bytes:
        return content_of(file, most_bytes, within)

    try:
        with _told(path, most_bytes):
            if path.suffix.lower() == ".cff":
                configuration, samples = pieces_of(content(path))
                return read_samples(read_header(configuration), samples, channels)
            if path.suffix.lower() != ".cfg":
                return read_csv(content(path), channels)
            header = read_header(content(path))
            files = files_of(path)
            if len(files) < 2:
                raise DamagedError("there is no .dat file beside it")
            return read_samples(header, content(files[1]), channels)
    except NoChannelError as error:
        ours = [name for name in error.others if _OURS.fullmatch(name)]
        hint = did_you_mean(error.name, ours)
        raise UsageError(f"{path}: no channel {error.name!r} among its {len(error.others)}{hint}") from None


def read_evenly(path: Path, times: Sequence[str], *, most_bytes: int = LARGEST_RECORD_BYTES) -> Segment:
    """All columns of a CSV file of anybody's, numbers as they stand there, evenly spaced in time.

    Parameters
    ----------
    path : Path
    times : sequence of str
        What the column of the times (s) may be called, as of `csv_reading.read_as_written`.
    most_bytes : int
        How large it may be.

    Raises
    ------
    UsageError
        When it cannot be read, or the samples are not on one uniform grid.
    """
    with _told(path, most_bytes):
        t, columns = read_as_written(content_of(path, most_bytes, None), times)
    segments = in_segments(path, t, columns).segments
    if len(segments) > 1:
        where = f"from {segments[0].end_s:g} s on with another step than before"
        raise UsageError(f"{path}: the samples are not evenly spaced in time: they go on {where}")
    return segments[0]


def in_segments(path: Path, t: Samples, columns: Mapping[str, Samples]) -> Waveforms:
    """Samples with a segment for every change of their step.

    Raises
    ------
    UsageError
        When there are fewer than two, or the times are not those of a recording.
    """
    bounds = _bounds(t, path)
    return Waveforms(
        tuple(
            Segment(float(t[i]), _step(t[i:j], path), {name: x[i:j] for name, x in columns.items()})
            for i, j in pairwise(bounds)
        )
    )


@contextmanager
def _told(path: Path, most_bytes: int) -> Iterator[None]:
    """Have what is wrong with a file told with its name."""
    try:
        yield
    except TooLargeError:
        raise UsageError(f"{path}: larger than {most_bytes >> 20} MiB, which a recording may have") from None
    except (NotOrdinaryError, DamagedError) as error:
        reason = str(error).removeprefix("cannot be read: ")
        raise UsageError(f"{path}: cannot be read as a recording ({reason})") from None


def files_of(recording: Path) -> list[Path]:
    """A file, and of COMTRADE the one with the samples: first that whose ending is written in the same case."""
    if recording.suffix.lower() != ".cfg":
        return [recording]
    endings = (".dat", ".DAT") if recording.suffix.islower() else (".DAT", ".dat")
    samples = (recording.with_suffix(ending) for ending in endings)
    return [recording, *[file for file in samples if file.is_file()][:1]]


def _refuse_other_units(path: Path, columns: Mapping[str, Column]) -> None:
    """Refuse numbers that would be taken for volts or amperes."""
    for name, (_, unit) in columns.items():
        if not _OURS.fullmatch(name):
            continue
        if unit == PER_UNIT:
            said = "is per unit, of a base that the file does not say; it is needed in V, kV, A or kA"
            raise UsageError(f"{path}: the channel {name!r} {said}")
        if unit not in ("", unit_of(name)):
            raise UsageError(f"{path}: the channel {name!r} is not in {unit_of(name)} by its unit")


def _bounds(t: Samples, path: Path) -> list[int]:
    """First sample of every stretch of even steps, then the number of samples."""
    if len(t) < 2:
        raise UsageError(f"{path}: a recording needs two samples at least")
    if not np.isfinite(t).all():
        raise UsageError(f"{path}: a time is no finite number")
    steps = np.diff(t)
    if not steps.min() > 0:
        raise UsageError(f"{path}: the times do not increase")
    changed = np.abs(np.diff(steps)) > _UNEVEN * steps[1:]
    changed[:-1] &= ~changed[1:]  # a single step of another length is a pause: the segment after it begins at its end
    return [0, *(np.flatnonzero(changed) + 1).tolist(), len(t)]


def _step(t: Samples, path: Path) -> float:
    """Step of the samples of one segment."""
    dt = float(t[-1] - t[0]) / (len(t) - 1) if len(t) > 1 else 0.0
    if not dt > 0 or np.abs(np.diff(t) - dt).max() > _UNEVEN * dt:
        raise UsageError(f"{path}: the samples are not evenly spaced in time")
    return dt
