"""A controller from outside as the loop over time has it: addresses, memory, and when it is called."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.simulation.door.ports import PortTable

HELD_EACH, HELD_ONCE, RUNS_FREE = range(3)
"""How often a controller that does not act yet is told so: before each call, before the first, or never: it is only
initialised, its outputs as they are."""


class Timing(NamedTuple):
    """When things happen. A period is the plant's, of ``ratio`` plant steps, as in a record."""

    armed: int  # period from which the relays trip
    ratio: int  # periods from one call of the controller to the next
    held: int  # calls before the first period, in which the controller sees the steady state
    sample_time: float  # as the controller has it: what its clock goes by (s)
    every: int = 1  # samples from one run of the controller's slow task to the next
    hold: int = 0  # `HELD_EACH`, `HELD_ONCE` or `RUNS_FREE`


class DoorTable(NamedTuple):
    """An open door in a run. Flat, as whoever takes one field of it counts references to all arrays of that field."""

    address: int  # of the function that advances the controller by one sample
    first_address: int  # of one called before all others; 0: none
    hold_address: int  # of one called before it as long as the controller does not act yet; 0: none
    note_address: int  # of one called after any has returned `call.MESSAGE`; 0: that is a failure
    argument: int  # address that all are called with
    inputs: PortTable  # from `exchange.SIGNALS`
    outputs: PortTable  # to `exchange.COMMANDS`, and further signals to record
    in_volts: bool  # whether voltages are commanded
    in_a_frame: bool  # whether these are so in a frame that turns
    latches: bool  # whether a block stays until a restart is commanded: there is an output for one
    after_trip: bool  # whether it is called after a trip, too: one whose process ends then is not
    signals: NDArray[np.float64]  # shape (len(SIGNALS),)
    commands: NDArray[np.float64]  # shape (len(COMMANDS) + further signals,)
    available: NDArray[np.float64]
    """Most that the array can give (W) by the irradiance, in equal steps from the first of the next to the last."""
    irradiance: NDArray[np.float64]  # shape (2,); in units of 1000 W/m2
    timing: Timing
    progress: NDArray[np.float64]
    """Shape (`exchange.PROGRESSES`,). Not a number at first; kept at the instant (s) of the latest call, and at what
    `call.call_or_ignore` says of a trip."""
