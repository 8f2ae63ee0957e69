"""A controller that holds its steady state and throws its switches at instants that are set."""

import cmath
import math

NEVER = 1e9
THIRD = cmath.exp(2j * math.pi / 3)


class Switching:
    """Open loop: what modulates is turned on with the grid by one sample."""

    sample_time_s = 40.9568e-6
    switches = ("trip", "block", "restart")

    def __init__(self, trip_at=NEVER, block_at=NEVER, unblock_at=NEVER, restart_at=NEVER):
        self.trip_at, self.block_at, self.unblock_at, self.restart_at = trip_at, block_at, unblock_at, restart_at

    def reset(self, nominal):
        """Nothing is kept but the turn of a sample."""
        self.turn = cmath.exp(2j * math.pi * nominal.frequency_hz * self.sample_time_s)

    def step(self, y):
        """What acts already, turned on; switches by the clock."""
        m = self.turn * complex(y.m_a, (y.m_b - y.m_c) / math.sqrt(3))
        t = y.time_s
        switches = (t >= self.trip_at, self.block_at <= t < self.unblock_at, t >= self.restart_at)
        return (m.real, (m / THIRD).real, (m * THIRD).real, *switches)


class WithoutRestart(Switching):
    """It has none, so that a block ends by itself."""

    switches = ("trip", "block")

    def step(self, y):
        """The same less the last."""
        return super().step(y)[:-1]


class NoSwitch(Switching):
    """Its block is no number from 1.3 s on."""

    switches = ("block",)

    def step(self, y):
        """The same voltages."""
        return (*super().step(y)[:3], math.nan if y.time_s > 1.3 else 0.0)


class WoundUp(Switching):
    """It blocks from 1.3 s on, and commands a voltage beyond all limits then."""

    switches = ("block",)

    def step(self, y):
        """The same voltages, until it blocks."""
        blocks = y.time_s > 1.3
        m = super().step(y)[:3]
        return (*(1e3 * x for x in m), True) if blocks else (*m, False)


class Wrong(Switching):
    """It names a switch that there is not."""

    switches = ("trip", "open")


class TooFew(Switching):
    """It forgets its switches."""

    def step(self, y):
        """Three numbers."""
        return super().step(y)[:3]
