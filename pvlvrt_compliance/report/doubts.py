"""What is not verified, for a terminal: said once and short, or in full."""

import re
from collections import Counter
from collections.abc import Iterator

from pvlvrt_compliance.data.marks import CONFIDENCES
from pvlvrt_compliance.results import Results

_MARK = re.compile(rf": ({'|'.join(CONFIDENCES)}) \(")  # where a sentence of `Profile.unverified` names it


def in_short(results: Results) -> str:
    """How many numbers and tests of the profiles are not verified, by their mark; nothing where all are."""
    found = [mark[1] for profile in results.profiles for note in profile.notes if (mark := _MARK.search(note))]
    if not found:
        return ""
    counts = Counter(found)
    kinds = ", ".join(f"{counts[mark]} {mark}" for mark in CONFIDENCES if counts[mark])
    return f"Not verified: {kinds}; see the report, or -v"


def in_full(results: Results) -> Iterator[str]:
    """A line for each, with its source."""
    several = len(results.profiles) > 1
    for profile in results.profiles:
        where = f" in {profile.id}" if several else ""
        yield from (f"Not verified{where}: {note}" for note in profile.notes)
