"""The unit that a signal or command is in, by its name."""

from pvlvrt_compliance.controllers.mapping.port_units import UNITS
from pvlvrt_compliance.controllers.mapping.quantities import QUANTITIES


def unit_of_name(name: str) -> str:
    """Unit of a signal or command of the plant; empty of a pure number.

    Its quantity decides, not the end of the name: ``m_a`` is no current, ``filter_inductance_h`` is in H.
    """
    quantity = QUANTITIES.get(name, "number")
    unit = next(unit for unit, factor in UNITS[quantity].items() if factor == 1.0)
    return "" if unit == "1" else unit
