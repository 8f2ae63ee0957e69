"""What a piece of evidence is: figures found beside figures expected, and drawings."""

from collections.abc import Callable
from typing import Any, NamedTuple


class Row(NamedTuple):
    """A figure found, and what another program, a closed form or the paper says of it."""

    name: str
    found: float
    expected: float | None  # None: shown for information, nothing to compare with
    tolerance: float  # largest difference allowed, in the unit of the figure
    unit: str = ""
    floor: float = 0.0  # below it the figure is rounding, which differs between machines: printed as "below"

    @property
    def within(self) -> bool:
        """Whether the figure is where it is expected. Not a number never is."""
        return self.expected is None or abs(self.found - self.expected) <= self.tolerance


class Plot(NamedTuple):
    """A drawing: ``draw`` is given a matplotlib figure, so that computing needs no matplotlib."""

    file: str  # name without ending
    caption: str
    draw: Callable[[Any], None]
    height: float = 3.0  # (inch); all are 8 inches wide


class Section(NamedTuple):
    """A part of the page: text, a table and drawings."""

    title: str
    text: str
    rows: tuple[Row, ...] = ()
    plots: tuple[Plot, ...] = ()


def at_most(name: str, found: float, limit: float, unit: str = "", floor: float = 0.0) -> Row:
    """Row of an error that should be zero and may be ``limit``."""
    return Row(name, found, 0.0, limit, unit, floor)


def shown(name: str, found: float, unit: str = "") -> Row:
    """Row of a figure that nothing is expected of."""
    return Row(name, found, None, 0.0, unit)
