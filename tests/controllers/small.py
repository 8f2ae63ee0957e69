"""What small_fmu.c does, in Python."""


class Small:
    """Its commands are what modulates, times a gain."""

    sample_time_s = 1e-4

    def __init__(self, gain=1.0):
        self.gain = gain

    def reset(self, nominal):
        """Nothing is kept."""

    def step(self, y):
        """Hold what is."""
        return self.gain * y.m_a, self.gain * y.m_b, self.gain * y.m_c
