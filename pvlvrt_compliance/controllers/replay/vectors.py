"""A file of signals of anybody's: columns by their names, evenly spaced in time."""

from collections.abc import Collection
from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.controllers.replay.terminals import Terminal
from pvlvrt_compliance.texts import one_line
from pvlvrt_compliance.waveforms.container import Segment
from pvlvrt_compliance.waveforms.recording import read_evenly

TIMES = ("t_s", "time_s", "time", "t")
"""What the column of the times may be called, the first that is there."""


class Vectors(NamedTuple):
    """Columns of a file, that of the times among them."""

    file: Path
    rows: Segment

    def others(self, terminals: Collection[Terminal]) -> str:
        """That columns are no input and no output, if there are any; a column of the times is neither."""
        known = {name for terminal in terminals for name in (terminal.name, terminal.quantity)}
        found = [name for name in self.rows.channels if name not in known and name.casefold() not in TIMES]
        return f"{self.file}: columns that are no input and no output: {', '.join(found)}" if found else ""


def read_vectors(file: Path) -> Vectors:
    """Read a file.

    Raises
    ------
    UsageError
        When it cannot be read, or is not evenly spaced in time.
    """
    found = read_evenly(file, TIMES)
    channels = {one_line(name): column for name, column in found.channels.items()}
    return Vectors(file, Segment(found.t0_s, found.dt_s, channels))
