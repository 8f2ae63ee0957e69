"""A controller that feeds the active power it is asked for, whatever the voltage, within its rated current."""

import cmath
import math

TURN = cmath.exp(2j * math.pi / 3)


class ConstantPower:
    """Currents of constant power by a proportional regulator around the grid's voltage, turned on by one sample.

    It regulates no DC voltage: it feeds somewhat less than it is asked for, which may be all that the array gives, so
    that the array settles above its point of maximum power.
    """

    sample_time_s = 5e-5

    def __init__(self, share=0.98, asked_w=0.0):
        self.share, self.asked_w = share, asked_w  # of what it is asked for; what it goes by instead (W; 0: p_set_w)

    def reset(self, nominal):
        """Nothing is kept but ratings and the turn of a sample."""
        self.turn = cmath.exp(2j * math.pi * nominal.frequency_hz * self.sample_time_s)
        self.voltage = math.sqrt(2) * nominal.phase_voltage_v
        self.most_a = nominal.apparent_power_va / (1.5 * self.voltage)

    def step(self, y):
        """Modulating signals."""
        u, i = vector(y.u_a_v, y.u_b_v, y.u_c_v), vector(y.i_a_a, y.i_b_a, y.i_c_a)
        watts = self.share * (self.asked_w or y.p_set_w)
        size = max(abs(u), 0.02 * self.voltage)
        wanted = min(watts / (1.5 * size), self.most_a) * u / size
        m = (self.turn * u + 0.2 * (wanted - i)) * 2 / max(y.v_dc_v, 1.0)
        return m.real, (m / TURN).real, (m * TURN).real


def vector(a, b, c):
    """Space vector of three phases, as long as their amplitude."""
    return 2 / 3 * (a + TURN * b + TURN**2 * c)


class Hasty(ConstantPower):
    """The same with a protection of its own, which trips when the voltage has long been low."""

    switches = ("trip",)

    def __init__(self, trip_after_s=1.0):
        super().__init__()
        self.trip_after_s = trip_after_s

    def reset(self, nominal):
        """Begin; the voltage has not been low."""
        super().reset(nominal)
        self.low_s = 0.0

    def step(self, y):
        """Modulating signals, and whether it trips."""
        is_low = abs(vector(y.u_a_v, y.u_b_v, y.u_c_v)) < 0.85 * self.voltage
        self.low_s = self.low_s + self.sample_time_s if is_low else 0.0
        return (*super().step(y), self.low_s > self.trip_after_s)
