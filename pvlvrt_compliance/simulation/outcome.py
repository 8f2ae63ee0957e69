"""How a run over time ends."""

from typing import NamedTuple

from pvlvrt_compliance.control.controller import ControllerState
from pvlvrt_compliance.plant.plant import PlantState
from pvlvrt_compliance.plant.protection import NO_TRIP

COMPLETED, NOT_FINITE, CONTROLLER_FAILED, OUTPUT_NOT_FINITE, OUTPUT_OUT_OF_RANGE = range(5)
"""How a run ended; the last three with a controller from outside only."""


class Onward(NamedTuple):
    """What another run needs to go on, besides the plant."""

    controller: ControllerState | None  # the bundled one; without its arrays, which whoever has begun the run has
    m: complex  # modulating signal that the controller gave last (-)
    k: int  # samples that it has taken


class Outcome(NamedTuple):
    """How a run ended, and where everything was then."""

    status: int
    period: int  # in which it ended; negative before the record
    plant: PlantState
    onward: Onward | None = None


def tripped_at_s(plant: PlantState, now_s: float) -> float | None:
    """When a plant that is in this state now has tripped (s), None when it has not."""
    return None if plant.trip == NO_TRIP else now_s - plant.t_trip
