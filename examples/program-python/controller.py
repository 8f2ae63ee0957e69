"""A controller of a PV inverter in a program of its own, which talks by lines of JSON.

    pvlvrt-check --controller "stdio:python3 examples/program-python/controller.py" --sag 60%

Nothing here is particular to Python: read a line, answer by a line. It synchronises by a DSOGI at the nominal
frequency, holds the DC voltage, gives reactive power by the depth of a sag, and regulates the currents by resonators.
Space vectors are complex numbers as long as the amplitude of the phases.
"""

import cmath
import json
import math
import sys

SAMPLE_TIME_S = 100e-6
INPUTS = ["u_a_v", "u_b_v", "u_c_v", "i_a_a", "i_b_a", "i_c_a", "m_a", "m_b", "m_c", "v_dc_v", "enabled"]
OUTPUTS = ["m_a", "m_b", "m_c", "v_fault_pu"]
PARAMETERS = {
    "dc_voltage_v": {"value": 807.0, "unit": "V", "minimum": 600.0, "maximum": 1000.0},
    "reactive_gain": {"value": 2.14, "minimum": 0.0, "maximum": 10.0, "description": "pu per pu below 0.85 pu"},
}
TURN = cmath.exp(2j * math.pi / 3)


def vector(a, b, c):
    """Space vector of three phases."""
    return 2 / 3 * (a + TURN * b + TURN**2 * c)


class Controller:
    """One controller, from rest."""

    def __init__(self, nominal, parameters):
        self.power = nominal["apparent_power_va"]
        self.voltage = math.sqrt(2) * nominal["phase_voltage_v"]
        self.angle = 2 * math.pi * nominal["frequency_hz"] * SAMPLE_TIME_S  # of a sample (rad)
        self.turn = cmath.exp(1j * self.angle)
        self.dc_voltage = parameters["dc_voltage_v"]
        self.reactive_gain = parameters["reactive_gain"]
        self.u_pos = self.u_neg = 0j  # sequences of the grid's voltage (V)
        self.r_pos = self.r_neg = 0j  # resonators of the current control (V)
        self.p_integral = 0.0  # of the DC-voltage control (W)

    def step(self, y):
        """Modulating signals from one sample, by name: u_a = m_a v_DC / 2."""
        u, i = vector(y["u_a_v"], y["u_b_v"], y["u_c_v"]), vector(y["i_a_a"], y["i_b_a"], y["i_c_a"])
        self.synchronise(u)
        if not y["enabled"]:
            self.p_integral = 1.5 * (u * i.conjugate()).real
        error = self.current_reference(y["v_dc_v"]) - i
        if not y["enabled"]:  # what modulates now is what the resonator has to go on with
            acting = vector(y["m_a"], y["m_b"], y["m_c"]) * y["v_dc_v"] / 2
            self.r_pos, self.r_neg = acting * self.turn - u - 0.38 * error, 0j
        m = self.bridge_voltage(u, error) * 2 / max(y["v_dc_v"], 1.0)
        v_pu = abs(self.u_pos) / self.voltage
        self.u_pos, self.u_neg = self.u_pos * self.turn, self.u_neg / self.turn
        return {"m_a": m.real, "m_b": (m / TURN).real, "m_c": (m / TURN**2).real, "v_fault_pu": v_pu}

    def synchronise(self, u):
        """Follow the sequences of the voltage, by one oscillator each."""
        error = u - self.u_pos - self.u_neg
        self.u_pos += 0.7 * self.angle * error
        self.u_neg += 0.7 * self.angle * error

    def current_reference(self, v_dc):
        """Currents of constant active power, within the rating, from the DC voltage and the depth of the sag."""
        pos, neg = self.u_pos, self.u_neg
        size = abs(pos) ** 2 - abs(neg) ** 2
        if size < (0.01 * self.voltage) ** 2:
            return 0j
        most = min((abs(pos) - abs(neg)) / self.voltage, 1.0)  # what nominal current carries (pu)
        q = min(self.reactive_gain * max(0.85 - abs(pos) / self.voltage, 0.0), 0.75, most)
        p_most = math.sqrt(most**2 - q**2) * self.power
        error = v_dc - self.dc_voltage
        self.p_integral = min(max(self.p_integral + 150e3 * SAMPLE_TIME_S * error, 0.0), p_most)
        p = min(max(self.p_integral + 4000.0 * error, 0.0), p_most)
        return 2 / 3 * (p * (pos - neg) - 1j * q * self.power * (pos + neg)) / size

    def bridge_voltage(self, u, error):
        """The grid's voltage, and what makes the currents what they should be."""
        self.r_pos += 60.0 * SAMPLE_TIME_S * error
        self.r_neg += 60.0 * SAMPLE_TIME_S * error
        self.r_pos, self.r_neg = self.r_pos * self.turn, self.r_neg / self.turn
        return u + 0.38 * error + self.r_pos + self.r_neg


def say(message):
    """Send one line, at once."""
    sys.stdout.write(json.dumps(message) + "\n")
    sys.stdout.flush()


def main():
    """Answer line by line until the end."""
    controller = None
    for line in sys.stdin:
        message = json.loads(line)
        if "protocol" in message:
            hello = {"version": 1, "name": "program-python 1.0", "sample_time_s": SAMPLE_TIME_S, "mode": "json"}
            say(hello | {"inputs": INPUTS, "outputs": OUTPUTS, "parameters": PARAMETERS})
        elif "start" in message:
            controller = Controller(message["start"]["nominal"], message["start"]["parameters"])
            say({"ready": True})
        elif "end" in message:
            break
        else:
            say(controller.step(message))


if __name__ == "__main__":
    main()
