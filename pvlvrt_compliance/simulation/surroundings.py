"""What surrounds the inverter, as tables of the kernels: the scenario's timeline in SI units.

Belongs to `translate.py`, the one place where words with units become symbols.
"""

import cmath
import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.plant import line
from pvlvrt_compliance.plant.grid import GridTable, HarmonicTable, PlaybackTable
from pvlvrt_compliance.plant.line import LineParams, LineTable
from pvlvrt_compliance.plant.pv_array import STC_IRRADIANCE
from pvlvrt_compliance.plant.weather import IrradianceTable
from pvlvrt_compliance.scenario.events import Harmonic, Recording
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.timeline import LONG_AGO_S, entries, irradiance_points
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.space_vectors import clarke
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.playback import read_voltages

_SQRT3_2 = math.sqrt(1.5)  # length of a power-invariant space vector per unit of phase amplitude


def _vector(values: Iterable[complex]) -> NDArray[np.complex128]:
    return np.array(list(values), dtype=np.complex128)


def grid_table(scenario: Scenario, nominal: Nominal, T_S: float) -> GridTable:
    """Source of a scenario; ``T_S`` is the plant step (s)."""
    found = entries(scenario)
    peak = nominal.phase_voltage_peak_v
    w = 2 * math.pi * np.array([entry.frequency_hz for entry in found])
    return GridTable(
        t=np.array([entry.t_s for entry in found]),
        theta=np.array([entry.angle_rad for entry in found]),
        w=w,
        dw=2 * math.pi * np.array([entry.rocof_hz_s for entry in found]),
        u_pos=_SQRT3_2 * peak * _vector(entry.sequences_pu.positive for entry in found),
        # A negative-sequence phasor turns backwards as a space vector: its angle changes sign.
        u_neg=_SQRT3_2 * peak * _vector(entry.sequences_pu.negative for entry in found).conj(),
        u_zero=peak * _vector(entry.sequences_pu.zero for entry in found),
        du_pos=_SQRT3_2 * peak * _vector(entry.slope_pu_s.positive for entry in found),
        du_neg=_SQRT3_2 * peak * _vector(entry.slope_pu_s.negative for entry in found).conj(),
        du_zero=peak * _vector(entry.slope_pu_s.zero for entry in found),
        half_rate=np.exp(0.5j * w * T_S),
        half_step=0.5 * T_S,
    )


def harmonic_table(scenario: Scenario, nominal: Nominal) -> HarmonicTable | None:
    """Harmonics of a scenario, if any. In phase a one is A cos(n theta + phi), whatever its sequence."""

    def begin_s(event: Harmonic) -> float:
        return LONG_AGO_S if event.t_s is None else scenario.start_s + event.t_s

    found = sorted((event for event in scenario.events if isinstance(event, Harmonic)), key=begin_s)
    if not found:
        return None
    peak = nominal.phase_voltage_peak_v
    phasors = [cmath.rect(peak * event.amplitude_pu, math.radians(event.phase_deg)) for event in found]
    signs = [{"positive": 1, "negative": -1, "zero": 0}[event.natural_sequence] for event in found]
    starts = [begin_s(event) for event in found]
    lengths = [math.inf if event.duration_s is None else event.duration_s for event in found]
    ends = np.array(starts, dtype=np.float64) + np.array(lengths, dtype=np.float64)
    return HarmonicTable(
        order=np.array([event.order * (sign or 1) for event, sign in zip(found, signs, strict=True)], dtype=np.int64),
        u=_vector(
            {1: _SQRT3_2 * u, -1: _SQRT3_2 * u.conjugate(), 0: 0j}[sign] for u, sign in zip(phasors, signs, strict=True)
        ),
        u_zero=_vector(u if sign == 0 else 0j for u, sign in zip(phasors, signs, strict=True)),
        t_on=np.array(starts, dtype=np.float64),
        t_off=ends,
        t_over=np.maximum.accumulate(ends),
    )


def playback_table(scenario: Scenario) -> PlaybackTable | None:
    """Recording of a scenario, if any.

    Raises
    ------
    UsageError
        When it cannot be read, or there are several.
    """
    found = [event for event in scenario.events if isinstance(event, Recording)]
    if not found:
        return None
    if len(found) > 1:
        raise UsageError("events: one recording at most")
    event = found[0]
    file, within = event.located()
    try:
        samples = read_voltages(file, event.channels, event.given_scale, scenario.nominal_frequency_hz, within)
    except UsageError as error:
        raise UsageError(event.as_named(str(error))) from None
    a, b, c = (samples[name] for name in event.channels)
    t = scenario.start_s + event.t_s
    return PlaybackTable(t=t, dt=samples.dt_s, u=np.ascontiguousarray(clarke(a, b, c)), u_zero=(a + b + c) / 3)


def line_of(parameters: Parameters, nominal: Nominal, scr: float | None, xr: float, T_S: float) -> LineParams:
    """Filter in series with a grid of this short-circuit ratio (none: stiff) and X/R."""
    Z = nominal.impedance_ohm / scr if scr is not None else 0.0
    R_g = Z / math.hypot(1, xr)
    L_g = R_g * xr / (2 * math.pi * nominal.frequency_hz)
    p, R = parameters.plant, parameters.plant.filter_resistance_ohm
    if parameters.simulation.fidelity == "switched":
        R += p.device_resistance_ohm  # one device conducts in every leg at any time
    return line.design(p.filter_inductance_h, R, L_g, R_g, T_S)


def line_table(scenario: Scenario, parameters: Parameters, nominal: Nominal, T_S: float) -> LineTable:
    """Lines that go with the entries of `grid_table`."""
    lines = [line_of(parameters, nominal, entry.scr, entry.xr, T_S) for entry in entries(scenario)]
    return LineTable(*(np.array(column) for column in zip(*lines, strict=True)))


def irradiance_table(scenario: Scenario) -> IrradianceTable:
    """Irradiance of a scenario."""
    points = np.array(irradiance_points(scenario))
    return IrradianceTable(t=points[:, 0].copy(), G=points[:, 1] / STC_IRRADIANCE)
