"""A controller that holds its power well enough, until it does what its parameter says."""

import ctypes
import math
import os
import subprocess
import sys


def _loop():
    while True:
        pass


DEEDS = {
    "raise": lambda: {}["gain"],
    "nan": lambda: (math.nan, 0.0, 0.0),
    "range": lambda: (0.0, 50.0, 0.0),
    "two": lambda: (1.0, 2.0),
    "none": lambda: None,
    "words": lambda: ("a", "b", "c"),
    "exit": lambda: os._exit(0),
    "sys.exit": lambda: sys.exit(3),
    "crash": lambda: ctypes.string_at(0),
    "loop": _loop,
    "orphan": lambda: subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"]) and os._exit(5),
}


class Controller:
    """Voltage ahead, and a proportional regulator of the current."""

    count = 0

    def __init__(self, sample_time_s: float = 2e-4, deed: str = "", at_s: float = 0.5, say: bool = False):
        self.sample_time_s, self.deed, self.at_s, self.say = sample_time_s, deed, at_s, say
        self.seen = []

    def reset(self, nominal):
        """Start anew."""
        type(self).count += 1
        self.nominal = nominal

    def step(self, y):
        """Ask for 80 % of nominal power, in phase with the voltage."""
        self.last = y
        if self.say:
            print('{"status": "pass"}')  # noqa: T201 - the point of it
        if self.deed and y.time_s >= self.at_s:
            print(f"about to {self.deed}")  # noqa: T201 - the point of it
            sys.stdout.flush()
            return DEEDS[self.deed]()
        u, i = y[1:4], y[4:7]
        g = 0.8 * y.p_set_w / (3 * y.voltage_nominal_v**2)
        return [(x + 0.1 * (g * x - z)) / (0.5 * y.v_dc_v) for x, z in zip(u, i, strict=True)]

    def signals(self):
        """What the last measurement was, and how many controllers this process has seen."""
        y = getattr(self, "last", None)
        return {
            "count": self.count,
            "time_s": y.time_s if y else 0.0,
            "enabled": y.enabled if y else 0.0,
            "u_sampled_v": y.u_a_v if y else 0.0,
            "i_dc_a": y.i_dc_a if y else 0.0,
        }
