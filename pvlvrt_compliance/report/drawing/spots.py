"""Where the words of spots stand, so that none covers another: the same in every drawer."""

from collections.abc import Iterator, Sequence
from typing import Literal, NamedTuple

from pvlvrt_compliance.report.drawing.frame import CHARACTER_PX
from pvlvrt_compliance.report.drawing.model import Point

_BESIDE_PX = 7
_ROW_PX = 13
_AWAY_PX = tuple(away for row in range(5) for away in (-9 - row * _ROW_PX, 18 + row * _ROW_PX))  # downwards, of words


class Placed(NamedTuple):
    """How far the line of words is below its spot (px), and which of their ends is at it."""

    below_px: int
    anchor: Literal["left", "right"]


def placed(spots: Sequence[Point], words: Sequence[str], width_px: float, height_px: float) -> Iterator[Placed]:
    """Places of words in a frame of a size; spots in px from its upper left corner."""
    taken: list[tuple[float, float, float]] = []
    for (x, y), text in zip(spots, words, strict=True):
        length = CHARACTER_PX * len(text) + _BESIDE_PX
        anchor: Literal["left", "right"] = "right" if x + length > width_px else "left"
        begin = x - length if anchor == "right" else x
        free = [
            below
            for below in _AWAY_PX
            if _ROW_PX <= y + below <= height_px - 3
            and not any(a < begin + length and begin < b and abs(y + below - line) < _ROW_PX for a, b, line in taken)
        ]
        below = free[0] if free else _AWAY_PX[0]
        taken.append((begin, begin + length, y + below))
        yield Placed(below, anchor)
