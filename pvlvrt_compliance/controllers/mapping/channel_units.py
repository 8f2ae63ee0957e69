"""How an output in a unit of its own becomes a channel of the record, which is in the unit that its name ends in."""

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.mapping.port_units import PER_UNIT, UNITS, Bases, Scale, misfit, scale_of, spelled
from pvlvrt_compliance.units import Nominal

_NO_ENDING = ("1", "%", "duty", "C", "K")  # not letters, or more often something else at the end of a name
_ENDINGS = {
    f"_{unit.casefold().replace('/', '_')}": unit
    for unit in (PER_UNIT, *(unit for units in UNITS.values() for unit in units))
    if unit not in _NO_ENDING
}


def unit_of_channel(name: str) -> str:
    """Unit that a channel's name ends in, the longest one; empty where it ends in none."""
    found = [ending for ending in _ENDINGS if name.casefold().endswith(ending)]
    return _ENDINGS[max(found, key=len)] if found else ""


def scale_of_channel(name: str, unit: str, bases: Bases, nominal: Nominal, base: float | None = None) -> Scale:
    """How a channel of the record becomes a number of a port in a unit; without a unit in its name it is as the port.

    Parameters
    ----------
    base : float or None
        What 1 pu of the port is, in the channel's unit.

    Raises
    ------
    DoorError
        When the port's unit is none of the channel's quantity, or 1 pu of it is not known.
    """
    own = unit_of_channel(name)
    if own in ("", PER_UNIT):
        if own and spelled(unit) not in ("", PER_UNIT):
            raise DoorError(f"the channel {name} is in pu; the unit {unit!r} does not fit it")
        return scale_of("number", unit if base is not None else "", bases, nominal, base)
    quantities = [quantity for quantity, units in UNITS.items() if own in units]
    if base is None and spelled(unit) == PER_UNIT and len(quantities) > 1:
        either = " or a ".join(quantity.replace("_", " ").replace("dc ", "DC ") for quantity in quantities)
        raise DoorError(f"{name} may be a {either}; write base = what 1 pu is in {own}")
    if base is None and (text := misfit(quantities[0], unit)):
        raise DoorError(f"the channel {name} is in {own}: {text}")
    scale = scale_of(quantities[0], unit, bases, nominal, base)
    return scale if base is not None or not unit.strip() else Scale(scale.gain / UNITS[quantities[0]][own])
