"""Table and figure of the page on fidelity: averaged and switched inverter in every golden case."""

from collections.abc import Iterator
from functools import cache
from typing import Any

import numba
import numpy as np

from pvlvrt_compliance.measure.quantities import MeasuredWindows
from pvlvrt_compliance.measure.summary import measure
from pvlvrt_compliance.measure.windows import standard_windows
from pvlvrt_compliance.plant.carrier import pulses_of
from pvlvrt_compliance.plant.inverter import limit_modulation
from pvlvrt_compliance.plant.line import design
from pvlvrt_compliance.plant.switched_bridge import switched_flow
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters, parameters_from
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.simulation.translate import nominal_of, plant_params
from pvlvrt_compliance.space_vectors import SQRT2_3, clarke
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms import Segment
from validation.places import DOCS, golden_cases

PAGE, FIGURE = DOCS / "fidelity.md", DOCS / "fidelity" / "currents.png"
BEGIN, END = "<!-- table -->\n", "<!-- end of table -->\n"

SWITCHED = ("simulation.fidelity=switched",)
IDEAL = (
    *SWITCHED,
    *("plant.dead_time_us=0", "plant.device_drop_v=0", "plant.device_resistance_ohm=0", "plant.switching_energy_mj=0"),
)
FINE = 128  # instants in a carrier period at which the figure shows the ripple


@cache
def run(scenario: Scenario, settings: tuple[str, ...]) -> tuple[Segment, MeasuredWindows]:
    """Record of a run, and its measurements."""
    parameters = parameters_from(settings)
    waveforms = simulate(scenario, parameters)
    nominal = nominal_of(parameters, scenario)
    return waveforms.segments[0], measure(waveforms, nominal, scenario.start_s, scenario.clear_s)


def rms(x: Any) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(np.square(x))))


def differences(a: Segment, b: Segment) -> tuple[float, float]:
    """Differences of two windows, rms: of the worst phase's current and of v_DC (percent of 1 pu and of 1000 V)."""
    peak = Nominal().phase_current_peak_a
    current = max(rms(x - y) for x, y in zip(a.three_phase("i"), b.three_phase("i"), strict=True))
    return 100 * current / peak, 100 * rms(a["v_dc_v"] - b["v_dc_v"]) / 1000


def rows() -> Iterator[str]:
    """Lines of the table, one for each golden case."""
    yield "| case | ideal: i | v_DC | real: i | v_DC | THD averaged | THD real |\n"
    yield 7 * "|---" + "|\n"
    for case in golden_cases():
        yield f"| {case.folder.name} | {' | '.join(cells(case.scenario, case.settings))} |\n"


def cells(scenario: Scenario, own: tuple[str, ...]) -> list[str]:
    """Differences of ideal and real switching from the average, worst of the windows; distortions of the current."""
    (averaged, before), (_, after) = run(scenario, own), run(scenario, (*own, *SWITCHED))
    texts = []
    for settings in (IDEAL, SWITCHED):
        other = run(scenario, (*own, *settings))[0]
        windows = standard_windows(scenario.start_s, scenario.clear_s, averaged.end_s, scenario.frequency_hz)
        spans = [window for window in windows if window is not None]
        found = [differences(averaged.slice(*span), other.slice(*span)) for span in spans]
        texts += [f"{max(column):.2f} %" for column in zip(*found, strict=True)]
    thd = [m.during.current_thd_percent for m in (before, after) if m.during is not None]
    return texts + [f"{x:.1f} %" for x in thd if x is not None]


@numba.njit(error_model="numpy")
def _ripple(x: Any, m: Any, e: Any, turn: Any, line: Any, T: Any, C: Any, devices: Any, fine: Any, i: Any) -> None:
    for n in range(len(x)):
        pulses = pulses_of(limit_modulation(m[n]), T)
        current, v_dc = x[n]
        for k in range(fine):
            i[n * fine + k] = current.real
            source = e[n] * turn ** (k + 0.5)
            found = switched_flow(current + 0j, v_dc.real, 0.0, source, k, pulses, line, C, T / fine, devices)
            current, v_dc = found.i, found.v_dc + 0j


def ripple(scenario: Scenario, parameters: Parameters, samples: Segment) -> tuple[Any, Any]:
    """Time (s) and current of phase a (A) between the samples, each period from its own sample on."""
    p = plant_params(parameters, scenario)
    T = samples.dt_s
    line = design(
        parameters.plant.filter_inductance_h,
        parameters.plant.filter_resistance_ohm + parameters.plant.device_resistance_ohm,
        0.0,
        0.0,
        T / FINE,
    )
    m = samples["m_alpha"][:-1] + 1j * samples["m_beta"][:-1]
    states = np.stack([clarke(*samples.three_phase("i")), samples["v_dc_v"].astype(complex)], axis=1)[1:]
    e = clarke(*samples.three_phase("u0"))[1:]
    i = np.empty(len(m) * FINE)
    turn = np.exp(2j * np.pi * scenario.frequency_hz * T / FINE)
    _ripple(states, m, e, turn, line, T, p.C, p.devices, FINE, i)
    return samples.t0_s + T + T / FINE * np.arange(len(i)), SQRT2_3 * i


def draw() -> None:
    """Draw ripple, and what dead time and losses change."""
    import matplotlib as mpl

    mpl.use("agg")
    import matplotlib.pyplot as plt

    scenario = Scenario(sag=Sag(depth=0.9, phases="c"), duration_s=1.262)
    averaged, ideal, real = (run(scenario, settings)[0] for settings in ((), IDEAL, SWITCHED))
    figure, (top, middle, bottom) = plt.subplots(3, 1, figsize=(8, 9), layout="constrained")
    near = real.slice(0.2585, 0.2605)
    t, i = ripple(scenario, parameters_from(SWITCHED), near)
    top.plot(1e3 * t, i, lw=0.6, label="switched")
    top.plot(1e3 * near.t_s, near["i_a_a"], "o", ms=2.5, label="its samples")
    shown = averaged.slice(0.2585, 0.2605)
    top.plot(1e3 * shown.t_s, shown["i_a_a"], "k--", lw=0.9, label="averaged")
    top.set(title="Normal operation, phase a", ylabel="current (A)")
    a, b, c = (x.slice(0.8, 0.84) for x in (averaged, ideal, real))
    for phase in "abc":
        middle.plot(1e3 * a.t_s, a[f"i_{phase}_a"], "k--", lw=0.7, label="averaged" if phase == "a" else None)
        middle.plot(1e3 * a.t_s, c[f"i_{phase}_a"], lw=0.9, label=f"switched, phase {phase}")
        bottom.plot(1e3 * a.t_s, c[f"i_{phase}_a"] - a[f"i_{phase}_a"], lw=0.9, label=f"phase {phase}")
    bottom.plot(1e3 * a.t_s, b["i_c_a"] - a["i_c_a"], "k", lw=0.9, label="phase c, ideal switching")
    middle.set(title="Phase c 90 %: samples with dead time, drops and losses", ylabel="current (A)")
    bottom.set(title="The same: switched less averaged", ylabel="current (A)", xlabel="time (ms)")
    for axes in (top, middle, bottom):
        axes.grid(alpha=0.3)
        axes.legend(fontsize=7, ncols=4, loc="upper right")
    figure.savefig(FIGURE, dpi=110, metadata={"Software": None})


def page() -> str:
    """Text of the page with its table made anew."""
    head, _, rest = PAGE.read_text("utf-8").partition(BEGIN)
    _, _, tail = rest.partition(END)
    return head + BEGIN + "".join(rows()) + END + tail
