"""The loop of a replay, in the process of the controller: numbers into its ports, a call, numbers out of them."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.controllers.door import Door, DoorCall
from pvlvrt_compliance.controllers.mapping.bare import FIRST_INPUT
from pvlvrt_compliance.controllers.python.door import PythonDoor
from pvlvrt_compliance.controllers.python.watched import watched
from pvlvrt_compliance.controllers.replay.feed import Feed
from pvlvrt_compliance.controllers.run import when
from pvlvrt_compliance.errors import SimulationError
from pvlvrt_compliance.simulation.door.blocks import ITEM_SIZES, NUMBER_TYPES, Block, Element
from pvlvrt_compliance.simulation.door.call import MESSAGE
from pvlvrt_compliance.simulation.door.exchange import LATEST_CALL, SIGNAL
from pvlvrt_compliance.simulation.door.native_call import FUNCTION
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Samples

Bytes = NDArray[np.uint8]


class Given(NamedTuple):
    """What a controller gave: a column for each number of its outputs, then for further signals by their names."""

    samples: Samples  # shape (calls, columns), in the units of the ports
    further: tuple[str, ...]
    notes: tuple[str, ...]
    missing: tuple[str, ...]  # what a class has read that it was not given; the samples mean nothing then


def replay_through(door: Door, feed: Feed, nominal: Nominal, progress: Samples) -> Given:
    """Open a bare door and feed its controller, from its rest on.

    It is initialised as in a run, with the first inputs and with outputs of zero, and then called for every sample.

    Parameters
    ----------
    progress : array, shape (`exchange.PROGRESSES`,)
        Kept at the time of the latest call (s).

    Raises
    ------
    SimulationError
        When the controller fails, with the time and what it says.
    UsageError
        When it cannot be opened.
    """
    unread: dict[str, None] = {}
    if isinstance(door, PythonDoor):
        door.measurements, unread = watched(feed.absent)
    opened = door.open(nominal)
    try:
        samples = _fed(door, opened, feed, unread, progress)
    finally:
        door.close()
    return Given(samples, opened.recorded, tuple(opened.notes), tuple(unread))


def _fed(door: Door, opened: DoorCall, feed: Feed, unread: dict[str, None], progress: Samples) -> Samples:
    written = _images(opened, feed)
    into, out = opened.inputs.memory, opened.outputs.memory
    clock = _clock(opened.inputs)
    first, end = _span(opened.outputs.elements)
    read = np.zeros((feed.calls, end - first), dtype=np.uint8)
    call = FUNCTION(opened.address)
    for k in range(feed.calls):
        t = k * feed.sample_time_s
        progress[LATEST_CALL] = t
        if clock is not None:
            clock[0] = t
        into[written.first : written.end] = written.rows[k]
        if k == 0:
            _begin(door, opened)
        if answer := call(opened.argument):
            _note(door, opened, t, answer)
        if unread:
            break
        read[k] = out[first:end]
    return _numbers(read, opened.outputs.elements, first)


def _begin(door: Door, opened: DoorCall) -> None:
    """Have the controller initialise itself, as it is before its first sample of a run."""
    for address in filter(None, (opened.first_address, opened.hold_address)):
        if answer := FUNCTION(address)(opened.argument):
            _note(door, opened, 0.0, answer)


def _note(door: Door, opened: DoorCall, t: float, answer: int) -> None:
    """Take what the controller has to say.

    Raises
    ------
    SimulationError
        When that is that it has failed.
    """
    if answer == MESSAGE and opened.note_address and not FUNCTION(opened.note_address)(opened.argument):
        return
    said = door.message()
    raise SimulationError(f"the controller failed at {when(t)}{f': {said}' if said else ''}")


class _Images(NamedTuple):
    """Bytes of the inputs as they stand in every call, shape (calls, end - first)."""

    rows: Bytes
    first: int
    end: int


def _images(opened: DoorCall, feed: Feed) -> _Images:
    """Lay out all inputs beforehand: number after number in every call would cost as much as a controller."""
    columns = dict(feed.columns)
    due = (np.arange(feed.calls) % opened.every == 0).astype(np.float64)
    columns |= dict.fromkeys(feed.slow_task, due)
    elements = [element for element in opened.inputs.elements if element.signal >= FIRST_INPUT]
    first, end = _span(elements)
    rows = np.tile(opened.inputs.memory[first:end], (feed.calls, 1))
    for element in elements:
        column = columns.get(element.signal - FIRST_INPUT)
        if column is None:  # of a class alone, which is told when it reads it
            column = np.full(feed.calls, np.nan)
        place, size = element.byte - first, ITEM_SIZES[element.kind]
        rows[:, place : place + size] = _as_kind(column, element.kind).view(np.uint8).reshape(feed.calls, size)
    return _Images(rows, first, end)


def _as_kind(column: Samples, kind: int) -> NDArray[np.number]:
    """Numbers as a type: whole ones rounded, in its range, and 0 for what is none, as the loop of a run writes them."""
    number = NUMBER_TYPES[kind]
    if not issubclass(number, np.integer):
        with np.errstate(over="ignore"):
            return np.ascontiguousarray(column, dtype=number)
    range_of = np.iinfo(number)
    known = np.where(np.isnan(column), 0.0, column)
    return np.floor(np.clip(known, range_of.min, range_of.max) + 0.5).astype(number)


def _numbers(read: Bytes, elements: Sequence[Element], first: int) -> Samples:
    """Numbers of the outputs in their order, shape (calls, elements)."""
    found = np.empty((len(read), len(elements)))
    for k, element in enumerate(elements):
        place = element.byte - first
        part = np.ascontiguousarray(read[:, place : place + ITEM_SIZES[element.kind]])
        found[:, k] = part.view(NUMBER_TYPES[element.kind])[:, 0]
    return found


def _span(elements: Sequence[Element]) -> tuple[int, int]:
    """First byte of some numbers, and the end of the last."""
    if not elements:
        return 0, 0
    return min(e.byte for e in elements), max(e.byte + ITEM_SIZES[e.kind] for e in elements)


def _clock(block: Block) -> NDArray[np.float64] | None:
    """Where a controller is told the time besides its ports; None where it is not."""
    found = [e.byte for e in block.elements if e.signal == SIGNAL.time_s]
    return block.memory[found[0] : found[0] + 8].view(np.float64) if found else None
