"""What the codes of the channel ``trip_cause`` stand for."""

TRIP_CAUSES = (
    "none",
    "over-current relay of the plant",
    "DC over-voltage relay of the plant",
    "under-voltage relay of the plant",
    "frequency relay of the plant",
    "controller",
)
"""Cause of a trip by code, as `plant.protection` numbers them; a record of another kind may hold none of them."""

DC_OVERVOLTAGE = 2
"""Code of the relay of which something more can be said."""


def in_words(code: int) -> str:
    """Name a cause; a code that this version does not know is named by its number."""
    return TRIP_CAUSES[code] if 0 <= code < len(TRIP_CAUSES) else f"cause {code}"
