"""CSV: one line a sample, a header of channel names."""

import io
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from pvlvrt_compliance.waveforms.container import Samples, Segment, Waveforms

# Rows formatted by one operator: enough to spread its cost, few enough to keep the text small in memory.
_ROWS_A_BLOCK = 1024
_PARTS = frozenset(',;\t"')


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


def exact_text(t_s: Samples, columns: Mapping[str, Samples]) -> str:
    """Columns as a text that is read again as the same numbers: ``t_s`` first, to 12 digits, then each as it is called.

    Names are quoted where that is needed.
    """
    text = io.StringIO()
    text.write(",".join(map(_quoted, ("t_s", *columns))) + "\n")
    row = ",".join(["%.12g", *("%r" for _ in columns)]) + "\n"
    for first in range(0, len(t_s), _ROWS_A_BLOCK):
        block = np.column_stack([x[first : first + _ROWS_A_BLOCK] for x in (t_s, *columns.values())])
        text.write(row * len(block) % tuple(block.ravel().tolist()))
    return text.getvalue()


def _quoted(name: str) -> str:
    """A name in quotation marks, where something in it would be taken for what parts two names."""
    return '"' + name.replace('"', '""') + '"' if set(name) & _PARTS else name


def _rows(segment: Segment, first: int, stop: int) -> str:
    t_s = segment.t0_s + segment.dt_s * np.arange(first, stop, dtype=np.float64)
    columns, row = [t_s], "%.9f"
    for channel in segment.channels.values():
        samples = np.ascontiguousarray(channel[first:stop], dtype=np.float64)
        bits = samples.view(np.int64)  # zero has two signs, and no gap is another one
        if (bits == bits[0]).all():
            row += f",{samples[0]:.9g}"
        else:
            columns.append(samples)
            row += ",%.9g"
    return f"{row}\n" * (stop - first) % tuple(np.column_stack(columns).ravel().tolist())
