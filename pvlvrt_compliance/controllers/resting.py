"""A run of a controller from outside, put aside between two samples: what the loop, the hardware and the door hold."""

import pickle
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.controllers.door import Door, DoorError
from pvlvrt_compliance.errors import SimulationError
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, ON, SWITCHES
from pvlvrt_compliance.simulation.door.table import DoorTable
from pvlvrt_compliance.simulation.settled_run import LoopState


class Resting(NamedTuple):
    """All that a run remembers; it goes on in another process."""

    loop: LoopState
    commands: NDArray[np.float64]  # as of `DoorTable`
    controller: Any  # what its door gives (`Door.snapshot`)
    notes: tuple[str, ...]  # what it has said so far

    def packed(self) -> bytes:
        """As bytes, which only the process of the same controller unpacks."""
        return pickle.dumps(self)


def unpacked(data: bytes) -> Resting:
    """What has been packed, by a controller that trusts itself.

    Raises
    ------
    SimulationError
        When it is anything else.
    """
    try:
        found = pickle.loads(data)
    except Exception as error:
        raise SimulationError(f"what was kept of an earlier run cannot be read: {error!r}") from None
    if not isinstance(found, Resting):
        raise SimulationError("what was kept of an earlier run is something else")
    return found


def at_rest(door: Door, table: DoorTable, loop: LoopState | None, notes: Sequence[str]) -> Resting:
    """A run that has come to the end of its plan; ``loop`` is none where its inverter does not run as it settles.

    Raises
    ------
    DoorError
        When its door does not give what the controller remembers, or one of its switches is on; with the reason.
    """
    on = [name for name in SWITCHES if table.commands[COMMANDS.index(name)] >= ON]
    if loop is None or on:
        raise DoorError(f"its inverter does not run as it settles: {', '.join(on) or 'it has tripped or is blocked'}")
    return Resting(loop=loop, commands=table.commands.copy(), controller=door.snapshot(), notes=tuple(notes))
