"""Reading a recording of any make: CSV, or COMTRADE through the package of that name; several steps as segments."""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from pvlvrt_compliance.errors import MeasurementError, UsageError, did_you_mean
from pvlvrt_compliance.waveforms.container import Samples, Segment, Waveforms
from pvlvrt_compliance.waveforms.joining import window_on_one_grid

_UNEVEN = 1e-3  # largest change from one step to the next within a segment, as a fraction of it


def read_recording(path: Path, channels: Sequence[str]) -> Segment:
    """Read some channels of a CSV file (column ``t_s``) or of a COMTRADE file (``.cfg``).

    Of a record of several sampling steps, the samples on the grid of the coarsest.

    Raises
    ------
    UsageError
        When the file or a channel is not there, or the samples are not on a uniform grid.
    """
    waveforms = read_waveforms(path, channels)
    first, last = waveforms.segments[0], waveforms.segments[-1]
    try:
        return window_on_one_grid(waveforms, first.t0_s, last.end_s + last.dt_s)
    except MeasurementError as error:
        raise UsageError(f"{path}: the samples are not evenly spaced in time ({error})") from None


def read_waveforms(path: Path, channels: Sequence[str] | None = None) -> Waveforms:
    """Read a file, or some channels of it, with a segment for every change of the sampling step.

    Raises
    ------
    UsageError
        As `read_recording`; segments may lie on grids of their own, but are evenly spaced.
    """
    try:
        t, columns = _read_comtrade(path) if path.suffix.lower() == ".cfg" else _read_csv(path)
    except (OSError, UnicodeDecodeError, ValueError, IndexError) as error:
        raise UsageError(f"{path}: cannot be read as a recording ({error})") from None
    names = tuple(columns) if channels is None else channels
    for name in names:
        if name not in columns:
            raise UsageError(f"{path}: no channel {name!r}{did_you_mean(name, columns)}; it has {', '.join(columns)}")
    bounds = _bounds(t, path)
    return Waveforms(
        tuple(
            Segment(float(t[i]), _step(t[i:j], path), {name: columns[name][i:j] for name in names})
            for i, j in pairwise(bounds)
        )
    )


def files_of(recording: Path) -> list[Path]:
    """A file, and of COMTRADE the one with the samples: first that whose ending is written in the same case."""
    if recording.suffix.lower() != ".cfg":
        return [recording]
    endings = (".dat", ".DAT") if recording.suffix.islower() else (".DAT", ".dat")
    samples = (recording.with_suffix(ending) for ending in endings)
    return [recording, *[file for file in samples if file.is_file()][:1]]


def _bounds(t: Samples, path: Path) -> list[int]:
    """First sample of every stretch of even steps, then the number of samples."""
    if len(t) < 2:
        raise UsageError(f"{path}: a recording needs two samples at least")
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


def _read_csv(path: Path) -> tuple[Samples, dict[str, Samples]]:
    with path.open(encoding="utf-8") as file:
        names = [name.strip() for name in file.readline().split(",")]
        values = np.loadtxt(file, delimiter=",", ndmin=2, dtype=np.float64)
    columns = {name: np.ascontiguousarray(values[:, k]) for k, name in enumerate(names)}
    if "t_s" not in columns:
        raise ValueError("there is no column t_s")
    return columns.pop("t_s"), columns


def _read_comtrade(path: Path) -> tuple[Samples, dict[str, Samples]]:
    from comtrade import Comtrade

    record = Comtrade(use_double_precision=True)
    record.load(str(path))
    named = [
        *zip(record.analog_channel_ids, record.analog, strict=True),
        *zip(record.status_channel_ids, record.status, strict=True),
    ]
    columns = {name: np.asarray(values, dtype=np.float64) for name, values in named}
    return np.asarray(record.time, dtype=np.float64), columns
