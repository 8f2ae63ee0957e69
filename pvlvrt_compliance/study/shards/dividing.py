"""Which tests of a job are in which part of it."""

from collections.abc import Collection, Sequence

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.study.executors.units import Unit, cost_s, items_of, units_of
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.study.shards.shard import Shard


def tests_in(shard: Shard, tests: Sequence[Assignment], spelled: str) -> tuple[Assignment, ...]:
    """The tests of a part, in their order.

    Whoever divides the same tests comes to the same parts: what shares a record stays together, and what costs most is
    given first, each time to the part that has least.

    Raises
    ------
    UsageError
        When there are more parts than can have anything.
    """
    units = units_of(tests)
    if shard.count > len(units):
        said = f"{len(tests)} tests make {len(units)} parts at most: some share a record, or the verdict on a row"
        raise UsageError(f"{spelled} {shard}: {said}")
    chosen = {item.key for number in _divided(units, shard.count)[shard.number - 1] for item in items_of(units[number])}
    return tuple(item for item in tests if item.key in chosen)


def _divided(units: Sequence[Unit], count: int) -> list[Collection[int]]:
    """Numbers of the units in each part."""
    parts: list[list[int]] = [[] for _ in range(count)]
    costs = [0.0] * count
    for number in sorted(range(len(units)), key=lambda number: -cost_s(units[number])):
        least = min(range(count), key=lambda part: (costs[part], len(parts[part])))
        parts[least].append(number)
        costs[least] += cost_s(units[number])
    return [sorted(part) for part in parts]
