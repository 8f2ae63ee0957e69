"""A recorded voltage that is to be played back: of a file that a file of others may have named."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.space_vectors import clarke
from pvlvrt_compliance.waveforms.columns import PER_UNIT, Column
from pvlvrt_compliance.waveforms.container import Segment
from pvlvrt_compliance.waveforms.recording import in_segments, on_one_grid, read_columns

LARGEST_PLAYED_BYTES = 64 << 20
"""Of a recording that is played back: two minutes of three voltages as text at 10 kHz (chosen); it is read whole."""

_VOLTAGES = ("V", "")  # a name and a configuration need not say the unit
_MOST_V = 1e7  # (chosen): of no grid
_LEAST_A_CYCLE = 8  # samples of a cycle that its sequences can be told from (chosen)
_TURNS_BACK = 2.0  # V- over V+ of voltages in another order (chosen): no fault has more than 1


def read_voltages(
    path: Path, channels: Sequence[str], scale: float | None, frequency_hz: float, within: Path | None = None
) -> Segment:
    """Three phase-to-neutral voltages (V) of a file, by the names of their channels.

    Parameters
    ----------
    path : Path
    channels : sequence of str
        Of phases a, b and c.
    scale : float or None
        Factor on what is in the file, in V where it says V or kV; None: 1, unless it is per unit.
    frequency_hz : float
        Of the grid, for the order of the phases.
    within : Path, optional
        Folder that the file must lie in or below.

    Raises
    ------
    UsageError
        When it cannot be read, is no voltage, has gaps, or its phases follow in the order a, c, b.
    """
    t, columns = read_columns(path, channels, most_bytes=LARGEST_PLAYED_BYTES, within=within)
    for name, column in columns.items():
        _refuse(path, name, column, is_scaled=scale is not None)
    factor = 1.0 if scale is None else scale
    with np.errstate(over="ignore"):
        found = {name: factor * column.samples for name, column in columns.items()}
    for name, voltage in found.items():
        if not (np.abs(voltage) <= _MOST_V).all():
            raise UsageError(f"{path}: the channel {name!r} goes beyond {_MOST_V:g} V; scale is to volts")
    samples = on_one_grid(in_segments(path, t, found), path)
    if _turns_back(samples, channels, frequency_hz):
        said = f'the phases follow in the order a, c, b; name them so: channels = ["{channels[0]}", "{channels[2]}"'
        raise UsageError(f'{path}: {said}, "{channels[1]}"]')
    return samples


def _refuse(path: Path, name: str, column: Column, *, is_scaled: bool) -> None:
    unit = column.unit
    if unit == PER_UNIT and not is_scaled:
        said = "is per unit, of a base that the file does not say: give scale, the volts of 1 pu"
        raise UsageError(f"{path}: the channel {name!r} {said}")
    if unit not in (*_VOLTAGES, PER_UNIT) and not is_scaled:
        said = "is no voltage in V, kV or pu: name another, or give scale, the volts of 1 of its unit"
        raise UsageError(f"{path}: the channel {name!r} {said}")
    missing = np.flatnonzero(~np.isfinite(column.samples))
    if len(missing):
        raise UsageError(f"{path}: the channel {name!r} has no finite number at its sample {missing[0] + 1}")


def _turns_back(samples: Segment, channels: Sequence[str], frequency_hz: float) -> bool:
    """Whether the voltages of the first cycle are a negative sequence."""
    count = round(1 / (frequency_hz * samples.dt_s))
    if not _LEAST_A_CYCLE <= count <= len(samples):
        return False
    vector = clarke(*(samples[name][:count] for name in channels))
    back = np.exp(-2j * np.pi * frequency_hz * samples.dt_s * np.arange(count))
    positive, negative = abs(np.mean(vector * back)), abs(np.mean(vector.conj() * back))
    return bool(negative > _TURNS_BACK * positive)
