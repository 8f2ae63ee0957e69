"""What surprises in the paper's control: properties of it, each with the command that shows it."""

import json
import subprocess
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters, parameters_from
from pvlvrt_compliance.waveforms import Segment
from validation.places import ROOT
from validation.simulator.evidence import Plot, Row, Section, shown
from validation.simulator.records import NOMINAL, record

_START = ("--profile", "spain-q-curve")


class Finding(NamedTuple):
    """A sag, the options that ask the command line for it, and the verdict that the tool then gives."""

    scenario: Scenario
    options: tuple[str, ...]
    current_limit: str  # status of that check
    settings: tuple[str, ...] = ()  # what ``--set`` changes

    @property
    def arguments(self) -> tuple[str, ...]:
        """What the program is given."""
        return (*_START, *self.options, *(part for setting in self.settings for part in ("--set", setting)))

    @property
    def command(self) -> str:
        """Command to type."""
        return " ".join(("pvlvrt-check", *self.arguments))


BLIND_SPOT = Finding(
    Scenario(sag=Sag(depth=0.45, phases="c"), duration_s=0.5, scr=30.0),
    ("--sag", "45%", "--phases", "c", "--scr", "30", "--duration", "500ms"),
    "fail",
)
SMALL_SAG = Finding(Scenario(sag=Sag(depth=0.1), duration_s=0.5), ("--sag", "10%", "--duration", "500ms"), "fail")
TOGGLING = Finding(
    Scenario(sag=Sag(depth=0.15), duration_s=0.5, scr=7.0),
    ("--sag", "15%", "--scr", "7", "--duration", "500ms"),
    "fail",
)
EXCURSION = Finding(Scenario(sag=Sag(depth=0.9), duration_s=0.309), ("--sag", "90%", "--duration", "309ms"), "pass")


@cache
def samples_of(finding: Finding) -> Segment:
    """Record of the run that the command makes."""
    return record(finding.scenario, parameters_from(finding.settings))


@cache
def report_of(finding: Finding) -> dict[str, Any]:
    """Run the command from the checkout's folder; the one test of its report."""
    with tempfile.TemporaryDirectory() as folder:
        program = [sys.executable, "-m", "pvlvrt_compliance.cli.main"]
        command = [*program, *finding.arguments, "--output", folder]
        subprocess.run(command, capture_output=True, check=False, cwd=ROOT)
        results = json.loads((Path(folder) / "results.json").read_text(encoding="utf-8"))
    found: dict[str, Any] = results["tests"][0]
    return found


def checks_of(finding: Finding) -> dict[str, dict[str, Any]]:
    """Checks in the report of the command, by name."""
    return {check["check"]: check for check in report_of(finding)["checks"]}


def settled(finding: Finding) -> Segment:
    """Samples from 0.1 s after the start of the sag to 0.02 s before its end."""
    scenario = finding.scenario
    return samples_of(finding).slice(scenario.start_s + 0.1, scenario.clear_s - 0.02)


def largest_current_pu(finding: Finding) -> float:
    """Largest instantaneous phase current once the sag has settled (pu)."""
    return float(np.abs(settled(finding).three_phase("i")).max()) / NOMINAL.phase_current_peak_a


def mode_changes(finding: Finding) -> int:
    """How often the Fault Signal changes once the sag has settled."""
    return int(np.abs(np.diff(settled(finding)["fault_signal"])).sum())


def lowest_frequency_hz(finding: Finding) -> float:
    """Lowest estimate of the frequency (Hz)."""
    return float(samples_of(finding)["frequency_estimate_hz"].min())


def settled_current_form(finding: Finding) -> float:
    """Largest phase current (pu) of normal mode under unbalance, P / (V+ - V-), from V+ and V- without the inverter."""
    positive, negative, _ = finding.scenario.sag.sequences_pu()
    return float(1 / (abs(positive) - abs(negative)))


def half_sag_v_fault(xr: float) -> float:
    """V_fault (pu) that a sag of 50 % of one phase settles at, behind an SCR of 50 with this X/R."""
    scenario = Scenario(sag=Sag(depth=0.5, phases="c"), duration_s=0.3, scr=50.0, xr=xr)
    part = record(scenario, Parameters()).slice(scenario.start_s + 0.1, scenario.clear_s - 0.02)
    return float(part["v_fault_pu"].mean())


def verdict_row(finding: Finding) -> Row:
    """What the tool measures of the current."""
    measured = checks_of(finding)["current_limit"]["measured"]
    return shown("largest fundamental current in the report", float(measured), "pu")


def traces(
    finding: Finding, lines: dict[str, Callable[[Segment], Any]], label: str, limit: float
) -> Callable[[Any], None]:
    """Drawing of quantities over time from 40 ms before the sag, with a dashed limit."""

    def draw(figure: Any) -> None:
        scenario = finding.scenario
        part = samples_of(finding).slice(scenario.start_s - 0.04, min(scenario.start_s + 0.2, scenario.clear_s + 0.1))
        axes = figure.subplots()
        for name, line in lines.items():
            axes.plot(1e3 * (part.t_s - scenario.start_s)[::8], line(part)[::8], label=name, linewidth=1)
        axes.axhline(limit, color="k", linestyle="--", linewidth=0.8)
        axes.set(xlabel="time from the start of the sag (ms)", ylabel=label)
        axes.legend(loc="upper right", fontsize="x-small")

    return draw


def _current(part: Segment) -> Any:
    return np.abs(part.three_phase("i")).max(axis=0) / NOMINAL.phase_current_peak_a


def shell(finding: Finding) -> str:
    """Command to type, as Markdown that follows a text."""
    return f"\n\n```sh\n{finding.command}\n```"


def sections() -> tuple[Section, ...]:
    """One section a finding."""
    return (blind_spot(), small_sag(), toggling(), excursion())


def blind_spot() -> Section:
    """A sag of one phase that leaves V+ above the threshold."""
    draw = traces(
        BLIND_SPOT, {"largest phase current (pu)": _current, "V_fault (pu)": lambda x: x["v_fault_pu"]}, "pu", 0.85
    )
    rows = (
        shown("V_fault, mean", float(settled(BLIND_SPOT)["v_fault_pu"].mean()), "pu"),
        shown("changes of the Fault Signal", float(mode_changes(BLIND_SPOT))),
        verdict_row(BLIND_SPOT),
        *(shown(f"V_fault at 50 %, SCR 50, X/R {xr:g}", half_sag_v_fault(xr), "pu") for xr in (10.0, 0.1)),
        Row("largest current", largest_current_pu(BLIND_SPOT), settled_current_form(BLIND_SPOT), 0.05, "pu"),
    )
    return Section(
        "Finding: the detector's blind spot",
        _BLIND_SPOT + shell(BLIND_SPOT),
        rows,
        (Plot("blind-spot", "Dashed: the threshold of the detector.", draw),),
    )


def small_sag() -> Section:
    """A balanced sag to 0.9 pu at full power."""
    rows = (
        verdict_row(SMALL_SAG),
        Row("largest current", largest_current_pu(SMALL_SAG), settled_current_form(SMALL_SAG), 0.02, "pu"),
    )
    draw = traces(SMALL_SAG, {"largest phase current (pu)": _current}, "pu", 1.0)
    return Section(
        "Finding: no current limit above 0.85 pu",
        _SMALL_SAG + shell(SMALL_SAG),
        rows,
        (Plot("small-sag", "Dashed: nominal current.", draw),),
    )


def toggling() -> Section:
    """A weak grid whose voltage the reactive current lifts over the threshold."""
    rows = (shown("changes of the Fault Signal in 0.38 s", float(mode_changes(TOGGLING))), verdict_row(TOGGLING))
    lines: dict[str, Callable[[Segment], Any]] = {
        "V_fault (pu)": lambda x: x["v_fault_pu"],
        "largest phase current (pu)": _current,
        "P* (pu)": lambda x: x["p_ref_w"] / NOMINAL.apparent_power_va,
    }
    return Section(
        "Finding: toggling in weak grids",
        _TOGGLING + shell(TOGGLING),
        rows,
        (Plot("toggling", "Dashed: the threshold of the detector.", traces(TOGGLING, lines, "pu", 0.85)),),
    )


def excursion() -> Section:
    """The estimated frequency at a deep sag."""
    estimate = samples_of(EXCURSION)["frequency_estimate_hz"]
    dt = samples_of(EXCURSION).dt_s
    rows = (
        shown("lowest estimate", lowest_frequency_hz(EXCURSION), "Hz"),
        shown("highest estimate", float(estimate.max()), "Hz"),
        shown("time below 47 Hz", 1e3 * dt * float((estimate < 47).sum()), "ms"),
        verdict_row(EXCURSION),
    )
    draw = traces(EXCURSION, {"frequency estimate (Hz)": lambda x: x["frequency_estimate_hz"]}, "Hz", 50.0)
    return Section(
        "Finding: excursion of the FLL",
        _EXCURSION + shell(EXCURSION),
        rows,
        (Plot("excursion", "Three-phase 90 %; the grid stays at 50 Hz.", draw),),
    )


_BLIND_SPOT = """The detector looks at V+ alone. A deep sag of one phase behind a grid impedance leaves V+ above
0.85 pu: no fault is flagged, normal mode goes on feeding nominal power by eq (5), and the current is P / (V+ - V-),
far beyond nominal, for as long as the sag lasts. The tool reports a failed `current_limit`.

How deep a sag is missed depends on what the grid's impedance makes of the inverter's own power: resistance lifts
V+, reactance hardly does. 50 % of one phase (V+ = 0.833 without the inverter) is flagged at SCR 50 with X/R = 10
and missed with X/R = 0.1."""
_SMALL_SAG = """Between 0.85 and 1 pu nothing in the paper lowers the active power with the voltage, so at full
power the current is P/V. This is the voltage drop VD1 of the profile `iec61400-21` at full power. A failed
`current_limit`."""
_TOGGLING = """The detector has no hysteresis. Fault mode lowers P and raises Q, which lifts V+ of a weak grid above
0.85 pu; back in normal mode the voltage falls again. Mode, power and current go to and fro for as long as the sag
lasts. A failed `current_limit`."""
_EXCURSION = """The jump of amplitude and phase at a deep sag looks like a frequency to the FLL, whose normalisation
amplifies it by the lost voltage: the estimate leaves the grid's frequency for some milliseconds, and the resonators
follow it. Nothing is asked of it in the grid codes here, and the checks pass; the limits of the estimate (40 and 70
Hz) are a guard that the paper does not have."""
