"""The bundled controller with a protection of its own, which trips it or blocks its bridge."""

from bundled import Bundled

NEVER = 1e9


class Protected(Bundled):
    """It goes by its own V_fault: trips when that has long been low, blocks while it is very low."""

    switches = ("trip", "block")

    def __init__(self, trip_below_pu=0.85, trip_after_s=NEVER, block_below_pu=0.0):
        self.trip_below_pu, self.trip_after_s, self.block_below_pu = trip_below_pu, trip_after_s, block_below_pu

    def reset(self, nominal):
        """Begin as the bundled one; the voltage has not been low."""
        super().reset(nominal)
        self.low_s, self.blocks = 0.0, False

    def step(self, y):
        """Advance by one sample."""
        if self.blocks:  # as if the currents followed, so that no regulator winds up
            y = y._replace(i_a_a=self.wanted.a, i_b_a=self.wanted.b, i_c_a=self.wanted.c)
        m = super().step(y)
        v_fault_pu = self.beliefs[0]
        self.low_s = self.low_s + self.sample_time_s if v_fault_pu < self.trip_below_pu else 0.0
        self.blocks = v_fault_pu < self.block_below_pu
        return (*m, self.low_s > self.trip_after_s, self.blocks)
