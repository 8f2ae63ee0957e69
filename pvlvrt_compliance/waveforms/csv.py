"""CSV: one line a sample, a header of channel names."""

from pathlib import Path

import numpy as np

from pvlvrt_compliance.waveforms.container import Segment, Waveforms

# Rows formatted by one operator: enough to spread its cost, few enough to keep the text small in memory.
_ROWS_A_BLOCK = 1024


def write_csv(waveforms: Waveforms, path: Path) -> None:
    """Write a record as comma-separated values.

    ``t_s`` comes first, to 1e-9 s; the channels follow under their names, with 9 significant digits. Segments follow
    each other. The same record gives the same bytes everywhere (lines end in a line feed).

    Raises
    ------
    OSError
        When the file cannot be written.
    """
    with path.open("w", encoding="ascii", newline="\n") as file:
        file.write(",".join(("t_s", *waveforms.names)) + "\n")
        for segment in waveforms:
            for first in range(0, len(segment), _ROWS_A_BLOCK):
                file.write(_rows(segment, first, min(first + _ROWS_A_BLOCK, len(segment))))


def _rows(segment: Segment, first: int, stop: int) -> str:
    t_s = segment.t0_s + segment.dt_s * np.arange(first, stop, dtype=np.float64)
    columns = np.column_stack([t_s, *(x[first:stop] for x in segment.channels.values())])
    row = "%.9f" + ",%.9g" * len(segment.channels) + "\n"
    return row * (stop - first) % tuple(columns.ravel().tolist())
