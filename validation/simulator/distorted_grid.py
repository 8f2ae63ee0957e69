"""The synchronisations in the whole simulation, on a grid with harmonics, beside their transfer functions."""

import math
from pathlib import Path
from typing import Any, NamedTuple, get_args

import numpy as np

from pvlvrt_compliance.control.parameters import SynchronisationName
from pvlvrt_compliance.measure.fourier import turning, whole_cycles
from pvlvrt_compliance.measure.harmonics import thd_percent
from pvlvrt_compliance.scenario.files import load_events
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.waveforms import Segment
from validation.simulator.evidence import Plot, Row, Section, at_most, shown
from validation.simulator.findings import Finding, samples_of, settled, shell
from validation.simulator.records import NOMINAL, vector
from validation.simulator.sequence_filters import Harmonics, frequency_ripple_hz, positive_ripple, reference_thd_percent

NAMES: tuple[str, ...] = get_args(SynchronisationName)
ANTIPHASE, IN_PHASE = "harmonics.toml", "harmonics-in-phase.toml"
"""Files of events beside this one."""
WEAK_SCR = 20.0
GRIDS = (None, WEAK_SCR)
"""Short-circuit ratios; none: stiff."""
FREQUENCY_HZ = 50.0
_HERE = Path(__file__).resolve().parent
_HIGHEST = 40


def on_distorted_grid(name: str, scr: float | None, file: str = ANTIPHASE) -> Finding:
    """Command on a grid with the harmonics of a file beside this one, and no sag."""
    scenario = Scenario(sag=Sag(depth=0), duration_s=0.3, scr=scr, events=load_events(str(_HERE / file)))
    options = ("--sag", "0%", "--duration", "300ms", "--events", f"validation/simulator/{file}")
    strength = () if scr is None else ("--scr", f"{scr:g}")
    return Finding(scenario, (*options, *strength), "pass", (f"controller.synchronisation={name}",))


class Distortion(NamedTuple):
    """What harmonics do to the control."""

    frequency_hz: float  # ripple of the estimate, half peak-to-peak (Hz)
    v_fault_pu: float  # ripple of V_fault, half peak-to-peak (pu)
    thd_percent: float  # of the current, worst phase
    error_percent: float  # largest |i - i*|, of nominal; 0: not predicted


def measured(finding: Finding) -> Distortion:
    """Ripples and distortion in a record."""
    part = settled(finding)
    i_ref = part["i_ref_alpha_a"] + 1j * part["i_ref_beta_a"]
    nominal = math.sqrt(1.5) * NOMINAL.phase_current_peak_a
    return Distortion(
        frequency_hz=float(np.ptp(part["frequency_estimate_hz"])) / 2,
        v_fault_pu=float(np.ptp(part["v_fault_pu"])) / 2,
        thd_percent=max(thd_percent(x, part.dt_s, FREQUENCY_HZ) or 0.0 for x in part.three_phase("i")),
        error_percent=100 * float(np.abs(vector(part, "i") - i_ref).max()) / nominal,
    )


def harmonics_of(part: Segment) -> tuple[complex, Harmonics]:
    """Fundamental (V) of the voltage at the PCC, and its harmonics as parts of it."""
    u = vector(part, "u")
    cycles = whole_cycles(len(u), part.dt_s, FREQUENCY_HZ)
    weighted = cycles.weights * u[: cycles.samples]
    orders = [h for h in range(-_HIGHEST, _HIGHEST + 1) if abs(h) > 1]
    turned = turning(cycles.samples, part.dt_s, FREQUENCY_HZ)
    fundamental = complex(weighted @ turned)
    return fundamental, {h: complex(weighted @ turned**h) / fundamental for h in orders}


def predicted(name: str, finding: Finding) -> Distortion:
    """The same by the transfer functions in open loop, of the voltage that the record has at the PCC."""
    fundamental, harmonics = harmonics_of(settled(finding))
    return Distortion(
        frequency_hz=frequency_ripple_hz(name, harmonics, 2 * math.pi * FREQUENCY_HZ),
        v_fault_pu=positive_ripple(name, harmonics) * abs(fundamental) / NOMINAL.voltage_ab_v,
        thd_percent=reference_thd_percent(name, harmonics),
        error_percent=0.0,
    )


def frequency_row(name: str, finding: Finding) -> Row:
    """Ripple of the estimated frequency; the prediction is of first order, and 2 mHz are for the MPPT's steps."""
    expected = round(predicted(name, finding).frequency_hz, 4)
    title = f"frequency ripple, {name}, {_where(finding.scenario.scr)}"
    return Row(title, measured(finding).frequency_hz, expected, 0.05 * expected + 0.002, "Hz", 1e-3)


def distortion_row(name: str, finding: Finding) -> Row:
    """THD of the current; half of what the square of a harmonic of 10 % is (1 %) may be missed."""
    expected = round(predicted(name, finding).thd_percent, 3)
    return Row(
        f"current THD, {name}, {_where(finding.scenario.scr)}", measured(finding).thd_percent, expected, 0.5, "%"
    )


def voltage_row(name: str) -> Row:
    """Ripple of V_fault with the harmonics in phase, on a stiff grid, where it is largest."""
    finding = on_distorted_grid(name, None, IN_PHASE)
    expected = round(predicted(name, finding).v_fault_pu, 4)
    title = f"V_fault ripple, {name}, stiff, in phase"
    return Row(title, measured(finding).v_fault_pu, expected, 0.005, "pu", 1e-4)


def _where(scr: float | None) -> str:
    return "stiff" if scr is None else f"SCR {scr:g}"


def share_of_ripple(scr: float | None, file: str = ANTIPHASE) -> float:
    """Ripple of the frequency with the MSOGI-FLL as a part of that with the DSOGI-FLL."""
    msogi, dsogi = (measured(on_distorted_grid(name, scr, file)).frequency_hz for name in ("msogi-fll", "dsogi-fll"))
    return msogi / dsogi


def flagged_percent(finding: Finding) -> float:
    """Part of the time in which a fault is flagged."""
    return 100 * float(settled(finding)["fault_signal"].mean())


def rows() -> tuple[Row, ...]:
    """Ripples and distortion of all synchronisations."""
    antiphase = [(name, on_distorted_grid(name, scr)) for scr in GRIDS for name in NAMES]
    unwanted = on_distorted_grid("srf-pll", None, IN_PHASE)
    return (
        *(frequency_row(name, finding) for name, finding in antiphase),
        *(at_most(f"msogi's ripple by dsogi's, {_where(scr)}", share_of_ripple(scr), 0.1, "", 1e-3) for scr in GRIDS),
        *(distortion_row(name, finding) for name, finding in antiphase),
        shown("largest current error of these", max(measured(finding).error_percent for _, finding in antiphase), "%"),
        *(voltage_row(name) for name in NAMES),
        shown("time with a fault flagged, srf-pll, stiff, in phase", flagged_percent(unwanted), "%"),
    )


def draw(figure: Any) -> None:
    """Estimated frequency with the harmonics in antiphase, V_fault with them in phase."""
    left, right = figure.subplots(1, 2)
    for name in NAMES:
        for axes, finding, channel in (
            (left, on_distorted_grid(name, WEAK_SCR), "frequency_estimate_hz"),
            (right, on_distorted_grid(name, None, IN_PHASE), "v_fault_pu"),
        ):
            start_s = finding.scenario.start_s + 0.1
            part = samples_of(finding).slice(start_s, start_s + 0.01)
            axes.plot(1e3 * (part.t_s - part.t0_s), part[channel], label=name, linewidth=1)
    left.set(xlabel="time (ms)", ylabel="frequency estimate (Hz)")
    right.set(xlabel="time (ms)", ylabel="V_fault (pu)")
    left.set_title("antiphase, SCR 20", fontsize="small")
    right.set_title("in phase, stiff", fontsize="small")
    right.axhline(0.85, color="k", linestyle="--", linewidth=0.8)
    left.legend(loc="lower right", fontsize="x-small")


def section() -> Section:
    """Section on grids with harmonics."""
    commands = shell(on_distorted_grid("dsogi-fll", WEAK_SCR)) + shell(on_distorted_grid("srf-pll", None, IN_PHASE))
    plot = Plot("distorted-grid", "No sag; 10 % of 5th and 7th harmonic. Dashed: the threshold of the detector.", draw)
    return Section("Synchronisations on a grid with harmonics, closed loop", _TEXT + commands, rows(), (plot,))


_TEXT = """The whole simulation without a sag, with 10 % of 5th and of 7th harmonic on the source, at the terminals
(stiff) and behind an SCR of 20, where the inverter's current acts on the voltage that it is synchronised to. The
paper says of the DSOGI-FLL that it cannot estimate the frequency properly under harmonics, and of the MSOGI-FLL that
it estimates it free of them. Both are so, in closed loop too.

Expected is what transfer functions make, to first order in the harmonics and in open loop, of the voltage that
the record has at the PCC: the sequence filters of each synchronisation, the q part of the error through the gain of
its loop, and eq (5) linearised, i* = i (1 - conj(p) - n) with p and n what u+ and u- carry. Ripples are half
peak-to-peak, over the whole cycles from 0.1 s after the record's mark to 0.02 s before its end. In antiphase the two
harmonics add up in the frequency, in phase in the length of u+.

The MSOGI-FLL alone has neither ripple nor a distorted current. The DSC-PLL has an undisturbed u+ but hands 5th and
7th to u-, and eq (5) hands them to the current. The notch of the SRF-PLL lets them through to u+: in phase, V_fault
then falls below 0.85 pu 300 times a second without any sag, fault mode cuts the power, and the tool refuses to
evaluate the test (`not_evaluated`: the power before the sag is not the one meant)."""
