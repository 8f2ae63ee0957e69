"""What the table says of one wrong controller or plant."""

from typing import NamedTuple

from validation.mutations.slips import Slip
from validation.mutations.wrong_controllers import Wrong

RIDE_THROUGH = ("ride_through", "repeated_runs")
"""A test that is not ridden through is also a run too few."""


class Mutant(NamedTuple):
    """One wrong controller or plant."""

    name: str
    why: str
    """What is wrong, and why that fails just these checks."""
    fails: tuple[str, ...]
    settings: tuple[str, ...] = ()
    """What `--set` takes."""
    wrong: Wrong | None = None
    """A mistake that no setting can make."""
    slip: Slip | None = None
    """Another, by numbers alone."""
    left_open: str = ""
    """Of a mistake that no check notices: which text leaves it open, and how."""
