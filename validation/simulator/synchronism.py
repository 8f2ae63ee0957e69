"""Finding: where the paper's control falls out of step with a weak grid, and what fails before."""

from functools import cache
from typing import Any

import numpy as np

from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.waveforms import Segment
from validation.simulator.closed_forms import closed_form
from validation.simulator.evidence import Plot, Row, Section, shown
from validation.simulator.findings import Finding, checks_of, shell
from validation.simulator.records import NOMINAL, in_parallel, record
from validation.simulator.weak_grids import (
    OUTCOMES,
    Case,
    frequency_range_hz,
    judged_part,
    largest_power,
    nominal_boundary,
    outcome,
    slow_support_boundary,
    support_boundary,
    voltage_at_power,
    voltage_in_fault_mode,
    weakest_for_nominal,
    weakest_for_support,
)

NO_SAG, DEEP, ONE_PHASE = Sag(depth=0), Sag(depth=0.9), Sag(depth=0.5, phases="c")
STRENGTHS = (10.0, 5.0, 3.0, 2.0, 1.5, 1.0)
RATIOS = (10.0, 3.0, 0.1)
CONTROLS = {
    "msogi-fll": (),
    "dsogi-fll": ("controller.synchronisation=dsogi-fll",),
    "ddsrf-pll": ("controller.synchronisation=ddsrf-pll",),
    "dsc-pll": ("controller.synchronisation=dsc-pll",),
    "srf-pll": ("controller.synchronisation=srf-pll",),
    "srf-pll, 3 Hz": ("controller.synchronisation=srf-pll", "controller.pll_bandwidth_hz=3"),
    "srf-pll, 20 Hz": ("controller.synchronisation=srf-pll", "controller.pll_bandwidth_hz=20"),
}
"""Synchronisations and their gains by name, as ``--set`` takes them."""
Map = dict[str, tuple[Case, ...]]
"""Cases by the name of a line; one for each of `STRENGTHS`."""


def _deep_sag(scr: float, verdict: str) -> Finding:
    scenario = Scenario(sag=DEEP, duration_s=0.309, scr=scr, xr=3.0)
    return Finding(scenario, ("--sag", "90%", "--scr", f"{scr:g}", "--xr", "3", "--duration", "309ms"), verdict)


LOSS = _deep_sag(3, "pass")
IN_STEP = _deep_sag(5, "fail")
TOO_WEAK = Finding(
    Scenario(sag=NO_SAG, duration_s=0.309, scr=1.5),
    ("--sag", "0%", "--scr", "1.5", "--duration", "309ms"),
    "not_evaluated",
)


@cache
def maps() -> dict[str, Map]:
    """What is tried: sags by X/R, and synchronisations in a sag and where the grid gets weaker as a sag clears."""
    found = {
        name: {f"X/R {xr:g}": tuple(Case(sag, scr, xr) for scr in STRENGTHS) for xr in RATIOS}
        for name, sag in (("no sag", NO_SAG), ("phase c 50 %", ONE_PHASE), ("three-phase 90 %", DEEP))
    }
    for name, before in (("three-phase 90 %, X/R 3", None), ("SCR 20 before clearing, X/R 3", 20.0)):
        found[name] = {
            control: tuple(Case(DEEP, scr, 3.0, settings, before) for scr in STRENGTHS)
            for control, settings in CONTROLS.items()
        }
    return found


@cache
def outcomes(name: str) -> dict[str, list[int]]:
    """Outcomes of a map, by line."""
    cases = [case for line in maps()[name].values() for case in line]
    results = iter(in_parallel(outcome, cases))
    return {line: [next(results) for _ in STRENGTHS] for line in maps()[name]}


def _draw_map(axes: Any, name: str, colours: Any) -> None:
    lines = outcomes(name)
    axes.pcolormesh(np.array(list(lines.values())), cmap=colours, vmin=-0.5, vmax=4.5, edgecolors="w", linewidth=1)
    axes.invert_yaxis()
    axes.set_title(name, fontsize="small")
    axes.set_xlabel("SCR", fontsize="small")
    axes.set_xticks(0.5 + np.arange(len(STRENGTHS)), [f"{scr:g}" for scr in STRENGTHS], fontsize="x-small")
    axes.set_yticks(0.5 + np.arange(len(lines)), list(lines), fontsize="x-small")
    axes.grid(False)


def _plot(file: str, caption: str, names: tuple[str, ...], height: float) -> Plot:
    def draw(figure: Any) -> None:
        from matplotlib.colors import ListedColormap
        from matplotlib.patches import Patch

        colours = ListedColormap(["#d9f0d3", "#fee08b", "#f4a15d", "#bdbdbd", "#a50026"])
        for axes, name in zip(figure.subplots(1, len(names)), names, strict=True):
            _draw_map(axes, name, colours)
        patches = [Patch(color=colours(k), label=text) for k, text in enumerate(OUTCOMES)]
        figure.legend(handles=patches, loc="outside lower center", ncols=len(OUTCOMES), fontsize="x-small")

    return Plot(file, caption, draw, height)


def _traces(figure: Any) -> None:
    """Estimated frequency and V_fault of two runs without relays."""
    left, right = figure.subplots(1, 2)
    for finding in (IN_STEP, LOSS):
        run = finding.scenario
        part = record(run).slice(run.start_s - 0.05, run.clear_s + 0.15)
        t = 1e3 * (part.t_s - run.start_s)
        left.plot(t, part["frequency_estimate_hz"], label=f"SCR {run.scr:g}", linewidth=1)
        right.plot(t, part["v_fault_pu"], label=f"SCR {run.scr:g}", linewidth=1)
    left.set(xlabel="time from the start of the sag (ms)", ylabel="frequency estimate (Hz)")
    right.set(xlabel="time from the start of the sag (ms)", ylabel="V_fault (pu)")
    left.legend(fontsize="x-small")


def _mean_of(part: Segment, channel: str) -> float:
    return float(part[channel].mean())


def voltage_row(scr: float, xr: float) -> Row:
    """V_fault without a sag at full power."""
    found = _mean_of(judged_part(Case(NO_SAG, scr, xr)), "v_fault_pu")
    return Row(f"V_fault, no sag, SCR {scr:g}, X/R {xr:g}", found, voltage_at_power(1, scr, xr), 0.01, "pu")


def support_row(scr: float, xr: float) -> Row:
    """V_fault in the deep sag, of reactive current alone."""
    found = _mean_of(judged_part(Case(DEEP, scr, xr)), "v_fault_pu")
    return Row(f"V_fault, 90 %, SCR {scr:g}, X/R {xr:g}", found, voltage_in_fault_mode(0.1, scr, xr), 0.01, "pu")


def nominal_rows() -> tuple[Row, ...]:
    """What a grid carries without a sag."""
    fault_mode_v = voltage_in_fault_mode(1, 1.5, 10)
    power = _mean_of(judged_part(Case(NO_SAG, 1.5, 10)), "p_ref_w") / NOMINAL.apparent_power_va
    bounds = [(xr, weakest_for_nominal(xr)) for xr in (10.0, 3.0)]
    return (
        *(voltage_row(scr, 10) for scr in (5, 3, 2)),
        *(Row(f"lowest SCR for nominal power, X/R {xr:g}", nominal_boundary(xr), b, 0.03 * b) for xr, b in bounds),
        Row("P*, no sag, SCR 1.5, X/R 10", power, closed_form(fault_mode_v, 0.0).p, 0.01, "pu"),
        *(shown(f"most that can be carried, SCR {scr:g}, X/R 10", largest_power(scr, 10), "pu") for scr in (2, 1.5, 1)),
    )


def deep_rows() -> tuple[Row, ...]:
    """What a grid carries in a deep sag."""
    pairs = [(0.9, 3.0), (0.9, 1.0), (0.95, 3.0)]
    slow = in_parallel(lambda pair: slow_support_boundary(*pair), pairs)
    sudden = in_parallel(lambda pair: support_boundary(*pair), pairs)
    bounds = [weakest_for_support(1 - depth, xr) for depth, xr in pairs]
    names = [f"{100 * depth:g} %, X/R {xr:g}" for depth, xr in pairs]
    return (
        *(support_row(*pair) for pair in ((5, 10), (3, 10), (5, 3))),
        *(Row(f"lowest SCR in step, slow {n}", x, b, 0.06 * b) for n, x, b in zip(names, slow, bounds, strict=True)),
        *(shown(f"lowest SCR in step, sudden {name}", x) for name, x in zip(names, sudden, strict=True)),
    )


def gain_rows() -> tuple[Row, ...]:
    """The FLL's own part in it, where a state of rest exists."""
    gains = (50, 20, 10, 5)
    cases = [Case(Sag(depth=0.8), 2.5, 10.0, (f"controller.fll_gain={gain}",)) for gain in gains]
    highest = [frequency_range_hz(case)[1] for case in cases]
    return tuple(
        shown(f"highest estimate, 80 %, SCR 2.5, X/R 10, Gamma = {gain}", x, "Hz")
        for gain, x in zip(gains, highest, strict=True)
    )


def section() -> Section:
    """Section on weak grids."""
    trip = checks_of(LOSS)["ride_through"]
    rows = (
        *nominal_rows(),
        *deep_rows(),
        *gain_rows(),
        shown("trip after the start, in the report", trip["measured"], "s"),
    )
    plots = (
        Plot("synchronism", "Three-phase 90 %, X/R 3, no relay acting.", _traces),
        _plot("weak-grids", "Sags on weak grids.", ("no sag", "phase c 50 %", "three-phase 90 %"), 2.6),
        _plot(
            "weak-grids-synchronisations",
            "Other synchronisations (three-phase 90 %), and a grid that gets weaker as the sag clears.",
            ("three-phase 90 %, X/R 3", "SCR 20 before clearing, X/R 3"),
            3.6,
        ),
    )
    return Section("Finding: loss of synchronism in weak grids", _TEXT + shell(LOSS) + shell(TOO_WEAK), rows, plots)


_TEXT = """No relay acts in the figures; the commands have theirs. Synchronism counts as lost when the estimated
frequency is outside 45 to 55 Hz later than 0.1 s after the start of the sag. E is the voltage of the source, Z = R + jX
the grid's impedance, V the voltage at the PCC, all in pu.

Without a sag a grid carries at unity power factor at most P = E^2 / (2 (|Z| - R)), and V follows from E^2 = (V -
R P/V)^2 + (X P/V)^2. With X/R = 10 nominal power takes V below 0.85 pu at an SCR of 1.90: the detector flags a fault
that is none, fault mode cuts the power, and it stays there (SCR 1.5). The tool then says `not_evaluated`: the power
before the sag is not the one meant. At an SCR of 1 the mode goes to and fro and the FLL runs
to its guard, whatever the sag.

In a deep three-phase sag the paper's control feeds 1 pu of reactive current and nothing else. What that current loses
in the grid's resistance has to come from the source, which gives at most E times 1 pu: there is a state of rest only
while R <= E, that is down to SCR = 1 / (E sqrt(1 + (X/R)^2)). Below, the inverter slips: the FLL falls to its guard at
40 Hz, V collapses, the undervoltage relay trips and `ride_through` fails. The simulator finds this limit where the
voltage takes a second to fall; where the sag is sudden, the excursion of the FLL (above) leaves the state of rest
somewhat earlier.

With X/R = 10 the limit is an SCR of 1, yet synchronism goes at 2: the reactive current lifts V above 0.58 pu, where
eq (10) lets active power in again, and the FLL swings out although a state of rest exists. There its gain decides: the
smaller Gamma, the smaller the swing. Where there is no state of rest, it slips with any.

A sag of phase c by 50 % is kept in step down to an SCR of 1.5; what fails there is the current limit (the blind spot)
with X/R = 3 and less, and the mode goes to and fro. A grid that falls from an SCR of 20 as a three-phase sag clears is
kept in step down to 1.5. Other synchronisations do no better: the DSOGI-FLL and the DDSRF-PLL lose the same cases,
the DSC-PLL loses more. The SRF-PLL does not even come to full power at X/R = 3 and an SCR of 10: its notch passes
whatever is fast, i* follows the voltage that the current makes across the grid, and the mode goes to and fro."""
