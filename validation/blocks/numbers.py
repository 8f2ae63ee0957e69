"""All numbers and figures of the pages, by name."""

from collections.abc import Callable
from functools import cache

from validation.blocks import bridges, electronics, orders, power, regulators, surroundings, synchronisations
from validation.blocks.svg import Figure
from validation.simulator.evidence import Row

_PARTS = (synchronisations, orders, regulators, power, bridges, surroundings, electronics)

ROWS: dict[str, Callable[[], tuple[Row, ...]]] = {
    name: cache(rows) for part in _PARTS for name, rows in part.ROWS.items()
}
"""Lines of the tables, each computed once."""
FIGURES: tuple[Callable[[], Figure], ...] = tuple(figure for part in _PARTS for figure in part.FIGURES)
