"""The example controller in Python, with a slip of its own: what a user's file might do wrong."""

import cmath
import importlib.util
import math
from pathlib import Path

import pvlvrt_compliance

_EXAMPLE = Path(pvlvrt_compliance.__file__).parent / "controllers" / "templates" / "python" / "controller.py"
_spec = importlib.util.spec_from_file_location("example_controller", _EXAMPLE)
_example = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(_example)


class Slipping(_example.Controller):
    """Right up to sag ``first``, and wrong in it and in all that follow: ``what`` by ``amount``."""

    def __init__(self, what="nothing", amount=0.0, first=2, **others):
        super().__init__(**others)
        self.what, self.amount, self.first = what, amount, first
        self.sags, self.t, self.since = 0, 0.0, 0.0
        self.in_sag = False

    def step(self, y):
        """Count sags and time, then do as the example."""
        self.t += self.sample_time_s
        low = self.v_pu < self.fault_threshold_pu and self.t > 0.1  # the example begins without a voltage
        if low != self.in_sag:
            self.sags, self.since, self.in_sag = self.sags + low, self.t, low
        return super().step(y)

    @property
    def slips(self):
        """Whether it is wrong now."""
        return self.in_sag and self.sags >= self.first

    def powers(self, v_dc):
        """Active and reactive power, or wrong ones."""
        p, q = super().powers(v_dc)
        if self.slips and self.what == "reactive power":
            q *= self.amount
        if self.slips and self.what == "active power":
            p *= self.amount
        if self.slips and self.what == "delay" and self.t - self.since < self.amount:
            q = 0.0
        return p, q

    def current_reference(self):
        """Currents, or wrong ones."""
        i = super().current_reference()
        if self.slips and self.what == "current":
            return self.amount * i
        if self.slips and self.what == "swing":
            return i * (1 + self.amount * math.sin(2 * math.pi * 10 * self.t))
        if self.slips and self.what == "turn":
            return i * cmath.exp(1j * self.amount)
        return i
