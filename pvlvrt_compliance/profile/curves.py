"""Ride-through envelopes and support curves: broken lines with a mark."""

from enum import StrEnum
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag

from pvlvrt_compliance.data.marks import CONFIDENCES, Mark, Marked, MarkedTable
from pvlvrt_compliance.data.problems import A_LIST, A_TABLE

if TYPE_CHECKING:  # numpy takes longer to import than a profile takes to read: only what evaluates a curve imports it
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

Point = tuple[float, float]
Points = tuple[Point, ...]


class MarkedPoint(Marked):
    """A point of an envelope with a mark of its own, in place of the envelope's."""

    t_s: float
    u_pu: float


def _form(value: Any) -> str:
    return A_TABLE if isinstance(value, (dict, MarkedPoint)) else A_LIST


AnyPoint = Annotated[Annotated[Point, Tag(A_LIST)] | Annotated[MarkedPoint, Tag(A_TABLE)], Discriminator(_form)]
AnyPoints = tuple[AnyPoint, ...]


def _plain(points: "AnyPoints") -> Points:
    return tuple((point.t_s, point.u_pu) if isinstance(point, MarkedPoint) else point for point in points)


LARGEST_LEVEL_PU = 2.0

VoltageQuantity = Literal[
    "positive_sequence",
    "mean_phase",
    "lowest_phase",
    "lowest_line_to_line",
    "highest_phase",
    "highest_line_to_line",
]
"""Voltage that a limit speaks of: one-cycle fundamental amplitudes in pu of nominal, the extreme one by its name."""


class Side(StrEnum):
    """Whether a limit bounds the voltage from below or from above."""

    LOW = "low"
    HIGH = "high"

    def allows(self, quantity: str) -> bool:
        """Whether a quantity makes sense on this side: the lowest voltage never meets an upper limit first."""
        return not quantity.startswith("highest" if self is Side.LOW else "lowest")


def _columns(points: Points) -> "tuple[NDArray[np.float64], NDArray[np.float64]]":
    import numpy as np

    table = np.asarray(points, dtype=np.float64)
    return table[:, 0], table[:, 1]


def _envelope_points(marked: AnyPoints) -> AnyPoints:
    points = _plain(marked)
    if points[0][0] != 0:
        raise ValueError(f"the first point must be at 0 s, the start of the sag, not at {points[0][0]:g} s")
    for (earlier, _), (later, _) in pairwise(points):
        if later < earlier:
            raise ValueError(f"times must not decrease: {earlier:g} s is followed by {later:g} s")
    _levels_in_range(points)
    return marked


def _curve_points(points: Points) -> Points:
    for (lower, _), (upper, _) in pairwise(points):
        if upper <= lower:
            raise ValueError(f"voltages must increase: {lower:g} pu is followed by {upper:g} pu")
    _levels_in_range(points)
    return points


def _levels_in_range(points: Points) -> None:
    for _, level in points:
        if not 0 <= level <= LARGEST_LEVEL_PU:
            raise ValueError(f"levels must lie between 0 and {LARGEST_LEVEL_PU:g} pu, not {level:g}")


class Envelope(MarkedTable):
    """Voltage over time since the start of a disturbance, up to which an inverter must stay connected.

    At and above it during a sag; as ``envelope_over_voltage``, at and below it during a swell. ``linear`` joins the
    points by straight lines, ``step`` holds a level until the next point. Before the first and after the last point
    their levels hold.
    """

    clause: str = ""
    voltage_quantity: VoltageQuantity
    interpolation: Literal["linear", "step"]
    points_as_written: Annotated[AnyPoints, AfterValidator(_envelope_points)] = Field(
        alias="points",
        min_length=1,
        description="[t_s, u_pu] each; a point with a mark of its own is a table of t_s, u_pu, confidence and source",
    )

    @cached_property
    def points(self) -> Points:
        """The points (s, pu), whatever their marks."""
        return _plain(self.points_as_written)

    @property
    def marked_rows(self) -> AnyPoints:
        """What may carry a mark of its own."""
        return self.points_as_written

    def mark_at(self, t_s: float) -> Mark:
        """The weaker mark of the two points that a time lies between (s), of one of them where it lies on it."""
        last = max((k for k, (t, _) in enumerate(self.points) if t <= t_s), default=0)
        beside = self.points_as_written[last : last + (1 if self.points[last][0] == t_s else 2)]
        return max(map(self.mark_of, beside), key=lambda mark: CONFIDENCES.index(mark.confidence))

    def voltage_at(self, t_s: "ArrayLike") -> "NDArray[np.float64]":
        """Level of the envelope (pu) at times since the start of the sag (s); shape of ``t_s``."""
        import numpy as np

        times, levels = _columns(self.points)
        if self.interpolation == "linear":
            return np.asarray(np.interp(np.asarray(t_s, dtype=np.float64), times, levels))
        reached = np.searchsorted(times, t_s, side="right") - 1
        return levels[np.maximum(reached, 0)]

    def held(self, begin_s: float, end_s: float) -> tuple[tuple[float, float], ...]:
        """Points (s, pu) that straight lines join as the envelope runs, from one time to another."""
        drawn: list[tuple[float, float]] = []
        inside = [(t, level) for t, level in self.points if t < end_s]
        for t, level in (*inside, (end_s, float(self.voltage_at(end_s)))):
            if drawn and self.interpolation == "step":
                drawn.append((max(t, begin_s), drawn[-1][1]))
            drawn.append((max(t, begin_s), level))
        return tuple(drawn)

    def time_of(self, u_pu: float, side: Side = Side.LOW) -> float | None:
        """How long a voltage must be ridden through (s): the first instant the envelope passes it.

        None where it never does: the voltage must be ridden through for ever.
        """
        sign = 1 if side is Side.LOW else -1
        above = next((k for k, (_, level) in enumerate(self.points) if sign * level > sign * u_pu), None)
        if above is None:
            return None
        t_above, u_above = self.points[above]
        if above == 0 or self.interpolation == "step":
            return t_above
        t_below, u_below = self.points[above - 1]
        return t_below + (t_above - t_below) * (u_pu - u_below) / (u_above - u_below)


class SupportCurve(Marked):
    """Reactive power demanded (pu of the rated apparent power) over the positive-sequence voltage (pu)."""

    clause: str = ""
    points: Annotated[Points, AfterValidator(_curve_points)] = Field(min_length=2, description="[u_pu, q_pu] each")

    def reactive_power_at(self, u_pu: "ArrayLike") -> "NDArray[np.float64]":
        """Reactive power (pu) at voltages (pu), straight lines between the points; shape of ``u_pu``."""
        import numpy as np

        voltages, powers = _columns(self.points)
        return np.asarray(np.interp(np.asarray(u_pu, dtype=np.float64), voltages, powers))


class RatioCurve(Marked):
    """Share of the reactive current in the total current (-) over the positive-sequence voltage (pu)."""

    clause: str = ""
    points: Annotated[Points, AfterValidator(_curve_points)] = Field(min_length=2, description="[u_pu, share] each")

    def share_at(self, u_pu: "ArrayLike") -> "NDArray[np.float64]":
        """Share at voltages (pu), straight lines between the points; shape of ``u_pu``."""
        import numpy as np

        voltages, shares = _columns(self.points)
        return np.asarray(np.interp(np.asarray(u_pu, dtype=np.float64), voltages, shares))
