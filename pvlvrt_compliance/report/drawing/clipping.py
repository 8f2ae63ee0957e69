"""What of broken lines and of areas lies within a frame."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from pvlvrt_compliance.report.drawing.model import Point

_ON_THE_FRAME = 1e-6  # px: what rounding puts outside is still on it


class Frame(NamedTuple):
    """A rectangle: its least and largest coordinates."""

    x: Point
    y: Point


class _Side(NamedTuple):
    """A side of a frame: the coordinate that is bounded, by what, and 1 where that is the largest, -1 the least."""

    axis: int
    bound: float
    sign: int

    def has(self, point: Point) -> bool:
        return self.sign * (point[self.axis] - self.bound) <= _ON_THE_FRAME

    def crossing(self, a: Point, b: Point) -> Point:
        share = (self.bound - a[self.axis]) / (b[self.axis] - a[self.axis])
        x, y = (a[k] + share * (b[k] - a[k]) for k in (0, 1))
        return (self.bound, y) if self.axis == 0 else (x, self.bound)


def lines_within(frame: Frame, points: Sequence[Point]) -> list[Sequence[Point]]:
    """The parts of a broken line within a frame; the line itself where it is all within."""
    parts = [points]
    for side in _sides(frame):
        parts = [part for whole in parts for part in _parts_beside(side, whole)]
    return parts


def area_within(frame: Frame, corners: Sequence[Point]) -> Sequence[Point]:
    """The corners of the part of an area within a frame; none where it is all outside."""
    for side in _sides(frame):
        corners = [point for pair in pairwise([*corners[-1:], *corners]) for point in _kept(side, *pair)]
    return corners


def _sides(frame: Frame) -> Iterator[_Side]:
    for axis, (low, high) in enumerate(frame):
        yield _Side(axis, low, -1)
        yield _Side(axis, high, 1)


def _parts_beside(side: _Side, points: Sequence[Point]) -> Iterator[Sequence[Point]]:
    part = [point for point in points[:1] if side.has(point)]
    for a, b in pairwise(points):
        part += _kept(side, a, b)
        if part and not side.has(b):
            yield part
            part = []
    if part:
        yield part


def _kept(side: _Side, a: Point, b: Point) -> list[Point]:
    """What a line from one point to another adds: where it crosses the side, and where it ends inside of it."""
    crossing = [side.crossing(a, b)] if side.has(a) != side.has(b) else []
    return crossing + ([b] if side.has(b) else [])
