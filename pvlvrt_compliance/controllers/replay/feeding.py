"""Which column of a file each number of a controller's inputs is given, or what else."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.controllers.replay.feed import Feed
from pvlvrt_compliance.controllers.replay.steps import steps_of
from pvlvrt_compliance.controllers.replay.terminals import Terminal
from pvlvrt_compliance.controllers.replay.vectors import Vectors
from pvlvrt_compliance.errors import UsageError, did_you_mean
from pvlvrt_compliance.waveforms.container import Samples

HELD = "--hold"
"""The option that holds an input at a number."""

_CLOCK, _SLOW_TASK = "time_s", "slow_task_due"
"""What the host tells a controller of itself, whatever is fed to it."""

_MOST_NAMED = 40


class Fed(NamedTuple):
    """What is fed to a controller, and what there is to say of it."""

    feed: Feed
    notes: tuple[str, ...]


def held_numbers(given: Sequence[str]) -> dict[str, float]:
    """Inputs that are held at a number, each written ``NAME=NUMBER``.

    Raises
    ------
    UsageError
        When one is not, or a name is given twice.
    """
    found: dict[str, float] = {}
    for text in given:
        name, equals, number = text.rpartition("=")
        try:
            value = float(number)
        except ValueError:
            equals = ""
        if not equals or not name.strip():
            raise UsageError(f"{HELD} {text}: write NAME=NUMBER, the input and what it is held at, in its unit")
        if name.strip() in found:
            raise UsageError(f"{HELD} {name.strip()}: given twice")
        found[name.strip()] = value
    return found


def fed(
    vectors: Vectors,
    inputs: Sequence[Terminal],
    held: Mapping[str, float],
    sample_time_s: float,
    *,
    may_lack: bool,
) -> Fed:
    """Give each input its column: one of its own name, else of its quantity, else a number that it is held at.

    Parameters
    ----------
    vectors : Vectors
    inputs : sequence of Terminal
    held : mapping
        Numbers by the name of the input, or of its quantity (then in SI).
    sample_time_s : float
        Of the controller.
    may_lack : bool
        Whether inputs may be without any: of a class in Python, which need not read them all.

    Raises
    ------
    UsageError
        When one has nothing that is fed to it, with all of them; a number is held for none; or the step of the file
        does not go with the sample time.
    """
    file, rows = vectors
    steps = steps_of(file, rows, sample_time_s)
    _refuse_unknown(held, inputs)
    calls = len(steps.spread(np.empty(len(rows))))
    columns: dict[int, Samples] = {}
    slow, lacking, notes = [], [], [steps.words(file, rows.dt_s, sample_time_s)]
    for number, terminal in enumerate(inputs):
        source = terminal.name if terminal.name in rows.channels else terminal.quantity
        if terminal.name in held or terminal.quantity in held:
            columns[number] = np.full(calls, _held_at(terminal, held))
        elif source in rows.channels:
            column = steps.spread(rows[source])
            columns[number] = column if source == terminal.name else terminal.of_quantity(column)
        elif terminal.constant is not None:
            columns[number] = np.full(calls, terminal.constant)
        elif terminal.quantity == _CLOCK:
            columns[number] = terminal.of_quantity(sample_time_s * np.arange(calls, dtype=np.float64))
            notes += [] if may_lack else [f"{terminal.name} is given the time since the first sample"]
        elif terminal.quantity == _SLOW_TASK:
            slow.append(number)
        else:
            lacking.append(number)
    if lacking and not may_lack:
        raise UsageError(missing_words(vectors, [_called(inputs[number]) for number in lacking]))
    absent = frozenset(inputs[number].quantity for number in lacking)
    feed = Feed(calls, sample_time_s, columns, tuple(slow), absent)
    return Fed(feed, (*notes, *_not_finite(columns, inputs)))


def missing_words(vectors: Vectors, names: Sequence[str]) -> str:
    """That inputs have nothing that is fed to them, and what can be done."""
    columns = list(vectors.rows.channels)
    first = names[0].partition(" ")[0]
    shown = ", ".join([*names[:_MOST_NAMED], *(["..."] if len(names) > _MOST_NAMED else [])])
    count = f"{len(names)} input{'s' * (len(names) != 1)} of the controller"
    return (
        f"{vectors.file}: no column for {count}: {shown}; a column is called as the input, or as the quantity that"
        f" it is tied to; {HELD} {first}=0 holds one at a number. Columns are {', '.join(columns[:_MOST_NAMED])}"
        f"{did_you_mean(first, columns)}"
    )


def _called(terminal: Terminal) -> str:
    other = terminal.quantity if terminal.quantity != terminal.name else ""
    return f"{terminal.name} (or {other})" if other else terminal.name


def _held_at(terminal: Terminal, held: Mapping[str, float]) -> float:
    if terminal.name in held:
        return held[terminal.name]
    return float(terminal.of_quantity(np.array([held[terminal.quantity]], dtype=np.float64))[0])


def _refuse_unknown(held: Mapping[str, float], inputs: Sequence[Terminal]) -> None:
    known = [name for terminal in inputs for name in dict.fromkeys((terminal.name, terminal.quantity)) if name]
    problems = [
        f"{HELD} {name}: the controller has no such input{did_you_mean(name, known)}; it has"
        f" {', '.join(terminal.name for terminal in inputs) or 'none'}"
        for name in held
        if name not in known
    ]
    if problems:
        raise UsageError("\n".join(problems))


def _not_finite(columns: Mapping[int, Samples], inputs: Sequence[Terminal]) -> list[str]:
    """What there is to say of inputs that are no numbers somewhere: a test may mean it."""
    found = []
    for number, column in columns.items():
        bad = np.flatnonzero(~np.isfinite(column))
        if len(bad):
            found.append(f"{inputs[number].name} is given {column[bad[0]]:g} in {len(bad)} samples, first in {bad[0]}")
    return found
