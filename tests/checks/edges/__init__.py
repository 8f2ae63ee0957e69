"""Generators of records just inside and just outside of every limit of a profile, one a kind of requirement."""

from edges.connection import phase_jump_ride_through, ride_through
from edges.current import current_limit, reactive_ratio, reactive_support, toggling
from edges.edge import Edge, Generator, Record
from edges.frequency import frequency_ride_through, overfrequency_power
from edges.power import (
    active_power_recovery,
    active_power_support,
    constant_power,
    consumption,
    oscillation,
    return_to_prefault,
)
from edges.quality import dc_injection, dc_ripple, harmonics
from edges.reactive_current import negative_sequence_current, reactive_current, support_dynamics

__all__ = ["GENERATORS", "Edge", "Record"]

GENERATORS: dict[str, Generator] = {
    generator.__name__: generator
    for generator in (
        ride_through,
        frequency_ride_through,
        phase_jump_ride_through,
        current_limit,
        reactive_support,
        reactive_current,
        negative_sequence_current,
        support_dynamics,
        reactive_ratio,
        toggling,
        active_power_support,
        active_power_recovery,
        consumption,
        constant_power,
        oscillation,
        return_to_prefault,
        overfrequency_power,
        dc_ripple,
        harmonics,
        dc_injection,
    )
}
"""By kind; the rule of repeated runs judges no record."""
