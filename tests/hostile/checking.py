"""What the tests of some cases share."""

from collections.abc import Iterable
from pathlib import Path

from tests.hostile.__main__ import described
from tests.hostile.driver import outcomes

SEED = 16
"""Of the cases that are run each time; a search by hand takes others."""


def failures(numbers: range, place: Path, least_reached: int) -> str:
    """Run cases; all that did not hold, in words.

    Raises
    ------
    AssertionError
        When too few of them have come as far as the reports to say anything about these.
    """
    found = list(outcomes(SEED, numbers, place / "work", place / "kept"))
    assert [each.number for each in found] == list(numbers)
    reached = sum(each.reached for each in found)
    assert reached >= least_reached, f"{reached} of {len(numbers)} cases came to the reports"
    return told(described(each, SEED, place / "kept") for each in found if each.wrong)


def told(lines: Iterable[str]) -> str:
    """Findings below each other."""
    return "\n".join(lines)
