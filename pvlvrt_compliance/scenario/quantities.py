"""Fields of a scenario as people write them: ``50Hz``, ``0.8kW/m2``, or a number alone."""

from typing import Any

from pvlvrt_compliance.units import ANGLE, FREQUENCY, IRRADIANCE, RATIO, TEMPERATURE, parse_quantity

_QUANTITIES = {
    "frequency_hz": FREQUENCY,
    "cell_temperature_c": TEMPERATURE,
    "scr": RATIO,
    "xr": RATIO,
    "irradiance_w_m2": IRRADIANCE,
    "point_on_wave_deg": ANGLE,
}


def in_units_of(field: str, value: Any) -> Any:
    """A text as a number in the unit of a field; a number, and what is no quantity, as it is.

    Raises
    ------
    UsageError
        When the text is no such quantity; the message begins with the field.
    """
    if isinstance(value, str) and field in _QUANTITIES:
        return parse_quantity(value, field, _QUANTITIES[field])
    return value
