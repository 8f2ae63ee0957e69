"""Measurements of which some are not known: what a class reads of those is noted."""

import math
from collections.abc import Collection
from typing import Any

from pvlvrt_compliance.controllers import Measurements


def watched(absent: Collection[str]) -> tuple[type[Measurements], dict[str, None]]:
    """Measurements in which some are no number, and where those are noted that were read, in the order of reading.

    What is read by its place, or in compiled code, is no number either, but not noted.
    """
    read: dict[str, None] = {}

    def unknown(name: str) -> property:
        def look(_measurements: Any) -> float:
            read[name] = None
            return math.nan

        return property(look)

    found: Any = type(Measurements.__name__, (Measurements,), {name: unknown(name) for name in absent})
    return found, read
