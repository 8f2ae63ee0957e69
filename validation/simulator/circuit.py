"""The averaged plant as an ngspice circuit in three phases, driven by a recorded modulating signal through a sag."""

import math
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.plant.pv_array import PvParams
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import plant_step_s, pv_params
from pvlvrt_compliance.waveforms import Segment
from validation.simulator.evidence import Plot, Row, Section, at_most
from validation.simulator.records import NOMINAL, in_parallel, record, rms, without_trips

CURRENT_LIMIT_PERCENT = 0.5
VOLTAGE_LIMIT_PERCENT = 0.1
BEFORE_S, AFTER_S = 0.01, 0.02
_EDGE_S = 1e-9
_STEP_S = 10e-6
_THERMAL_V = 1.38064852e-23 * 298.15 / 1.6021766208e-19
"""k T / q at 25 degrees C with the constants of ngspice (V)."""

SAGS = {
    "three-phase 90 %": Sag(depth=0.9),
    "phase c 90 %": Sag(depth=0.9, phases="c"),
    "phase c 50 %": Sag(depth=0.5, phases="c"),
}


class Compared(NamedTuple):
    """The same quantities from both programs at the same instants."""

    t: NDArray[np.float64]  # (s)
    ours: NDArray[np.float64]  # phase currents (A) and DC voltage (V), shape (4, n)
    theirs: NDArray[np.float64]  # the same from ngspice, shape (4, n)

    @property
    def current_percent(self) -> float:
        """Difference of the phase currents, rms over phases and time (percent of the nominal rms current)."""
        return 100 * rms(self.ours[:3] - self.theirs[:3]) / (NOMINAL.phase_current_peak_a / math.sqrt(2))

    @property
    def voltage_percent(self) -> float:
        """Largest difference of the DC voltage (percent of it)."""
        return float(100 * np.abs(self.theirs[3] / self.ours[3] - 1).max())


def installed() -> bool:
    """Whether there is an ngspice to compare with."""
    return shutil.which("ngspice") is not None


def scenario_of(sag: Sag, steps: int = 5866) -> Scenario:
    """Sag at full sun on a stiff grid that begins and ends on plant steps, of 30 ms also within control periods.

    Between steps the simulator would move an event by up to half of one, which the open loop never forgets.
    """
    step = plant_step_s(Parameters())
    return Scenario(sag=sag, before_s=50003 * step, duration_s=steps * step, after_s=0.1, point_on_wave_deg=30.0)


def pwl(name: str, node: str, t: NDArray[np.float64], x: NDArray[np.float64]) -> Iterator[str]:
    """Voltage source that holds ``x[k]`` (V) from ``t[k]`` (s) on."""
    yield f"V{name} {node} 0 PWL("
    yield f"+ {0.0:.12g} {x[0]:.12g}"
    for at, old, new in zip(t[1:], x[:-1], x[1:], strict=True):
        yield f"+ {at:.12g} {old:.12g} {at + _EDGE_S:.12g} {new:.12g}"
    yield "+ )"


def phase_values(samples: Segment, name: str) -> NDArray[np.float64]:
    """Three phases of a recorded vector ``<name>_alpha``, ``<name>_beta``, shape (3, n)."""
    alpha, beta = samples[f"{name}_alpha"], samples[f"{name}_beta"]
    k = math.sqrt(2 / 3)
    return np.array([k * alpha] + [k * (-0.5 * alpha + s * math.sqrt(3) / 2 * beta) for s in (1, -1)])


def array_elements(pv: PvParams, G: float) -> Iterator[str]:
    """Single-diode array at the node ``dc``: photocurrent, diode, shunt and series resistance."""
    n_s, n_p = pv.n_series, pv.n_parallel
    yield f"Iphoto 0 x DC {pv.I_L * G * n_p:.15g}"
    yield "Ddiode x 0 array"
    yield f".model array D(IS={pv.I_0 * n_p:.15g} N={pv.a * n_s / _THERMAL_V:.15g} TNOM=25)"
    yield f"Rshunt x 0 {n_s / (n_p * pv.G_sh * G):.15g}"
    yield f"Rseries x dc {pv.R_s * n_s / n_p:.15g}"


class Drive(NamedTuple):
    """What drives the three legs, in each u_x = gain v_DC m_x against a floating point; i_DC = gain sum of m_x i_x."""

    gain: str
    sources: Callable[[Segment], Iterator[str]]  # voltage sources (V) at the nodes ma, mb and mc, from samples


def averaged_sources(samples: Segment) -> Iterator[str]:
    """Modulating signals, held per control period.

    What the controller computes at a sample acts in the period after the next, so the signals begin one sample late.
    """
    t = samples.t_s[1:] - samples.t_s[1]
    for x, m in zip("abc", phase_values(samples, "m"), strict=True):
        yield from pwl(f"m{x}", f"m{x}", t, m[:-1])


AVERAGED = Drive("2/3", averaged_sources)


def inverter_elements(L: float, R: float, start: dict[str, float], gain: str) -> Iterator[str]:
    """Bridge and filter in three phases."""
    for x in "abc":
        yield f"Bu{x} u{x} star V = {gain}*V(dc)*V(m{x})"
        yield f"Vi{x} u{x} l{x} DC 0"
        yield f"L{x} l{x} r{x} {L:.12g} IC={start[x]:.12g}"
        yield f"R{x} r{x} e{x} {R:.12g}"
    yield f"Bdc dc 0 I = {gain}*(V(ma)*I(Via)+V(mb)*I(Vib)+V(mc)*I(Vic))"
    yield "Rstar star 0 1e9"


def grid_elements(scenario: Scenario, t0: float, end: float) -> Iterator[str]:
    """Three phase-to-neutral sources, zero sequence included, that change at the start and the end of the sag."""
    w, peak = 2 * math.pi * scenario.frequency_hz, NOMINAL.phase_voltage_peak_v
    events = np.array([0.0, scenario.start_s - t0, scenario.clear_s - t0])
    yield from pwl("sag", "sag", events, np.array([0.0, 1.0, 0.0]))
    healthy = Sag(depth=0).phasors_pu()
    for x, before, during in zip("abc", healthy, scenario.sag.phasors_pu(), strict=True):
        parts = []
        for share, phasor in (("(1-V(sag))", before), ("V(sag)", during)):
            angle = math.radians(scenario.point_on_wave_deg) + float(np.angle(phasor)) - w * events[1]
            parts.append(f"{share}*{peak * abs(phasor):.15g}*cos({w:.15g}*time+({angle:.15g}))")
        yield f"Be{x} e{x} 0 V = {' + '.join(parts)}"
    yield f".tran {_STEP_S:g} {end:.12g} 0 {_STEP_S:g} UIC"


def netlist(scenario: Scenario, parameters: Parameters, samples: Segment, output: Path, drive: Drive) -> str:
    """Circuit from the second of ``samples`` on, with what the plant was there as initial conditions."""
    plant = parameters.plant
    start = {x: float(samples[f"i_{x}_a"][1]) for x in "abc"}
    lines = ["* plant"]
    lines += array_elements(pv_params(parameters, scenario), scenario.irradiance_w_m2 / 1000)
    lines.append(f"Clink dc 0 {plant.dc_link_capacitance_f:.12g} IC={samples['v_dc_v'][1]:.12g}")
    lines += inverter_elements(plant.filter_inductance_h, plant.filter_resistance_ohm, start, drive.gain)
    lines += drive.sources(samples)
    lines += grid_elements(scenario, float(samples.t_s[1]), float(samples.t_s[-1] - samples.t_s[1]))
    lines += [
        ".options reltol=1e-6 abstol=1e-9 vntol=1e-9 chgtol=1e-16 temp=25 method=gear",
        ".control",
        "set wr_singlescale",
        "set wr_vecnames",
        "run",
        f"wrdata {output.as_posix()} i(Via) i(Vib) i(Vic) v(dc)",
        "quit",
        ".endc",
        ".end",
    ]
    return "\n".join(lines) + "\n"


def solved(
    scenario: Scenario, parameters: Parameters, samples: Segment, drive: Drive = AVERAGED
) -> NDArray[np.float64]:
    """Time (s), phase currents (A) and DC voltage (V) of ngspice, shape (5, n).

    Raises
    ------
    RuntimeError
        When ngspice does not finish, with its last words.
    """
    with tempfile.TemporaryDirectory() as folder:
        circuit, output = Path(folder) / "plant.cir", Path(folder) / "plant.data"
        circuit.write_text(netlist(scenario, parameters, samples, output, drive), encoding="utf-8")
        run = subprocess.run(["ngspice", "-b", str(circuit)], capture_output=True, text=True, check=False)
        if not output.exists():
            raise RuntimeError(f"ngspice gave no result: {(run.stdout + run.stderr)[-500:]}")
        return np.loadtxt(output, skiprows=1).T


def compare(sag: Sag, circuit_parameters: Parameters | None = None) -> Compared:
    """Run both programs through a sag, from 10 ms before it to 20 ms after it.

    Other parameters for the circuit make it another one, to see that a difference shows.
    """
    parameters, scenario = without_trips(), scenario_of(sag)
    samples = record(scenario, parameters).slice(scenario.start_s - BEFORE_S, scenario.clear_s + AFTER_S)
    theirs = solved(scenario, circuit_parameters or parameters, samples)
    return aligned(scenario, samples, theirs)


def aligned(scenario: Scenario, samples: Segment, theirs: NDArray[np.float64]) -> Compared:
    """Record and ngspice's solution at the controller's samples."""
    t = samples.t_s[1:] - samples.t_s[1]
    ours = np.array([samples[name][1:] for name in ("i_a_a", "i_b_a", "i_c_a", "v_dc_v")])
    return Compared(t=t - (scenario.start_s - samples.t_s[1]), ours=ours, theirs=at(t, theirs))


def at(t: NDArray[np.float64], solution: NDArray[np.float64]) -> NDArray[np.float64]:
    """Ngspice's solution at instants (s)."""
    return np.array([np.interp(t, solution[0], x) for x in solution[1:]])


def rows(compared: dict[str, Compared]) -> tuple[Row, ...]:
    """Differences by sag."""
    found = []
    for name, c in compared.items():
        found.append(at_most(f"currents, {name}, rms", c.current_percent, CURRENT_LIMIT_PERCENT, "% of nominal", 0.01))
        found.append(at_most(f"DC voltage, {name}, largest", c.voltage_percent, VOLTAGE_LIMIT_PERCENT, "%", 0.001))
    return tuple(found)


def drawing(name: str, c: Compared) -> Plot:
    """Currents and DC voltage of both programs."""

    def draw(figure: Any) -> None:
        currents, voltage = figure.subplots(1, 2)
        for k, phase in enumerate("abc"):
            currents.plot(1e3 * c.t, c.ours[k], linewidth=1, label=f"i_{phase}")
            currents.plot(1e3 * c.t[::60], c.theirs[k][::60], "k.", markersize=3)
        voltage.plot(1e3 * c.t, c.ours[3], linewidth=1)
        voltage.plot(1e3 * c.t[::60], c.theirs[3][::60], "k.", markersize=3)
        currents.set(xlabel="time (ms)", ylabel="current (A)")
        voltage.set(xlabel="time (ms)", ylabel="DC voltage (V)")
        currents.legend(fontsize="x-small", loc="upper right")

    return Plot("ngspice", f"{name}: lines are the simulator's, points are ngspice's.", draw)


def section() -> Section:
    """Section on ngspice."""
    compared = dict(zip(SAGS, in_parallel(compare, SAGS.values()), strict=True))
    name = "phase c 90 %"
    return Section("Plant against ngspice", _TEXT, rows(compared), (drawing(name, compared[name]),))


_TEXT = """A circuit of the averaged plant in three phases: a diode with the array's parameters, photocurrent, shunt
and series resistance; the link; an inverter of controlled sources (u_x = 2/3 v_DC m_x, i_DC = 2/3 sum of m_x i_x)
with a floating star point; filter; and three phase-to-neutral sources that sag, zero sequence included. The
modulating signals are those that the controller put out in a simulated run, held per control period: the circuit is
in open loop, so that an error is not controlled away. From 10 ms before a sag of 30 ms to 20 ms after it. The sag
begins and ends within control periods, on plant steps: between them the simulator would move an event by up to half
a step (2.6 us), a current of 6 A that an open loop keeps."""
