"""How long something took; nothing where time is fixed, since the same input then gives the same bytes."""

import os
from time import perf_counter

FIXED_TIME = "SOURCE_DATE_EPOCH"
"""Environment variable that fixes the time of a run, in seconds since 1970."""

_DECIMALS = 3


class Stopwatch:
    """Runs from when it is made."""

    def __init__(self) -> None:
        self._begun_s = perf_counter()

    @property
    def elapsed_s(self) -> float:
        """Wall time so far (s), whole milliseconds; 0 where `FIXED_TIME` is set."""
        return 0.0 if FIXED_TIME in os.environ else round(perf_counter() - self._begun_s, _DECIMALS)
