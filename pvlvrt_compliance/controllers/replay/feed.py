"""What is fed to a controller: a column of numbers for each number of its input ports, call by call."""

from collections.abc import Mapping
from typing import NamedTuple

from pvlvrt_compliance.waveforms.container import Samples


class Feed(NamedTuple):
    """What a controller is given in so many calls, each one sample time after the one before.

    A number of its inputs is known by its place among all of them, from 0: ports in the order of the description, wide
    ones element by element.
    """

    calls: int
    sample_time_s: float
    columns: Mapping[int, Samples]  # by the number; in the port's unit, shape (calls,)
    slow_task: tuple[int, ...] = ()  # numbers that tell when a slow task is due: only the open controller knows
    absent: frozenset[str] = (
        frozenset()
    )  # measurements of a class in Python that have no column: told when it reads one
