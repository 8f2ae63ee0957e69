"""The switched plant as an ngspice circuit, its gates driven at instants computed from a recorded modulating signal."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.waveforms import Segment
from validation.simulator.circuit import Compared, Drive, aligned, phase_values, rows, scenario_of, solved
from validation.simulator.evidence import Plot, Row, Section, at_most
from validation.simulator.records import NOMINAL, record, rms, without_trips
from validation.simulator.ripple import FINE, Ripple, ripple

SAG = Sag(depth=0.9, phases="c")
BEFORE_S, AFTER_S = 0.004, 0.004
SAG_STEPS = 3906
"""20 ms, and both ends within control periods."""
RIPPLE_LIMIT_PERCENT = 0.05
_EDGE_S = 1e-9

_IDEAL = {"dead_time_us": 0, "device_drop_v": 0, "device_resistance_ohm": 0, "switching_energy_mj": 0}


def ideal_devices(**plant: Any) -> Parameters:
    """Switched inverter without dead time, drops and losses, but for what is given of the plant; no relay acts."""
    return without_trips(simulation={"fidelity": "switched"}, plant={**_IDEAL, **plant})


def gate_edges(m: NDArray[np.float64], t: NDArray[np.float64]) -> NDArray[np.float64]:
    """Instants (s) at which three legs switch, up and down in turn, shape (3, 2 n).

    Sine-triangle comparison by hand: the references, 4/3 m_x in halves of the link less the middle of the largest and
    the smallest, against a triangle that falls from 1 at the beginning of a period to -1 at its middle and rises again.

    Parameters
    ----------
    m : array of shape (3, n)
        Modulating signals of the phases, each held for a period.
    t : array of shape (n + 1,)
        Limits of the periods (s).

    Raises
    ------
    ValueError
        When a reference leaves the triangle, so that a leg does not switch.
    """
    reference = 4 / 3 * m
    reference = reference - 0.5 * (reference.max(axis=0) + reference.min(axis=0))
    if np.abs(reference).max() >= 1:
        raise ValueError("overmodulation: a leg does not switch in every period")
    T = np.diff(t)
    up, down = t[:-1] + 0.25 * T * (1 - reference), t[1:] - 0.25 * T * (1 - reference)
    return np.stack([up, down], axis=-1).reshape(3, -1)


def gate(node: str, edges: NDArray[np.float64]) -> Iterator[str]:
    """Voltage source of 0 and 1 V in turn; it passes 0.5 V at the ``edges`` (s)."""
    yield f"V{node} {node} 0 PWL("
    yield "+ 0 0"
    for k, at in enumerate(edges):
        low = k % 2
        yield f"+ {at - _EDGE_S / 2:.13g} {low} {at + _EDGE_S / 2:.13g} {1 - low}"
    yield "+ )"


def gate_sources(samples: Segment) -> Iterator[str]:
    """Gates of the three upper switches; the signal of a sample acts in the period that begins at the next."""
    edges = gate_edges(phase_values(samples, "m")[:, :-2], samples.t_s[1:] - samples.t_s[1])
    for x, instants in zip("abc", edges, strict=True):
        yield from gate(f"m{x}", instants)


SWITCHED = Drive("1", gate_sources)


class Run(NamedTuple):
    """One run in both programs."""

    compared: Compared  # at the controller's samples
    ripple: Ripple  # between them, before the sag


def run(parameters: Parameters | None = None) -> Run:
    """Run both programs through a sag of one cycle, from 4 ms before it to 4 ms after it.

    Other parameters for the simulator than ideal devices, which the circuit has, make a difference that should show.
    """
    scenario, ideal = scenario_of(SAG, SAG_STEPS), ideal_devices()
    samples = record(scenario, parameters or ideal)
    samples = samples.slice(scenario.start_s - BEFORE_S, scenario.clear_s + AFTER_S)
    theirs = solved(scenario, ideal, samples, SWITCHED)
    return Run(aligned(scenario, samples, theirs), ripple(scenario, parameters or ideal, samples, theirs))


def ripple_rows(x: Ripple) -> tuple[Row, ...]:
    """Size of the ripple in both programs, and their difference."""
    ours, theirs = (float(np.abs(y).max()) for y in (x.ours, x.theirs))
    percent = 100 * rms(x.ours - x.theirs) / (NOMINAL.phase_current_peak_a / math.sqrt(2))
    return (
        Row("ripple of the currents at nominal, largest", ours, theirs, 0.01 * theirs, "A"),
        at_most("difference of the ripple at nominal, rms", percent, RIPPLE_LIMIT_PERCENT, "% of nominal", 0.01),
    )


def drawing(x: Ripple) -> Plot:
    """Ripple of both programs."""

    def draw(figure: Any) -> None:
        axes, shown = figure.subplots(), slice(0, 12 * FINE)
        for k, phase in enumerate("abc"):
            axes.plot(1e6 * x.t[shown], x.ours[k, shown], linewidth=1, label=f"i_{phase}")
            axes.plot(1e6 * x.t[shown][::4], x.theirs[k, shown][::4], "k.", markersize=2)
        axes.set(xlabel="time (us)", ylabel="ripple (A)")
        axes.legend(fontsize="x-small", loc="upper right")

    return Plot("ngspice-switched", "Ripple at nominal: lines are the simulator's, points are ngspice's.", draw)


def section() -> Section:
    """Section on ngspice's switched circuit."""
    found = run()
    figures = (*rows({"phase c 90 %, switched": found.compared}), *ripple_rows(found.ripple))
    return Section("Switched plant against ngspice", _TEXT, figures, (drawing(found.ripple),))


_TEXT = """The same circuit with three legs that switch: each at v_DC or at 0 as its gate is 1 or 0, i_DC the sum of the
currents of the legs that are up, the star point of the grid floating against the link. The gates change (in 1 ns) at
instants computed outside the simulator, from the recorded modulating signals and a triangle of 24.416 kHz; nothing is
rounded to a time step. Without dead time, drops and switching energy, which the circuit does not have. From 4 ms
before a sag of 20 ms to 4 ms after it, compared where the controller samples. There an averaged inverter would agree as
well; so the ripple between samples is compared too, as the current less the straight line between them, in every
period before the sag, each computed from its own sample on."""
