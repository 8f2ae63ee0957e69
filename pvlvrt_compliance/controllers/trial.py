"""A controller opened as a run opens it, without a run: what it says then, it would say there."""

from collections.abc import Mapping

from pvlvrt_compliance.controllers.door import Door, DoorCall, DoorError
from pvlvrt_compliance.controllers.mapping.constants import Constant, set_constants
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.door.exchange import SIGNALS
from pvlvrt_compliance.simulation.door.native_call import FUNCTION
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.told import told_of
from pvlvrt_compliance.simulation.translate import nominal_of, plant_tables

SCENARIO = Scenario(sag=Sag(depth=0.9), duration_s=0.3)
"""Any one: of a scenario a controller is told only what holds before its sag."""

_MESSAGE = 1  # see `DoorCall`


def plant_at_rest(parameters: Parameters) -> Mapping[str, float]:
    """Signals of a plant of these parameters that feeds nothing in: its data, its voltages, a closed breaker.

    The others are zero.
    """
    told = told_of(SCENARIO, parameters, plant_tables(parameters, SCENARIO)).fixed
    peak = nominal_of(parameters, SCENARIO).phase_voltage_peak_v
    voltages = {"u_a_v": peak, "u_b_v": -peak / 2, "u_c_v": -peak / 2, "v_dc_v": told["v_dc_nominal_v"]}
    return {**told, **voltages, "connected": 1.0}


def try_out(door: Door, parameters: Parameters) -> None:
    """Open a door, and make the calls that come before its controller's first sample.

    Raises
    ------
    DoorError
        With what a run would say.
    """
    opened = door.open(nominal_of(parameters, SCENARIO))
    if not opened.first_address:
        return
    signals = plant_at_rest(parameters)
    given = [
        Constant(element.byte, element.kind, element.gain * signals.get(SIGNALS[element.signal], 0.0) + element.offset)
        for element in opened.inputs.elements
    ]
    set_constants(opened.inputs.memory, given)
    if not _is_well(opened):
        raise DoorError(door.message())


def _is_well(opened: DoorCall) -> bool:
    answer = FUNCTION(opened.first_address)(opened.argument)
    if answer == _MESSAGE and opened.note_address:
        answer = FUNCTION(opened.note_address)(opened.argument)
    return bool(answer == 0)
