"""What is expected of a controller's outputs, and how far those are from it."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.controllers.replay.steps import meeting
from pvlvrt_compliance.controllers.replay.terminals import Terminal
from pvlvrt_compliance.controllers.replay.vectors import Vectors, read_vectors
from pvlvrt_compliance.errors import UsageError, did_you_mean
from pvlvrt_compliance.waveforms.agreement import Agreement, Tolerance, agreement, parse_tolerance
from pvlvrt_compliance.waveforms.container import Samples, Segment

_OPTION = "--tolerance"


class Expectation(NamedTuple):
    """Columns that are expected, and what outputs may differ by: each by a tolerance of its own, or that of all."""

    vectors: Vectors
    of_all: Tolerance
    of_one: Mapping[str, Tolerance]

    def columns(self, outputs: Sequence[Terminal]) -> dict[str, Samples]:
        """What is expected of outputs, in their units: the column of the name of each, else that of its quantity.

        Raises
        ------
        UsageError
            When there is none, or a tolerance is for none.
        """
        names, rows = [t.name for t in outputs], self.vectors.rows
        has = f"it has {', '.join(names) or 'none'}"
        if unknown := next((name for name in self.of_one if name not in names), None):
            said = f"{_OPTION} {unknown}=: the controller has no such output"
            raise UsageError(f"{said}{did_you_mean(unknown, names)}; {has}")
        found = {}
        for terminal in outputs:
            if terminal.name in rows.channels:
                found[terminal.name] = rows[terminal.name]
            elif terminal.quantity in rows.channels:
                found[terminal.name] = terminal.of_quantity(rows[terminal.quantity])
        if not found:
            said = f"{self.vectors.file}: no column is an output of the controller; {has}"
            raise UsageError(f"{said}, and the file {', '.join(rows.channels)}")
        return found

    def compared(self, record: Segment, outputs: Sequence[Terminal]) -> tuple[tuple[Agreement, ...], tuple[str, ...]]:
        """Every output beside what is expected of it, and what there is to say of that.

        Raises
        ------
        UsageError
            As of `columns`; when no instant is in both.
        """
        file, rows = self.vectors
        columns = self.columns(outputs)
        met = meeting(file, rows, record.t0_s, len(record), record.dt_s)
        found = tuple(
            agreement(
                *(t.name, t.unit, record.t_s, record[t.name]),
                *(met.calls, columns[t.name][met.rows], self.of_one.get(t.name, self.of_all)),
            )
            for t in outputs
            if t.name in columns
        )
        notes = []
        if left := [t.name for t in outputs if t.name not in columns]:
            notes.append(f"{file}: nothing is expected of the outputs {', '.join(left)}")
        if len(met.calls) < len(record) or len(met.rows) < len(rows):
            compared = f"compared at {len(met.calls)} of {len(record)} samples"
            notes.append(f"{file}: {compared}, with {len(met.rows)} of {len(rows)} rows")
        return found, tuple(notes)


def expectation(file: str | None, tolerances: Sequence[str]) -> Expectation | None:
    """What is expected, as it was typed; None where nothing is.

    Raises
    ------
    UsageError
        When the file cannot be read, a tolerance is none, or there is one and no file.
    """
    of_all, of_one = Tolerance(), {}
    for text in tolerances:
        name, equals, value = text.rpartition("=")
        found = parse_tolerance(value, f"{_OPTION} {text}")
        if equals:
            of_one[name.strip()] = found
        else:
            of_all = found
    if file is not None:
        return Expectation(read_vectors(Path(file)), of_all, of_one)
    if tolerances:
        raise UsageError(f"{_OPTION} {tolerances[0]}: goes with --expect")
    return None
