import cmath
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pvlvrt_compliance.plant import carrier, switched_bridge
from pvlvrt_compliance.plant.inverter import M_MAX
from pvlvrt_compliance.plant.line import design
from pvlvrt_compliance.plant.pv_array import current_at
from pvlvrt_compliance.plant.switched_bridge import DeviceParams
from pvlvrt_compliance.space_vectors import clarke, phases

RATIO, T = 8, 40.9568e-6
L, R, C, W, V = 0.15e-3, 1e-3, 0.065, 2 * math.pi * 50, 834.0
IDEAL = {"dead_time_us": 0, "device_drop_v": 0, "device_resistance_ohm": 0, "switching_energy_mj": 0}
NO_LOSS = DeviceParams(t_dead=0.0, v_drop=0.0, t_loss=0.0)


def phase_values(z: complex) -> np.ndarray:
    """Three phase values of a vector."""
    return np.array([x.real for x in phases(math.sqrt(2 / 3) * z, 0, 0)])


@pytest.fixture(scope="session")
def period(in_python):
    """Run one carrier period: ``period(m, i=, e=, i_pv=, devices=, L=, C=) -> (i, v_dc, mean u, mean i)``."""
    pulses_of, flow = in_python(carrier.pulses_of), in_python(switched_bridge.switched_flow)

    def run(m, i=0j, e=0j, i_pv=0.0, devices=NO_LOSS, L=L, C=C, v_dc=V):
        line = design(L, R, 0.0, 0.0, T / RATIO)
        u_mean, i_mean = 0j, 0j
        for n in range(RATIO):
            found = flow(i, v_dc, i_pv, e, n, pulses_of(m, T), line, C, T / RATIO, devices)
            i, v_dc = found.i, found.v_dc
            u_mean, i_mean = u_mean + found.mean.u / RATIO, i_mean + found.mean.i / RATIO
        return i, v_dc, u_mean, i_mean

    return run


def test_the_period_mean_is_linear_in_the_modulating_signal(period):
    """A sweep as fine as 1/1000 of the range finds u = 2/3 v_DC m within 1e-6: no instant is rounded to a step."""
    for direction in (1, 1j, cmath.exp(0.4j)):
        m = direction * np.linspace(0, M_MAX, 1001)
        found = np.array([period(x, L=1e3, C=1e9)[2] for x in m])
        assert np.abs(found - 2 / 3 * V * m).max() < 1e-6 * V


def test_dead_time_costs_a_fixed_voltage_against_the_current(period):
    """The mean falls by v_DC t_dead / T in each phase, with the sign of its current."""
    i, m, t_dead = 1000 * cmath.exp(0.3j), 0.7 + 0.1j, 0.5e-6
    u = period(m, i, devices=NO_LOSS._replace(t_dead=t_dead), L=1e3, C=1e9)[2]
    error = -V * t_dead / T * clarke(*np.sign(phase_values(i)))
    assert u - 2 / 3 * V * m == pytest.approx(error, rel=1e-6)


def test_devices_drop_a_fixed_voltage_against_the_current(period):
    """Each phase loses the drop with the sign of its current."""
    i, m = 1000 * cmath.exp(2j), 0.7 + 0.1j
    u = period(m, i, devices=NO_LOSS._replace(v_drop=1.5), L=1e3, C=1e9)[2]
    assert u - 2 / 3 * V * m == pytest.approx(-1.5 * clarke(*np.sign(phase_values(i))), rel=1e-6)


@pytest.mark.parametrize("m", [0j, 0.6 + 0.2j, complex(M_MAX)])
def test_every_leg_turns_on_and_off_once_a_period(period, m):
    """The link loses (E_on + E_off) = t_loss v_DC |i| a leg and period; a leg at the end of its range loses nothing."""
    i, t_loss = 1000 * cmath.exp(1j), 30e-9
    lossless, lossy = (period(m, i, devices=NO_LOSS._replace(t_loss=x), L=1e3)[1] for x in (0.0, t_loss))
    # At the end of the linear range along alpha, the outer duties are 0.067 and 0.933: all legs still switch.
    assert C * (lossless - lossy) == pytest.approx(t_loss * np.abs(phase_values(i)).sum(), rel=1e-6)


def test_a_leg_that_does_not_switch_loses_nothing(period):
    """At the corner of the linear range one leg stays down and one up: only the third one's current counts."""
    i, m, t_loss = 1000 * cmath.exp(1j), M_MAX * cmath.exp(1j * math.pi / 6) * (1 + 1e-12), 30e-9
    lossless, lossy = (period(m, i, devices=NO_LOSS._replace(t_loss=x), L=1e3)[1] for x in (0.0, t_loss))
    assert C * (lossless - lossy) == pytest.approx(t_loss * abs(phase_values(i)[1]), rel=1e-6)


def test_what_leaves_the_link_enters_the_line(period):
    """Over a period the energy of the link falls by the mean power of the bridge, ripple included."""
    line_energy, e = 0.5 * L, 380 + 30j
    i0 = 900 * cmath.exp(0.2j)
    i, v_dc, _, i_mean = period(0.68 + 0.1j, i0, e)
    link = 0.5 * C * (V**2 - v_dc**2)
    line = line_energy * (abs(i) ** 2 - abs(i0) ** 2) + T * (e * i_mean.conjugate()).real
    lost = T * R * abs(i_mean) ** 2
    assert link == pytest.approx(line + lost, rel=1e-4)
    assert abs(line) > 10


def modulating_signal(periods: int) -> np.ndarray:
    """Modulating signals that hold some hundred amperes against the source."""
    return 0.72 * np.exp(1j * (W * T * np.arange(periods) + 0.06))


def source(t: float) -> complex:
    """Space vector of a healthy source (V)."""
    return math.sqrt(3) * 230 * cmath.exp(1j * W * (t - 0.3))


def duties_of(signal: complex) -> np.ndarray:
    """Duties of the three legs by the words of min-max injection: shifted to the middle of the carrier."""
    u = phase_values(2 / 3 * signal)
    return u - 0.5 * (u.max() + u.min()) + 0.5


def ideal_legs_by_events(p, m: np.ndarray, i0: complex) -> np.ndarray:
    """States (three phase currents, v_DC) after each period, by an integrator that stops at each switching."""

    def slope(t, x, up):
        u = up * x[3]
        di = (u - u.mean() - phase_values(source(t)) - R * x[:3]) / L
        return [*di, (current_at(x[3], 1000 * p.G, p.pv) - up @ x[:3]) / C]

    def meets(k, duty, n):
        def edge(t, _x, _up):
            return abs(1 - 2 * (t / T - n)) - duty

        edge.terminal, edge.leg = True, k
        return edge

    x, up, states = np.array([*phase_values(i0), V]), np.zeros(3), []
    for n, signal in enumerate(m):
        for half in range(2):
            edges = [meets(k, duty, n) for k, duty in enumerate(duties_of(signal))]
            t, end = (n + 0.5 * half) * T, (n + 0.5 * half + 0.5) * T
            while t < end:
                part = solve_ivp(slope, (t, end), x, args=(up,), events=edges, rtol=1e-10, atol=1e-8)
                t, x = part.t[-1], part.y[:, -1]
                met = [edge for edge, at in zip(edges, part.t_events, strict=True) if len(at)]
                up = up + (1 - 2 * half) * np.isin(range(3), [edge.leg for edge in met])
                edges = [edge for edge in edges if edge not in met]
        states.append(x)
    return np.array(states)


def test_open_loop_against_an_integrator_with_events(plant, open_loop):
    """Two periods of ideal legs agree with scipy's integrator, phase by phase, to 1e-7 of nominal."""
    m, i0 = modulating_signal(2), 900 * cmath.exp(0.4j)
    p, tables = plant(fidelity="switched", devices=IDEAL)
    i, v_dc = open_loop(p, tables, m, i0)
    expected = ideal_legs_by_events(p, m, i0)
    assert np.abs(np.array([phase_values(x) for x in i]) - expected[:, :3]).max() < 1e-4
    assert np.abs(v_dc - expected[:, 3]).max() < 1e-5


def gates(p, m: np.ndarray, i0: complex, dt: float) -> np.ndarray:
    """States (three phase currents, v_DC) after each period, from gate signals with delayed turn-on at a tiny step."""
    devices, steps = p.devices, round(T / dt)
    delay = round(devices.t_dead / dt)
    i, v, states = phase_values(i0), V, []
    off_upper = off_lower = np.full(3, 10 * delay)  # steps since the other switch has gone off
    for n, signal in enumerate(m):
        duty = duties_of(signal)
        i_pv = current_at(v, 1000 * p.G, p.pv)
        for k in range(steps):
            command = duty > abs(1 - 2 * (k + 0.5) / steps)
            off_lower, off_upper = (off_lower + 1) * command, (off_upper + 1) * ~command
            upper, lower = off_lower > delay, off_upper > delay
            up = np.where(upper | lower, upper, i < 0).astype(float)
            leg = up * v - np.sign(i) * devices.v_drop
            t = n * T + (k + 0.5) * dt
            e = phase_values(source(t))
            v += dt / C * (i_pv - up @ i)
            i = i + dt / L * (leg - leg.mean() - e - (R + 0.5e-3) * i)
        states.append([*i, v])
    return np.array(states)


@pytest.mark.parametrize(("i0", "allowed"), [(900 * cmath.exp(0.2j), 0.1), (-500 + 0j, 0.1), (700j, 2.8), (0j, 2.8)])
def test_open_loop_against_gate_signals(plant, open_loop, i0, allowed):
    """Two periods with dead time and drops agree with gates simulated at 5 ns.

    Where a current passes zero within a dead time, diodes would hold it there; here it goes on, which is worth
    v_DC t_dead / L = 2.8 A at most.
    """
    m = modulating_signal(2)
    p, tables = plant(fidelity="switched", devices={"device_drop_v": 1.5, "switching_energy_mj": 0})
    assert p.devices.t_dead > 0
    i, v_dc = open_loop(p, tables, m, i0)
    expected = gates(p, m, i0, T / 8192)
    assert np.abs(np.array([phase_values(x) for x in i]) - expected[:, :3]).max() < allowed
    assert np.abs(v_dc - expected[:, 3]).max() < 1e-3


@pytest.mark.parametrize("ratio", [1, 3, 8, 16])
def test_the_plant_step_hardly_matters(plant, open_loop, ratio):
    """Legs that change anywhere in a step, even all of them twice, give the currents of a fine step."""
    m, i0 = modulating_signal(20), 900 * cmath.exp(0.2j)
    currents = [open_loop(*plant(k, fidelity="switched"), m, i0)[0] for k in (ratio, 64)]
    assert np.abs(currents[0] - currents[1]).max() < 0.02


def test_ideal_legs_follow_the_averaged_inverter(plant, open_loop):
    """Sampled where the carrier turns, the current of ideal legs is that of the averaged inverter."""
    m = modulating_signal(200)
    averaged, switched = (open_loop(*plant(fidelity=f, devices=IDEAL), m)[0] for f in ("averaged", "switched"))
    assert np.abs(averaged).max() > 500
    assert np.abs(averaged - switched).max() < 1e-3 * 1255
