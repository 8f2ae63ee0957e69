"""Runs three-phase sags of a grid code with a controller class, and prints the worst margin."""

import cmath
import math

from pvlvrt_compliance import check

TURN = cmath.exp(2j * math.pi / 3)


class Instantaneous:
    """Feeds in what keeps the DC link at its voltage, reactive power in a sag. For balanced grids: it has no PLL."""

    sample_time_s = 100e-6

    def __init__(self, dc_voltage_v=807.0, fault_threshold_pu=0.85, plateau_pu=0.75):
        self.dc_voltage_v, self.fault_threshold_pu, self.plateau_pu = dc_voltage_v, fault_threshold_pu, plateau_pu

    def reset(self, nominal):
        """Start at rest, for an inverter of this rating."""
        self.rated, self.peak_v = nominal.apparent_power_va, math.sqrt(2) * nominal.phase_voltage_v
        self.w, self.integral = 2 * math.pi * nominal.frequency_hz, 0.0

    def step(self, y):
        """Modulating signals from one sample; space vectors are as long as the amplitude of the phases."""
        u = 2 / 3 * (y.u_a_v + TURN * y.u_b_v + TURN**2 * y.u_c_v)
        i = 2 / 3 * (y.i_a_a + TURN * y.i_b_a + TURN**2 * y.i_c_a)
        level, error = abs(u) / self.peak_v, y.v_dc_v - self.dc_voltage_v
        most = min(level, 1.0) * self.rated
        q = min(self.plateau_pu * min(max((self.fault_threshold_pu - level) / 0.35, 0.0), 1.0) * self.rated, most)
        if not y.enabled:  # as long as it does not act, it follows what flows
            self.integral = 1.5 * (u * i.conjugate()).real
        self.integral = min(max(self.integral + 15.0 * error, 0.0), math.sqrt(most**2 - q**2))
        p = min(max(self.integral + 4000.0 * error, 0.0), math.sqrt(most**2 - q**2))
        wanted = (p - 1j * q) / (1.5 * u.conjugate()) if level > 0.01 else 0j
        drop = 1j * self.w * 150e-6 * wanted + 0.38 * (wanted - i)  # over the filter's inductance
        m = 2 * (u + drop) * cmath.exp(1.5j * self.w * self.sample_time_s) / max(y.v_dc_v, 1.0)
        return m.real, (m / TURN).real, (m / TURN**2).real


results = check("iec61400-21", controller=Instantaneous, tests="VD3-*")
for test in results.tests:
    print(f"{test.id}: {test.status}")
worst = results.worst_margin()
print(f"worst: {worst.verdict.check} in {worst.test.id}, {worst.verdict.margin:+.3f} {worst.verdict.unit}")
print(f"       {worst.verdict.message}")
