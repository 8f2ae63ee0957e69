"""A small controller of a grid-connected PV inverter that rides through voltage sags.

Synchronisation (a DSOGI with a frequency-locked loop), DC-voltage control, reactive power by the depth of the sag,
references for constant active power, and resonant current control. Space vectors are complex numbers as long as the
amplitude of the phases: u = 2/3 (u_a + u_b exp(j 120 deg) + u_c exp(j 240 deg)).
"""

import cmath
import math

TURN = cmath.exp(2j * math.pi / 3)


class Controller:
    """Called once every ``sample_time_s``; its keyword arguments are set by ``--set controller.NAME=VALUE``."""

    sample_time_s = 100e-6

    def __init__(
        self,
        dc_voltage_v=807.0,  # at which the array gives its most
        dc_proportional_w_per_v=4000.0,
        dc_integral_w_per_vs=150e3,
        current_proportional_ohm=0.38,  # filter inductance by 2 pi 400 Hz
        current_resonant_ohm_per_s=60.0,
        dsogi_gain=1.414,
        fll_gain=50.0,
        fault_threshold_pu=0.85,
        plateau_voltage_pu=0.5,
        plateau_power_pu=0.75,
    ):
        self.dc_voltage_v = dc_voltage_v
        self.dc_proportional_w_per_v = dc_proportional_w_per_v
        self.dc_integral_w_per_vs = dc_integral_w_per_vs
        self.current_proportional_ohm = current_proportional_ohm
        self.current_resonant_ohm_per_s = current_resonant_ohm_per_s
        self.dsogi_gain = dsogi_gain
        self.fll_gain = fll_gain
        self.fault_threshold_pu = fault_threshold_pu
        self.plateau_voltage_pu = plateau_voltage_pu
        self.plateau_power_pu = plateau_power_pu

    def reset(self, nominal):
        """Start at rest, for an inverter of this rating."""
        self.power = nominal.apparent_power_va
        self.voltage = math.sqrt(2) * nominal.phase_voltage_v
        self.w_nominal = 2 * math.pi * nominal.frequency_hz
        self.w = self.w_nominal
        self.u_pos = self.u_neg = 0j  # sequences of the grid's voltage (V)
        self.r_pos = self.r_neg = 0j  # resonators of the current control (V)
        self.p_integral = 0.0  # of the DC-voltage control (W)
        self.v_pu = self.q_ref = self.p_ref = 0.0

    def step(self, y):
        """Modulating signals of the three phases from one sample: u_a = m_a v_DC / 2."""
        u, i = vector(y.u_a_v, y.u_b_v, y.u_c_v), vector(y.i_a_a, y.i_b_a, y.i_c_a)
        turn = cmath.exp(1j * self.w * self.sample_time_s)
        self.synchronise(u)
        if not y.enabled:
            self.p_integral = 1.5 * (u * i.conjugate()).real
        self.p_ref, self.q_ref = self.powers(y.v_dc_v)
        error = self.current_reference() - i
        if not y.enabled:  # what modulates now is what the resonator has to go on with
            acting = vector(y.m_a, y.m_b, y.m_c) * y.v_dc_v / 2
            self.r_pos, self.r_neg = acting * turn - u - self.current_proportional_ohm * error, 0j
        u_ref = self.regulate(error, u, turn)
        self.u_pos, self.u_neg = self.u_pos * turn, self.u_neg / turn
        return phases(u_ref * 2 / max(y.v_dc_v, 1.0))

    def synchronise(self, u):
        """Follow the sequences of the voltage, one oscillator each, and the frequency."""
        error = u - self.u_pos - self.u_neg
        gain = 0.5 * self.dsogi_gain * self.w * self.sample_time_s
        self.u_pos += gain * error
        self.u_neg += gain * error
        size = 2 * (abs(self.u_pos) ** 2 + abs(self.u_neg) ** 2)
        if size > (0.1 * self.voltage) ** 2:
            quadrature = -1j * (self.u_pos - self.u_neg)
            slip = (error * quadrature.conjugate()).real / size
            self.w -= self.sample_time_s * self.fll_gain * self.dsogi_gain * self.w * slip
            self.w = min(max(self.w, 0.9 * self.w_nominal), 1.1 * self.w_nominal)

    def powers(self, v_dc):
        """Active power from the DC voltage, reactive power from the depth of the sag; within the rating."""
        pos, neg = abs(self.u_pos) / self.voltage, abs(self.u_neg) / self.voltage
        self.v_pu = pos
        most = min(max(pos - neg, 0.0), 1.0) * self.power  # what nominal current carries
        depth = (self.fault_threshold_pu - pos) / (self.fault_threshold_pu - self.plateau_voltage_pu)
        q = min(self.plateau_power_pu * min(max(depth, 0.0), 1.0) * self.power, most)
        p_most = math.sqrt(most**2 - q**2)
        error = v_dc - self.dc_voltage_v
        self.p_integral += self.dc_integral_w_per_vs * self.sample_time_s * error
        self.p_integral = min(max(self.p_integral, 0.0), p_most)
        return min(max(self.p_integral + self.dc_proportional_w_per_v * error, 0.0), p_most), q

    def current_reference(self):
        """Sinusoidal currents that carry constant active power also in an unbalanced grid."""
        pos, neg = self.u_pos, self.u_neg
        size = abs(pos) ** 2 - abs(neg) ** 2
        if size < (0.01 * self.voltage) ** 2:
            return 0j
        return 2 / 3 * (self.p_ref * (pos - neg) - 1j * self.q_ref * (pos + neg)) / size

    def regulate(self, error, u, turn):
        """Voltage of the bridge: the grid's, and what a resonator for either sequence adds."""
        gain = self.current_resonant_ohm_per_s * self.sample_time_s
        self.r_pos += gain * error
        self.r_neg += gain * error
        u_ref = u + self.current_proportional_ohm * error + self.r_pos * turn + self.r_neg / turn
        self.r_pos, self.r_neg = self.r_pos * turn, self.r_neg / turn
        return u_ref

    def signals(self):
        """What is recorded besides."""
        return {"v_fault_pu": self.v_pu, "q_ref_var": self.q_ref, "p_ref_w": self.p_ref}


def vector(a, b, c):
    """Space vector of three phases; what they have in common drops out."""
    return 2 / 3 * (a + TURN * b + TURN**2 * c)


def phases(x):
    """The three phases of a space vector."""
    return x.real, (x / TURN).real, (x / TURN**2).real
