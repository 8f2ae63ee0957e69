"""LCL1000 in Python: what law.h computes, and a class that gives it the signals of a plant.

Space vectors are as long as the amplitude of the phases: u = 2/3 (u_a + u_b exp(j 120 deg) + u_c exp(j 240 deg)).
"""

import cmath
import math
from typing import NamedTuple

SAMPLE_TIME = 100e-6
LEAST_VOLTAGE = 0.1  # pu: no current is made larger by less voltage, and no frequency is measured below
LEAST_LENGTH = 0.02  # pu: below it the positive sequence has no direction
TURN = cmath.exp(2j * math.pi / 3)


class Inputs(NamedTuple):
    """One sample, in the units of the ports."""

    VCa: float  # kV, filter capacitor
    VCb: float
    VCc: float
    VGa: float  # kV, grid terminals
    VGb: float
    VGc: float
    I1a: float  # kA, inverter side of the filter, out of the bridge
    I1b: float
    I1c: float
    I2a: float  # kA, grid side, into the grid
    I2b: float
    I2c: float
    Vdc: float  # kV
    Vdc_MPP: float
    P_avail: float  # MW
    P_request: float  # pu
    Q_request: float
    Run: float
    CB_closed: float


class Law:
    """The controller; parameters as of dll.c."""

    def __init__(self, **parameters):
        vars(self).update(parameters)
        self.kv = math.sqrt(2 / 3) * self.VLLbase / 1000
        self.ka = math.sqrt(2 / 3) * self.Sbase / self.VLLbase
        self.mva = self.Sbase / 1000
        self.w_base = 2 * math.pi * self.fbase
        self.ahead = cmath.exp(1j * self.w_base * SAMPLE_TIME)
        self.bandwidth = 0.5 * self.Ksync * self.w_base
        self.uv1_samples, self.uv2_samples = samples(self.UV1_delay), samples(self.UV2_delay)
        self.mc_samples = samples(self.MC_release)
        self.uv1 = self.uv2 = self.mc = 0  # samples below a level, and those that a block still lasts
        self.started = self.tripped = False

    def step(self, y):
        """Outputs of one sample, by their names."""
        u, v = vector(y.VCa, y.VCb, y.VCc) / self.kv, vector(y.VGa, y.VGb, y.VGc) / self.kv
        i1, i2 = vector(y.I1a, y.I1b, y.I1c) / self.ka, vector(y.I2a, y.I2b, y.I2c) / self.ka
        power = v * i2.conjugate()
        if not self.started:
            self.begin(v, power)
        pos, neg = self.synchronised(v)
        v_pos, v_min = abs(pos), lowest(pos, neg)
        acts = bool(y.Run and y.CB_closed)
        self.protect(v_min, acts)
        blocks = self.tripped or self.mc > 0
        works = acts and not blocks
        iq = self.reactive_current(v_pos, y.Q_request)
        self.p = self.active_power(v_pos, iq, y) if works else power.real
        i_ref = (self.p / max(v_pos, LEAST_VOLTAGE) - 1j * iq) * pos / max(v_pos, LEAST_LENGTH)
        e = self.kv * self.bridge_voltage(u, i1, i_ref, pos, neg, works, y.Vdc)
        return {
            "Ea": e.real,
            "Eb": (e / TURN).real,
            "Ec": (e * TURN).real,
            "TRIP": self.tripped,
            "BLOCK": blocks,
            "Vpos": v_pos,
            "Vmin": v_min,
            "Freq": self.fbase + self.slip_used / (2 * math.pi),
            "P_meas": power.real * self.mva,
            "Q_meas": power.imag * self.mva,
            "P_ref": self.p * self.mva,
            "Q_ref": iq * v_pos * self.mva,
        }

    def begin(self, v, power):
        """Start in the steady state that the inputs show."""
        self.pos, self.neg, self.slip, self.p = v, 0j, 0.0, power.real
        self.r_pos = self.r_neg = 0j
        self.started = True

    def synchronised(self, v):
        """Sequences of the grid's voltage, right at its frequency, which is followed."""
        before = self.pos
        correction = self.bandwidth * SAMPLE_TIME * (v - self.pos - self.neg)
        pos, neg = self.pos + correction, self.neg + correction
        if abs(pos) > LEAST_VOLTAGE and abs(before) > LEAST_VOLTAGE:
            turned = cmath.phase(pos * before.conjugate())
            self.slip += SAMPLE_TIME / self.Tfreq * (turned / SAMPLE_TIME - self.slip)
        self.pos, self.neg = pos * self.ahead, neg * self.ahead.conjugate()
        self.slip_used = within(self.slip, -0.1 * self.w_base, 0.1 * self.w_base)
        lag = self.slip_used / self.bandwidth
        return pos * (1 + 1j * lag), neg * (1 - 1j * lag)

    def protect(self, v_min, acts):
        """Two steps of under-voltage protection, and momentary cessation."""
        if not acts:
            self.uv1 = self.uv2 = self.mc = 0
            return
        self.uv1 = self.uv1 + 1 if v_min < self.UV1_level else 0
        self.uv2 = self.uv2 + 1 if v_min < self.UV2_level else 0
        self.tripped |= self.uv1 > self.uv1_samples or self.uv2 > self.uv2_samples
        if self.MC_enable and v_min < self.MC_level:
            self.mc = self.mc_samples + 1
        elif self.mc > 0:
            self.mc -= 1

    def reactive_current(self, v_pos, asked):
        """By the set-point and the depth of the sag."""
        depth = max(self.Vlow - v_pos, 0.0) - max(v_pos - self.Vhigh, 0.0)
        return within(asked / max(v_pos, LEAST_VOLTAGE) + self.Kfrt * depth, -self.Imax, self.Imax)

    def active_power(self, v_pos, iq, y):
        """By what is available, the DC voltage, the set-point and what current is left; it comes back in time."""
        by_dc = y.P_avail / self.mva + self.Kdc * (y.Vdc / y.Vdc_MPP - 1)
        carried = math.sqrt(self.Imax**2 - iq**2) * v_pos
        return min(max(by_dc, 0.0), y.P_request, carried, self.p + self.P_ramp * SAMPLE_TIME)

    def bridge_voltage(self, u, i1, i_ref, pos, neg, works, v_dc):
        """Voltage (pu): the grid's in the middle of the time that the command acts in, and what the regulators add."""
        turn = cmath.exp(1j * (self.w_base + self.slip_used) * SAMPLE_TIME)
        middle = turn**1.5
        error = i_ref - i1 if works else 0j
        if works:
            self.r_pos += self.Ki * SAMPLE_TIME * error
            self.r_neg += self.Ki * SAMPLE_TIME * error
        else:
            self.r_pos, self.r_neg = complex(self.R1, self.X1) * i1, 0j
        self.r_pos *= turn
        self.r_neg *= turn.conjugate()
        e = u + (middle - 1) * pos + (middle.conjugate() - 1) * neg + self.Kp * error + self.r_pos + self.r_neg
        most = v_dc / math.sqrt(3) / self.kv
        return e * most / abs(e) if abs(e) > most else e


class LCL1000:
    """The law where capacitor and terminals are at one voltage, and either side of the filter has one current."""

    sample_time_s = SAMPLE_TIME
    commands_voltages = True
    switches = ("trip", "block")

    def __init__(
        self,
        VLLbase=600.0,
        Sbase=1000.0,
        fbase=50.0,
        Imax=1.1,
        R1=0.003,
        X1=0.15,
        Kp=1.2,
        Ki=190.0,
        Kdc=6.5,
        Ksync=1.414,
        Tfreq=0.05,
        Kfrt=3.5,
        Vlow=0.9,
        Vhigh=1.1,
        P_ramp=5.0,
        UV1_level=0.85,
        UV1_delay=1.6,
        UV2_level=0.45,
        UV2_delay=1.0,
        MC_enable=0,
        MC_level=0.5,
        MC_release=0.02,
    ):
        self.parameters = {name: value for name, value in locals().items() if name != "self"}

    def reset(self, nominal):
        """Start anew; the bases are the model's own, whatever the plant's rating is."""
        self.law = Law(**self.parameters)
        self.rating = nominal.apparent_power_va
        self.said = dict.fromkeys(("v_fault_pu", "Vmin", "Freq", "P_meas", "Q_meas", "P_ref", "Q_ref"), 0.0)

    def step(self, y):
        """Voltages of the bridge (V), trip and block."""
        u = (y.u_a_v / 1000, y.u_b_v / 1000, y.u_c_v / 1000)
        i = (y.i_a_a / 1000, y.i_b_a / 1000, y.i_c_a / 1000)
        requests = (y.p_set_w / self.rating, y.q_set_var / self.rating)
        direct = (y.v_dc_v / 1000, y.v_dc_nominal_v / 1000, y.p_available_w / 1e6)
        out = self.law.step(Inputs(*u, *u, *i, *i, *direct, *requests, y.enabled, y.connected))
        self.said = {"v_fault_pu": out["Vpos"]} | {name: out[name] for name in self.said if name in out}
        return 1000 * out["Ea"], 1000 * out["Eb"], 1000 * out["Ec"], out["TRIP"], out["BLOCK"]

    def signals(self):
        """What is recorded besides."""
        return self.said


def samples(time_s):
    """Whole samples of a time."""
    return round(time_s / SAMPLE_TIME)


def vector(a, b, c):
    """Space vector of three phases; what they have in common drops out."""
    return 2 / 3 * (a + TURN * b + TURN.conjugate() * c)


def within(x, least, most):
    """A number, at least and at most."""
    return min(max(x, least), most)


def lowest(pos, neg):
    """Lowest voltage of a phase, from both sequences."""
    return min(abs(pos * back + (neg * back).conjugate()) for back in (1, TURN, TURN.conjugate()))
