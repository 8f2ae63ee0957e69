"""Reading a recording of any make: CSV, or COMTRADE through the package of that name."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from pvlvrt_compliance.errors import UsageError, did_you_mean
from pvlvrt_compliance.waveforms.container import Samples, Segment

_UNEVEN = 1e-3  # largest deviation of a step from the mean of all, as a fraction of it


def read_recording(path: Path, channels: Sequence[str]) -> Segment:
    """Read some channels of a CSV file (column ``t_s``) or of a COMTRADE file (``.cfg``).

    Raises
    ------
    UsageError
        When the file or a channel is not there, the samples are not uniform, or the extra ``comtrade`` is missing.
    """
    try:
        t, columns = _read_comtrade(path) if path.suffix.lower() == ".cfg" else _read_csv(path)
    except (OSError, UnicodeDecodeError, ValueError, IndexError) as error:
        raise UsageError(f"{path}: cannot be read as a recording ({error})") from None
    for name in channels:
        if name not in columns:
            raise UsageError(f"{path}: no channel {name!r}{did_you_mean(name, columns)}; it has {', '.join(columns)}")
    return Segment(float(t[0]), _step(t, path), {name: columns[name] for name in channels})


def _step(t: Samples, path: Path) -> float:
    if len(t) < 2:
        raise UsageError(f"{path}: a recording needs two samples at least")
    dt = float(t[-1] - t[0]) / (len(t) - 1)
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
    try:
        from comtrade import Comtrade
    except ImportError:
        raise UsageError(
            f"{path}: reading COMTRADE needs the extra: pip install 'pvlvrt-compliance[comtrade]'"
        ) from None
    record = Comtrade(use_double_precision=True)
    record.load(str(path))
    columns = {
        name: np.asarray(values, dtype=np.float64)
        for name, values in zip(record.analog_channel_ids, record.analog, strict=True)
    }
    return np.asarray(record.time, dtype=np.float64), columns
