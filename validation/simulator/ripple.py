"""Current between the controller's samples, which the record of the switched plant does not show."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.kernel import in_python
from pvlvrt_compliance.plant.carrier import pulses_of
from pvlvrt_compliance.plant.line import LineParams, design
from pvlvrt_compliance.plant.plant import PlantParams
from pvlvrt_compliance.plant.switched_bridge import switched_flow
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import plant_params
from pvlvrt_compliance.vectors import phases_of
from pvlvrt_compliance.waveforms import Segment
from validation.simulator.records import vector

FINE = 64
"""Instants looked at in a carrier period."""

_pulses_of, _switched_flow, _phases_of = in_python(pulses_of), in_python(switched_flow), in_python(phases_of)


class Ripple(NamedTuple):
    """Phase currents within carrier periods, without what the line between the samples gives."""

    t: NDArray[np.float64]  # since the first period (s)
    ours: NDArray[np.float64]  # (A), shape (3, n)
    theirs: NDArray[np.float64]  # the same from ngspice (A), shape (3, n)


class Period(NamedTuple):
    """What a carrier period begins with."""

    i: complex  # current (A)
    v_dc: float  # DC-link voltage (V)
    i_pv: float  # array current (A)
    e: complex  # source (V)
    m: complex  # modulating signal (-)


def periods(samples: Segment) -> Iterator[Period]:
    """Periods from the second of ``samples`` on; the signal of a sample acts in the period that begins at the next."""
    m = samples["m_alpha"] + 1j * samples["m_beta"]
    i, e = vector(samples, "i"), vector(samples, "u0")
    for k in range(1, len(m) - 1):
        yield Period(complex(i[k]), float(samples["v_dc_v"][k]), float(samples["i_pv_a"][k]), e[k], m[k - 1])


def currents(x: Period, w: float, T: float, line: LineParams, p: PlantParams) -> Iterator[complex]:
    """Current (A) at ``FINE`` instants of a period (s) with a source that turns with ``w`` (rad/s)."""
    assert p.devices is not None
    pulses, i, v_dc, T_S = _pulses_of(x.m, T), x.i, x.v_dc, T / FINE
    for n in range(FINE):
        yield i
        e = x.e * np.exp(1j * w * (n + 0.5) * T_S)
        i, v_dc, _ = _switched_flow(i, v_dc, x.i_pv, e, n, pulses, line, p.C, T_S, p.devices)


def without_line(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Quantities at ``FINE`` instants a period less the straight line between the periods' beginnings.

    The last period has no line and is left out.
    """
    by_period = x.reshape(len(x), -1, FINE)
    begins = by_period[:, :, :1]
    line = begins[:, :-1] + (begins[:, 1:] - begins[:, :-1]) * np.arange(FINE) / FINE
    return (by_period[:, :-1] - line).reshape(len(x), -1)


def ripple(scenario: Scenario, parameters: Parameters, samples: Segment, theirs: NDArray[np.float64]) -> Ripple:
    """Currents of both programs within the periods of ``samples`` that lie before the sag.

    Parameters
    ----------
    theirs : array of shape (5, n)
        Time since the second sample (s), phase currents (A) and DC voltage (V) of ngspice.
    """
    T, w = samples.dt_s, 2 * np.pi * scenario.frequency_hz
    filter_ = parameters.plant
    line = design(filter_.filter_inductance_h, filter_.filter_resistance_ohm, 0.0, 0.0, T / FINE)
    p = plant_params(parameters, scenario)
    healthy = samples.slice(samples.t0_s, scenario.start_s - T)
    vectors = np.array([i for x in periods(healthy) for i in currents(x, w, T, line, p)])
    t = T / FINE * np.arange(len(vectors), dtype=np.float64)
    solution = np.array([np.interp(t, theirs[0], x) for x in theirs[1:4]])
    ours = without_line(np.array(_phases_of(vectors)))
    return Ripple(t=t[:-FINE], ours=ours, theirs=without_line(solution))
