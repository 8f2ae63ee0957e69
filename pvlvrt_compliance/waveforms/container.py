"""Uniformly sampled channels in segments, with units."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import MeasurementError

Samples = NDArray[np.float64]

UNITS_BY_SUFFIX = {
    "_v": "V",
    "_a": "A",
    "_w": "W",
    "_var": "var",
    "_va": "VA",
    "_hz": "Hz",
    "_pu": "pu",
    "_s": "s",
    "_w_m2": "W/m2",
}
"""Unit of a channel by the end of its name; the longest ending wins, no ending means a pure number."""

STATUS_CHANNELS = frozenset({"connected", "fault_signal"})
"""Channels that hold 0 or 1 only."""


PURE_NUMBERS = frozenset({"m_a"})
"""Names whose ending looks like a unit and is none: m_a modulates phase a, as m_b does phase b."""


def unit_of(channel: str) -> str:
    """Unit of a channel from the end of its name (``u_a_v`` is in V)."""
    if channel in PURE_NUMBERS:
        return ""
    endings = [s for s in UNITS_BY_SUFFIX if channel.endswith(s)]
    return UNITS_BY_SUFFIX[max(endings, key=len)] if endings else ""


def phase_channels(kind: str) -> list[str]:
    """Names of the channels of voltages ``u``, source voltages ``u0`` (V) or currents ``i`` (A) of the three phases."""
    unit = "a" if kind == "i" else "v"
    return [f"{kind}_{phase}_{unit}" for phase in "abc"]


class ThreePhase(NamedTuple):
    """Samples of three phases, one array each."""

    a: Samples
    b: Samples
    c: Samples


@dataclass(frozen=True, eq=False)
class Segment:
    """Channels on one uniform grid: sample k is at ``t0_s + k * dt_s``.

    Parameters
    ----------
    t0_s, dt_s : float
        Time of the first sample and step (s).
    channels : mapping of str to array, shape (n,)
        Samples by channel name, all of the same length.
    """

    t0_s: float
    dt_s: float
    channels: Mapping[str, Samples]

    def __post_init__(self) -> None:
        if len({len(x) for x in self.channels.values()}) > 1:
            raise ValueError("channels of one segment must have the same length")

    def __len__(self) -> int:
        return len(next(iter(self.channels.values()))) if self.channels else 0

    def __getitem__(self, channel: str) -> Samples:
        try:
            return self.channels[channel]
        except KeyError:
            raise MeasurementError(f"the record has no channel {channel!r}") from None

    @property
    def end_s(self) -> float:
        """Time of the last sample (s)."""
        return self.t0_s + (len(self) - 1) * self.dt_s

    @property
    def t_s(self) -> Samples:
        """Time of every sample (s)."""
        return self.t0_s + self.dt_s * np.arange(len(self), dtype=np.float64)

    def index_at(self, t_s: float) -> int:
        """Index of the first sample at or after a time, between 0 and the number of samples."""
        return min(max(math.ceil((t_s - self.t0_s) / self.dt_s - 1e-6), 0), len(self))

    def three_phase(self, kind: str) -> ThreePhase:
        """Voltages ``u``, source voltages ``u0`` (V) or currents ``i`` (A) of the three phases."""
        return ThreePhase(*(self[name] for name in phase_channels(kind)))

    def slice(self, start_s: float, stop_s: float) -> "Segment":
        """Samples with ``start_s <= t < stop_s``."""
        i, j = self.index_at(start_s), self.index_at(stop_s)
        return Segment(self.t0_s + i * self.dt_s, self.dt_s, {name: x[i:j] for name, x in self.channels.items()})


@dataclass(frozen=True, eq=False)
class Waveforms:
    """A record: one segment, or several with steps of their own, in order of time.

    Parameters
    ----------
    segments : tuple of Segment
        The record.
    settling : tuple of Segment
        What was before it, where that was kept: to be looked at, never judged.
    tripped_at_s : float, optional
        When the plant tripped (s), where that is known better than from the samples: of a trip before the record.

    Raises
    ------
    ValueError
        When segments overlap, or differ in their channels.
    """

    segments: tuple[Segment, ...]
    settling: tuple[Segment, ...] = ()
    tripped_at_s: float | None = None

    def __post_init__(self) -> None:
        if not self.segments:
            raise ValueError("a record needs at least one segment")
        parts = (*self.settling, *self.segments)
        for before, after in pairwise(parts):
            if after.t0_s <= before.end_s:
                raise ValueError(f"segments overlap at {after.t0_s} s")
            if list(before.channels) != list(after.channels):
                raise ValueError("segments of one record must have the same channels")

    def __iter__(self) -> Iterator[Segment]:
        return iter(self.segments)

    @property
    def with_settling(self) -> "Waveforms":
        """Everything that was kept, as one record."""
        return Waveforms((*self.settling, *self.segments)) if self.settling else self

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the channels, without ``t_s``."""
        return tuple(self.segments[0].channels)

    @property
    def t0_s(self) -> float:
        """Time of the first sample (s)."""
        return self.segments[0].t0_s

    @property
    def end_s(self) -> float:
        """Time of the last sample (s)."""
        return self.segments[-1].end_s

    def segment_with(self, start_s: float, stop_s: float) -> Segment | None:
        """Return the segment that a window lies in, None when it crosses a change of the sampling step.

        Raises
        ------
        MeasurementError
            When the window leaves the record.
        """
        slack = max(s.dt_s for s in self.segments)
        if start_s < self.t0_s - slack or stop_s > self.end_s + 2 * slack:
            raise MeasurementError(
                f"the window {start_s:.3f} s to {stop_s:.3f} s leaves the record "
                f"({self.t0_s:.3f} s to {self.end_s:.3f} s)"
            )
        for segment in self.segments:
            if start_s >= segment.t0_s - segment.dt_s and stop_s <= segment.end_s + 2 * segment.dt_s:
                return segment
        return None

    def window(self, start_s: float, stop_s: float) -> Segment:
        """Samples with ``start_s <= t < stop_s``, which must lie in one segment (else see `joining`).

        Raises
        ------
        MeasurementError
            When the window leaves the record or crosses a change of the sampling step.
        """
        segment = self.segment_with(start_s, stop_s)
        if segment is None:
            raise MeasurementError(
                f"the window {start_s:.3f} s to {stop_s:.3f} s crosses a change of the sampling step"
            )
        return segment.slice(start_s, stop_s)
