"""Controllers in Python that a replay is tried with."""

import math
import os
import sys


class Told:
    """Gives what it is told of the time, of its slow task and of its rating."""

    sample_time_s = 1e-4
    every = 5

    def reset(self, nominal):
        """Start anew."""
        self.slow, self.power = 0.0, nominal.apparent_power_va

    def step_slow(self, y):
        """Count."""
        self.slow += y.slow_task_due

    def step(self, y):
        """The time and the count."""
        return y.time_s, self.slow, self.power


class Reads:
    """Reads more than a voltage, in its first sample or later."""

    sample_time_s = 1e-4

    def __init__(self, from_s=0.0):
        self.from_s = from_s

    def reset(self, nominal):
        """Start anew."""

    def step(self, y):
        """A sum of what is read."""
        more = y.i_dc_a + y.enabled if y.time_s >= self.from_s else 0.0
        return y.u_a_v + more, 0.0, 0.0


class Wrong:
    """Goes wrong from 5 ms on, by one of several ways."""

    sample_time_s = 1e-4

    def __init__(self, how="nan"):
        self.how = how

    def reset(self, nominal):
        """Start anew."""
        del nominal
        if self.how == "reset":
            raise RuntimeError("not in this mood")

    def step(self, y):
        """One volt is one."""
        if y.time_s < 0.00499:
            return y.u_a_v, 1.0, 2.0
        if self.how == "raises":
            raise RuntimeError("lost its way")
        if self.how == "dies":
            sys.stderr.write("no more sense\n")
            sys.stderr.flush()
            os._exit(7)
        if self.how == "hangs":
            while True:
                pass
        if self.how == "memory":
            self.much = b"x" * 400_000_000
        return {"nan": math.nan, "inf": -math.inf}.get(self.how, 0.0), 1.0, 2.0


class Odd:
    """Says a name of a further signal that is one of the record's."""

    sample_time_s = 1e-4

    def reset(self, nominal):
        """Start anew."""

    def step(self, y):
        """Nothing."""
        del y
        return 0.0, 0.0, 0.0

    def signals(self):
        """Further signals."""
        return {"twice_v": 2.0, "p_ref_w": 3.0}
