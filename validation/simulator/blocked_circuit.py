"""The blocked bridge as an ngspice circuit of six diodes: currents that end, and a bridge that rectifies."""

import cmath
import math
import subprocess
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import in_python
from pvlvrt_compliance.plant.diode_bridge import blocked_flow
from pvlvrt_compliance.plant.line import LineParams, design
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import plant_step_s
from pvlvrt_compliance.vectors import phases_of, vector_of
from validation.simulator.circuit import CURRENT_LIMIT_PERCENT, VOLTAGE_LIMIT_PERCENT, Compared, at
from validation.simulator.evidence import Plot, Row, Section, at_most
from validation.simulator.records import NOMINAL

_STEP_S = 1e-6
_W = 2 * math.pi * 50


class Blocked(NamedTuple):
    """A bridge that is blocked at t = 0, at a stiff sinusoidal source; nothing feeds the link but ``i_pv``."""

    i: complex  # current at the beginning (A)
    v_dc: float  # DC-link voltage at the beginning (V)
    i_pv: float  # current into the link (A)
    depth: tuple[float, float, float]  # residual voltage of each phase (pu)
    end_s: float
    C: float = 65e-3  # DC-link capacitance (F)
    R: float = 1e-3  # of the filter (ohm)


CASES = {
    "nominal current, 834 V": Blocked(1255 * cmath.exp(-0.4j), 834.0, 600.0, (1, 1, 1), 0.002),
    "1.4 pu at a sag of phase c to 0.1 pu": Blocked(1757 * cmath.exp(2.2j), 976.0, 600.0, (1, 1, 0.1), 0.002),
    "rectifies into 400 V, 300 A taken from it": Blocked(0j, 400.0, -300.0, (1, 1, 1), 0.04, 20e-3, 20e-3),
    "rectifies an unbalanced voltage": Blocked(0j, 420.0, -100.0, (1, 1, 0.5), 0.04, 20e-3, 20e-3),
}
"""By what happens."""


def phase_voltages(x: Blocked, t: float) -> tuple[float, float, float]:
    """Phase voltages of the source at an instant (V)."""
    peak = NOMINAL.phase_voltage_peak_v
    a, b, c = (r * peak * math.cos(_W * t - k * 2 * math.pi / 3) for k, r in enumerate(x.depth))
    return a, b, c


def ours(x: Blocked, t_step: float) -> NDArray[np.float64]:
    """Phase currents (A) and DC voltage (V) at the plant steps, shape (4, n)."""
    plant = Parameters().plant
    line: LineParams = design(plant.filter_inductance_h, x.R, 0.0, 0.0, t_step)
    step, phases, to_vector = in_python(blocked_flow), in_python(phases_of), in_python(vector_of)
    i, v = x.i, x.v_dc
    found = []
    for n in range(round(x.end_s / t_step)):
        found.append((*phases(i), v))
        e = to_vector(type(phases(i))(*phase_voltages(x, (n + 0.5) * t_step)))
        flow = step(i, v, x.i_pv, e, line, x.C, t_step, 0.0)
        i, v = flow.i, flow.v_dc
    return np.array(found, dtype=np.float64).T


def netlist(x: Blocked, output: Path) -> str:
    """Circuit: sources, filters, six diodes and the link."""
    L = Parameters().plant.filter_inductance_h
    start = in_python(phases_of)(x.i)
    lines = ["* blocked bridge", ".model steep D(IS=1e-9 N=0.05 RS=1e-5)"]
    for k, (phase, residual, i) in enumerate(zip("abc", x.depth, start, strict=True)):
        peak = residual * NOMINAL.phase_voltage_peak_v
        lines += [
            f"Be{phase} e{phase} n V = {peak:.15g}*cos({_W:.15g}*time-{k * 2 * math.pi / 3:.15g})",
            f"R{phase} r{phase} e{phase} {x.R:.12g}",
            f"L{phase} l{phase} r{phase} {L:.12g} IC={i:.12g}",
            f"Vi{phase} u{phase} l{phase} DC 0",
            f"Du{phase} u{phase} dc steep",
            f"Dl{phase} 0 u{phase} steep",
            f"Cs{phase} u{phase} s{phase} 2e-8",
            f"Rs{phase} s{phase} 0 50",  # a diode that ends a current leaves an inductor none to go
        ]
    lines += [
        "Rn n 0 1e7",
        f"Clink dc 0 {x.C:.12g} IC={x.v_dc:.12g}",
        f"Ipv 0 dc DC {x.i_pv:.12g}",
        f".tran {_STEP_S:g} {x.end_s:.12g} 0 {_STEP_S:g} UIC",
        ".options reltol=1e-5 abstol=1e-6 vntol=1e-6 method=gear temp=25",
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


def theirs(x: Blocked) -> NDArray[np.float64]:
    """Time (s), phase currents (A) and DC voltage (V) of ngspice, shape (5, n).

    Raises
    ------
    RuntimeError
        When ngspice does not finish, with its last words.
    """
    with tempfile.TemporaryDirectory() as folder:
        circuit, output = Path(folder) / "blocked.cir", Path(folder) / "blocked.data"
        circuit.write_text(netlist(x, output), encoding="utf-8")
        run = subprocess.run(["ngspice", "-b", str(circuit)], capture_output=True, text=True, check=False)
        if not output.exists():
            raise RuntimeError(f"ngspice gave no result: {(run.stdout + run.stderr)[-500:]}")
        return np.loadtxt(output, skiprows=1).T


def compare(x: Blocked) -> Compared:
    """Both programs from the same beginning, at the plant steps."""
    t_step = plant_step_s(Parameters())
    mine = ours(x, t_step)
    t = t_step * np.arange(mine.shape[1], dtype=np.float64)
    solution = theirs(x)
    return Compared(t, mine, at(t, solution))


def rows(compared: dict[str, Compared]) -> tuple[Row, ...]:
    """Differences by case."""
    found = []
    for name, c in compared.items():
        found.append(at_most(f"currents, {name}, rms", c.current_percent, CURRENT_LIMIT_PERCENT, "% of nominal", 0.01))
        found.append(at_most(f"DC voltage, {name}, largest", c.voltage_percent, VOLTAGE_LIMIT_PERCENT, "%", 0.001))
    return tuple(found)


def drawing(name: str, c: Compared) -> Plot:
    """Currents of both programs."""

    def draw(figure: Any) -> None:
        axes = figure.subplots()
        for k, phase in enumerate("abc"):
            axes.plot(1e3 * c.t, c.ours[k], linewidth=1, label=f"i_{phase}")
            axes.plot(1e3 * c.t[::60], c.theirs[k][::60], "k.", markersize=3)
        axes.set(xlabel="time (ms)", ylabel="current (A)")
        axes.legend(fontsize="x-small", loc="upper right")

    return Plot("ngspice-blocked", f"The bridge {name}: lines are the simulator's, points are ngspice's.", draw)


def section() -> Section:
    """Section on ngspice's diodes."""
    compared = {name: compare(x) for name, x in CASES.items()}
    name = "rectifies into 400 V, 300 A taken from it"
    return Section("Blocked bridge against ngspice", _TEXT, rows(compared), (drawing(name, compared[name]),))


_TEXT = """Six steep diodes, with a small snubber in every leg (20 nF, 50 ohm: a diode that ends abruptly leaves the
last milliampere of an inductor nowhere to go), between filter and link at a stiff source, from the instant of blocking
on. Currents end against v_DC, each by itself; where a line-to-line voltage exceeds v_DC the bridge rectifies, with gaps
and without, from three phases and from two."""
