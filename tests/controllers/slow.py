"""A controller with a slow task."""

from small import Small


class Slow(Small):
    """It holds what modulates and counts how often each of its tasks has run."""

    every = 25

    def __init__(self):
        self.fast, self.slow, self.together = 0, 0, 0

    def step_slow(self, y):  # noqa: ARG002 - the protocol's
        """Before the fast one."""
        self.slow += 1
        self.together += self.fast % 25 == 0

    def step(self, y):
        """Hold."""
        self.fast += 1
        return y.m_a, y.m_b, y.m_c

    def signals(self):
        """Counts."""
        return {"fast": self.fast, "slow": self.slow, "together": self.together}


class WithoutPeriod(Slow):
    """It does not say how slow."""

    every = None
