"""Switches that a controller from outside may command besides voltages: trip, block and restart."""

from typing import NamedTuple

from pvlvrt_compliance.kernel import kernel
from pvlvrt_compliance.plant.plant import PlantState
from pvlvrt_compliance.plant.protection import BY_CONTROLLER, NO_TRIP
from pvlvrt_compliance.simulation.door.exchange import COMMAND, ON
from pvlvrt_compliance.simulation.door.table import DoorTable


class Switches(NamedTuple):
    """What a sample has commanded; it acts from the next one on, as the voltages do."""

    trip: bool
    block: bool
    restart: bool


@kernel
def all_off() -> Switches:
    """Nothing is commanded."""
    return Switches(trip=False, block=False, restart=False)


@kernel
def switches_of(door: DoorTable) -> Switches:
    """Switches as they are commanded."""
    x = door.commands
    return Switches(trip=x[COMMAND.trip] >= ON, block=x[COMMAND.block] >= ON, restart=x[COMMAND.restart] >= ON)


@kernel
def switched_by(plant: PlantState, s: Switches, door: DoorTable) -> PlantState:
    """Plant with the switches thrown.

    A trip is one as of the relays, for good. A block holds as long as it is commanded; of a controller that has a
    restart, until that is commanded and the block is not.
    """
    stays = door.latches and plant.blocked and not s.restart
    return PlantState(
        i=plant.i,
        v_dc=plant.v_dc,
        x_pv=plant.x_pv,
        i_pv=plant.i_pv,
        relay=plant.relay,
        trip=BY_CONTROLLER if s.trip and plant.trip == NO_TRIP else plant.trip,
        t_trip=plant.t_trip,
        closed=plant.closed,
        blocked=s.block or stays,
        mean=plant.mean,
    )
