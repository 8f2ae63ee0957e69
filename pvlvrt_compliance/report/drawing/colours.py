"""Colours of everything that is drawn."""

from typing import get_args

from pvlvrt_compliance.profile.regions import Mode

# Tol's high-contrast colours for the phases: told apart with every common colour blindness and in grey on paper.
PHASES = {"a": "#004488", "b": "#DDAA33", "c": "#BB5566"}
BLUE, VERMILION, PURPLE, GREY, BLACK = "#0072B2", "#C44E00", "#9A3D8F", "#767676", "#222222"
FURTHER = ("#117733", "#0072B2", "#882255")
"""Of voltages that limits are of, besides V+ and V-."""

OF_A_PROFILE = ("#0a4f8f", "#b3161b", "#0b6b3a", "#7a4b00", "#7b1fa2", "#00707a", "#545c63")
"""One after the other; of regions, one a mode."""

_MODES = get_args(Mode)


def of_mode(mode: str) -> str:
    """Colour of a region by its mode of operation."""
    return OF_A_PROFILE[_MODES.index(mode) if mode in _MODES else -1]
