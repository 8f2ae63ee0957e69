"""What holds from each instant on, where several things last for a while: in order of time, each looked at once."""

import heapq
from collections.abc import Iterator, Sequence
from typing import Generic, NamedTuple, TypeVar

Item = TypeVar("Item")


class Span(NamedTuple, Generic[Item]):
    """Something that holds from its begin on, at its end no more (s)."""

    begin_s: float
    end_s: float
    item: Item


def last_begun(spans: Sequence[Span[Item]], times: Sequence[float]) -> Iterator[Item | None]:
    """Of all that holds at each instant what began last (beginning together: the last listed); None where nothing does.

    Parameters
    ----------
    spans : sequence of Span
    times : sequence of float
        Instants, in order (s). It takes n log n steps for n spans and instants.
    """
    ahead = sorted(range(len(spans)), key=lambda k: spans[k].begin_s, reverse=True)
    holding: list[tuple[float, int]] = []
    for t in times:
        while ahead and spans[ahead[-1]].begin_s <= t:
            k = ahead.pop()
            heapq.heappush(holding, (-spans[k].begin_s, -k))
        while holding and spans[-holding[0][1]].end_s <= t:
            heapq.heappop(holding)
        yield spans[-holding[0][1]].item if holding else None
