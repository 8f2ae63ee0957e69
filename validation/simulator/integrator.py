"""The averaged plant in closed loop by scipy's integrator, the discrete controller held between its samples."""

import math
from typing import Any, NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.special import lambertw

from pvlvrt_compliance.control.controller import ControllerState, controller_step
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.plant.pv_array import PvParams
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import (
    control_period_s,
    controller_params,
    plant_params,
    plant_tables,
    pv_params,
    steady_state,
)
from pvlvrt_compliance.waveforms import Segment
from validation.simulator.evidence import Plot, Row, Section, at_most
from validation.simulator.records import NOMINAL, record, rms, vector, without_trips

LIMIT_PERCENT = 0.2
WINDOW_S = 0.06

CASES = {
    "three-phase 90 %": Scenario(sag=Sag(depth=0.9), duration_s=0.309),
    "phase c 90 %": Scenario(sag=Sag(depth=0.9, phases="c"), duration_s=0.309),
    "phase c 50 %": Scenario(sag=Sag(depth=0.5, phases="c"), duration_s=0.944),
}


class Compared(NamedTuple):
    """Current vector (A) and DC voltage (V) of both programs at the control samples, shape (n,)."""

    t: NDArray[np.float64]  # (s)
    i_ours: NDArray[np.complex128]
    i_theirs: NDArray[np.complex128]
    v_ours: NDArray[np.float64]
    v_theirs: NDArray[np.float64]

    @property
    def current_percent(self) -> float:
        """Difference of the currents, rms (percent of nominal)."""
        return 100 * rms(self.i_ours - self.i_theirs) / NOMINAL.current_ab_a

    @property
    def voltage_percent(self) -> float:
        """Difference of the DC voltages, rms (percent of 1000 V)."""
        return 100 * rms(self.v_ours - self.v_theirs) / 1e3


class Plant(NamedTuple):
    """Continuous plant, written anew from its equations."""

    L: float
    R: float
    C: float
    pv: PvParams
    G: float  # (1000 W/m2)
    scenario: Scenario

    def array_current(self, v: float) -> float:
        """Current of the array (A) at a voltage (V), in closed form."""
        p = self.pv
        G_sh, x = p.G_sh * self.G, v / p.n_series
        a = p.a * (1 + p.R_s * G_sh)
        source = p.I_L * self.G + p.I_0
        w = float(lambertw(p.R_s * p.I_0 / a * math.exp((p.R_s * source + x) / a)).real)
        return p.n_parallel * ((source - x * G_sh) / (1 + p.R_s * G_sh) - p.a / p.R_s * w)

    def source(self, t: float, sagged: bool) -> complex:
        """Voltage vector of the grid (V)."""
        scenario = self.scenario
        positive, negative, _ = scenario.sag.sequences_pu() if sagged else (1.0 + 0j, 0j, 0j)
        angle = math.radians(scenario.point_on_wave_deg) + 2 * math.pi * scenario.frequency_hz * (t - scenario.start_s)
        turn = complex(math.cos(angle), math.sin(angle))
        return NOMINAL.voltage_ab_v * (positive * turn + (negative * turn).conjugate())

    def slope(self, t: float, x: NDArray[np.float64], m: complex, sagged: bool) -> list[float]:
        """Time derivative of the current (A/s) and of the DC voltage (V/s)."""
        i, v = complex(x[0], x[1]), float(x[2])
        di = (2 / 3 * v * m - self.source(t, sagged) - self.R * i) / self.L
        dv = (self.array_current(v) - 2 / 3 * (m * i.conjugate()).real) / self.C
        return [di.real, di.imag, dv]

    def is_sagged(self, t: float) -> bool:
        """Whether the sag is on at an instant (s)."""
        return self.scenario.start_s <= t < self.scenario.clear_s

    def after(self, x: NDArray[np.float64], t: float, end: float, m: complex) -> NDArray[np.float64]:
        """State at ``end`` (s) from the state at ``t`` under a constant modulating signal, past any event."""
        events = [e for e in (self.scenario.start_s, self.scenario.clear_s) if t < e < end]
        for a, b in zip([t, *events], [*events, end], strict=True):
            sagged = self.is_sagged(0.5 * (a + b))
            solved = solve_ivp(
                self.slope, (a, b), x, "DOP853", args=(m, sagged), rtol=1e-10, atol=1e-8, first_step=b - a
            )
            x = solved.y[:, -1]
        return x


@numba.njit(error_model="numpy")
def _control(x: Any, u: Any, i: Any, v: Any, i_pv: Any, p: Any, m: Any) -> Any:
    for n in range(len(u)):
        y = Measured(u_g_ab=u[n], i_ab=i[n], v_dc=v[n], i_pv=i_pv[n])
        x, signals = controller_step(x, y, p)
        m[n] = signals.m
    return x


def controlled(
    x: ControllerState, u: Any, i: Any, v: Any, i_pv: Any, p: Any
) -> tuple[ControllerState, NDArray[np.complex128]]:
    """Feed the discrete controller with samples, shape (n,); return its state after them and what it put out."""
    m = np.empty(len(u), complex)
    arrays = np.asarray(u, complex), np.asarray(i, complex), np.asarray(v, float), np.asarray(i_pv, float)
    return _control(x, *arrays, p, m), m


def whole_record(scenario: Scenario) -> tuple[Parameters, Scenario]:
    """Parameters and scenario whose record begins with the initial state: the settling is recorded too."""
    parameters = without_trips(simulation={"settling_s": 0.0})
    return parameters, scenario.model_copy(update={"before_s": 0.8})


def compare(scenario: Scenario, centre: str, **changed: Any) -> Compared:
    """Continue a run from 30 ms before the start or the end of its sag (``start`` or ``clear``) for 60 ms by scipy.

    The controller is brought to where it is at that sample by what it has measured until then. Fields of `Plant` that
    are ``changed`` make scipy's plant another one, to see that a difference shows.
    """
    parameters, scenario = whole_record(scenario)
    samples = record(scenario, parameters)
    plant = plant_params(parameters, scenario)
    control = controller_params(parameters, scenario)
    start = steady_state(plant, plant_tables(parameters, scenario).grid, control, scenario, 0.0)
    at = (scenario.start_s if centre == "start" else scenario.clear_s) - WINDOW_S / 2
    first = samples.index_at(at)
    before = samples.slice(samples.t0_s, samples.t_s[first] - 0.5 * samples.dt_s)
    measured = vector(before, "u"), vector(before, "i"), before["v_dc_v"], before["i_pv_a"]
    x, m = controlled(start.controller, *measured, control)
    model = Plant(
        L=parameters.plant.filter_inductance_h,
        R=parameters.plant.filter_resistance_ohm,
        C=parameters.plant.dc_link_capacitance_f,
        pv=pv_params(parameters, scenario),
        G=plant.G,
        scenario=scenario,
    )
    return _continued(model._replace(**changed), samples, first, x, complex(m[-1]), control)


def _continued(model: Plant, samples: Segment, first: int, x: ControllerState, m: complex, control: Any) -> Compared:
    T = control_period_s(Parameters())
    i_ours, v_ours = vector(samples, "i"), samples["v_dc_v"]
    n = range(first, first + round(WINDOW_S / T))
    y = np.array([i_ours[first].real, i_ours[first].imag, v_ours[first]])
    found = np.empty((len(n), 3))
    for row, k in enumerate(n):
        found[row] = y
        u = model.source(k * T, model.is_sagged(k * T))
        x, m_next = controlled(x, [u], [complex(y[0], y[1])], [y[2]], [model.array_current(y[2])], control)
        y = model.after(y, k * T, (k + 1) * T, m)
        m = complex(m_next[0])
    mine = slice(n.start, n.stop)
    return Compared(samples.t_s[mine], i_ours[mine], found[:, 0] + 1j * found[:, 1], v_ours[mine], found[:, 2])


def all_compared() -> dict[str, Compared]:
    """Every case and window, by name."""
    return {
        f"{name}, {words}": compare(scenario, centre)
        for name, scenario in CASES.items()
        for centre, words in (("start", "start"), ("clear", "end"))
    }


def rows(compared: dict[str, Compared]) -> tuple[Row, ...]:
    """Differences by case and window."""
    found = []
    for name, c in compared.items():
        found.append(
            at_most(f"current, {name} of the sag, rms", c.current_percent, LIMIT_PERCENT, "% of nominal", 0.001)
        )
        found.append(
            at_most(f"DC voltage, {name} of the sag, rms", c.voltage_percent, LIMIT_PERCENT, "% of 1000 V", 0.001)
        )
    return tuple(found)


def drawing(name: str, c: Compared) -> Plot:
    """Difference of the current vector over time."""

    def draw(figure: Any) -> None:
        axes = figure.subplots()
        axes.plot(1e3 * (c.t - c.t[0]), np.abs(c.i_ours - c.i_theirs), linewidth=1)
        axes.set(xlabel="time (ms)", ylabel="difference of the current vector (A)")

    return Plot("integrator", f"{name} of the sag; nominal is 1255 A.", draw)


def section() -> Section:
    """Section on scipy's integrator."""
    compared = all_compared()
    name = "three-phase 90 %, start"
    return Section(
        "Plant against scipy's integrator, in closed loop", _TEXT, rows(compared), (drawing(name, compared[name]),)
    )


_TEXT = """The continuous equations of the plant, written anew with the closed form of the array (Lambert's W) and
integrated by `solve_ivp` (DOP853, relative tolerance 1e-10) from sample to sample of the discrete controller, which
holds its output between them, and exactly to the start and the end of the sag. The controller is the same on both
sides, in closed loop: it sees what either plant has made. 60 ms around the start and around the end of three sags
of the paper. The difference is a jump at the event, which the simulator places on its nearest step of 5 us, and is
gone within milliseconds."""
