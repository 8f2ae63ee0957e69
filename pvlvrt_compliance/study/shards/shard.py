"""One part of a run, as it is written."""

import re
from dataclasses import dataclass

from pvlvrt_compliance.errors import UsageError

_WRITTEN = re.compile(r"([0-9]{1,9})/([0-9]{1,9})")


@dataclass(frozen=True, order=True)
class Shard:
    """One part of a run, and of how many."""

    number: int  # from 1
    count: int

    def __str__(self) -> str:
        return f"{self.number}/{self.count}"


def shard_of(text: str, spelled: str) -> Shard:
    """A part as it is written, ``2/5``.

    Raises
    ------
    UsageError
        When it is none.
    """
    found = _WRITTEN.fullmatch(text.strip())
    shard = Shard(int(found[1]), int(found[2])) if found else None
    if shard is None or not 1 <= shard.number <= shard.count:
        raise UsageError(f"{spelled} {text}: give the number of the part and how many there are, for instance 2/5")
    return shard
