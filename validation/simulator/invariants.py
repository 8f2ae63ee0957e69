"""What must hold of any run whatever its numbers: energy, three wires, and four kinds of symmetry."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import control_period_s
from pvlvrt_compliance.space_vectors import ROTATION_120
from pvlvrt_compliance.waveforms import Segment
from validation.simulator.energy import summing_bound, unbalanced_energy
from validation.simulator.evidence import Row, Section, at_most
from validation.simulator.records import NOMINAL, in_parallel, record, residual_sag, vector, without_trips

SCENARIOS = 500
PAIRS = 20
BALANCE_LIMIT = 1e-3
SUM_LIMIT = 1e-12
COPY_LIMIT = 1e-6
WINDOW_MIN_S = 0.02
_SEED = 61400
_HEALTHY = (1 + 0j, ROTATION_120.conjugate(), ROTATION_120)
_SETTLING_PERIODS = 12000


class Draw(NamedTuple):
    """A random scenario, and the window that its energy is balanced over."""

    residuals: tuple[complex, complex, complex]  # (pu)
    duration_s: float
    point_on_wave_deg: float
    frequency_hz: float
    irradiance_w_m2: float
    cell_temperature_c: float
    scr: float | None
    window_start: float  # as a share of the record (-)
    window_length: float  # as a share of what follows (-)

    @property
    def scenario(self) -> Scenario:
        """The scenario without its window."""
        return Scenario(
            sag=residual_sag(*self.residuals),
            duration_s=self.duration_s,
            point_on_wave_deg=self.point_on_wave_deg,
            frequency_hz=self.frequency_hz,
            irradiance_w_m2=self.irradiance_w_m2,
            cell_temperature_c=self.cell_temperature_c,
            scr=self.scr,
            before_s=0.25,
            after_s=0.25,
        )


def residual_phasors(magnitudes: Any, angles_rad: Any) -> tuple[complex, complex, complex]:
    """Residual phasors (pu) by magnitude and by the angle to the healthy phasor, three each."""
    turned = zip(magnitudes, angles_rad, _HEALTHY, strict=True)
    a, b, c = (complex(r * np.exp(1j * angle) * healthy) for r, angle, healthy in turned)
    return a, b, c


def random_draw(rng: np.random.Generator) -> Draw:
    """Any sag, at any weather and grid down to SCR 3."""
    return Draw(
        residuals=residual_phasors(rng.uniform(0, 1.1, 3), rng.uniform(-0.5, 0.5, 3)),
        duration_s=rng.uniform(0.02, 0.4),
        point_on_wave_deg=rng.uniform(0, 360),
        frequency_hz=rng.uniform(47, 63),
        irradiance_w_m2=rng.uniform(0, 1200),
        cell_temperature_c=rng.uniform(-20, 80),
        scr=None if rng.random() < 0.5 else float(rng.uniform(3, 50)),
        window_start=rng.uniform(0, 0.9),
        window_length=rng.uniform(0, 1),
    )


def draws(count: int) -> list[Draw]:
    """Random scenarios, the same every time."""
    rng = np.random.default_rng(_SEED)
    return [random_draw(rng) for _ in range(count)]


class Broken(NamedTuple):
    """By how much a record breaks what must hold."""

    not_finite: int  # values
    balance: float  # energy that is missing or too much, over S_nom times the window (-)
    of_bound: float  # the same over what summing samples can be wrong by, see `summing_bound` (-)
    current_sum: float  # largest sum of the three phase currents (pu)


def window_of(samples: Segment, draw: Draw) -> Segment:
    """Window of at least 20 ms somewhere in a record."""
    room = samples.end_s - WINDOW_MIN_S
    start = draw.window_start * room
    return samples.slice(start, start + WINDOW_MIN_S + draw.window_length * (room - start))


def broken(draw: Draw, parameters: Parameters | None = None) -> Broken:
    """Simulate a scenario and look at what must hold of it."""
    parameters = parameters or without_trips()
    samples = record(draw.scenario, parameters)
    window = window_of(samples, draw)
    energy = NOMINAL.apparent_power_va * (len(window) - 1) * window.dt_s
    left = abs(unbalanced_energy(window, draw.scenario, parameters))
    return Broken(
        not_finite=sum(int((~np.isfinite(x)).sum()) for x in samples.channels.values()),
        balance=left / energy,
        of_bound=left / summing_bound(window, draw.scenario, parameters),
        current_sum=float(np.abs(sum(samples.three_phase("i"))).max()) / NOMINAL.phase_current_peak_a,
    )


def difference(a: Segment, b: Segment, turn: complex = 1.0) -> float:
    """Largest difference of two records sample by sample, of nominal; the first one's vectors are turned."""
    n = min(len(a), len(b))
    apart = [
        np.abs(turn * vector(a, "u")[:n] - vector(b, "u")[:n]) / NOMINAL.voltage_ab_v,
        np.abs(turn * vector(a, "i")[:n] - vector(b, "i")[:n]) / NOMINAL.current_ab_a,
        np.abs(a["v_dc_v"][:n] - b["v_dc_v"][:n]) / 1e3,
        np.abs(a["p_ref_w"][:n] - b["p_ref_w"][:n]) / NOMINAL.apparent_power_va,
    ]
    return float(max(x.max() for x in apart))


def _settled(periods: int) -> dict[str, Any]:
    # Half a period less, so that rounding up gives exactly this number.
    return {"settling_s": (periods - 0.5) * control_period_s(Parameters())}


def time_shift(draw: Draw, periods: int = 1234) -> float:
    """Difference that it makes when everything happens a number of control periods later (of nominal)."""
    later = periods * control_period_s(Parameters())
    scenario = draw.scenario
    usual = record(scenario, without_trips(simulation=_settled(_SETTLING_PERIODS)))
    shifted = scenario.model_copy(update={"before_s": scenario.before_s + later})
    late = record(shifted, without_trips(simulation=_settled(_SETTLING_PERIODS - periods)))
    return difference(usual, late.slice(later - 0.5 * late.dt_s, late.end_s + late.dt_s))


def phase_rotation(draw: Draw) -> float:
    """Difference between a sag and the same one phase on and 120 degrees later on the wave (of nominal).

    The three phases of the second record are those of the first with their names moved on: c, a, b.
    """
    a, b, c = draw.residuals
    moved = (c * ROTATION_120.conjugate(), a * ROTATION_120.conjugate(), b * ROTATION_120.conjugate())
    rotated = draw._replace(residuals=moved, point_on_wave_deg=(draw.point_on_wave_deg + 120) % 360)
    return difference(record(draw.scenario), record(rotated.scenario), turn=ROTATION_120)


def scaled_in_time(parameters: Parameters, k: float) -> Parameters:
    """Parameters of the same plant and controller with all times ``k`` times as long.

    Steps, C and L and every time scale with k, every gain or guard per second or per hertz with 1/k; resistances,
    proportional gains and everything in volts, amperes and watts stay. The equations are then the same in t/k.
    """
    by = {
        "simulation": {"plant_step_us": k, "settling_s": k},
        "plant": {"dc_link_capacitance_f": k, "filter_inductance_h": k, "breaker_opening_s": k},
        "controller": {
            "fll_gain": 1 / k,
            "fll_frequency_min_hz": 1 / k,
            "fll_frequency_max_hz": 1 / k,
            "dc_integral_gain_w_per_vs": 1 / k,
            "pr_cutoff_rad_s": 1 / k,
            "mppt_period_s": k,
        },
    }
    groups = parameters.model_dump()
    for group, factors in by.items():
        for name, factor in factors.items():
            groups[group][name] *= factor
    return Parameters.model_validate(groups)


def frequency_scaling(draw: Draw) -> float:
    """Difference between 50 Hz and 60 Hz with all times 5/6 as long, sample by sample (of nominal)."""
    k = 50 / 60
    usual = draw._replace(frequency_hz=50.0).scenario
    parameters = without_trips()
    times = {name: k * getattr(usual, name) for name in ("duration_s", "after_s")}
    # The record before the sag has a lower limit, so it is the 50 Hz run that is longer.
    usual = usual.model_copy(update={"before_s": 0.3})
    fast = usual.model_copy(update={"frequency_hz": 60.0, "before_s": k * 0.3, **times})
    return difference(record(usual, parameters), record(fast, scaled_in_time(parameters, k)))


class Worst(NamedTuple):
    """Largest figures over all random scenarios."""

    not_finite: int
    balance: float
    of_bound: float
    current_sum: float
    time_shift: float
    phase_rotation: float
    frequency_scaling: float


def worst(scenarios: int = SCENARIOS, pairs: int = PAIRS) -> Worst:
    """Largest figures over seeded random scenarios."""
    runs: NDArray[np.float64] = np.array(in_parallel(broken, draws(scenarios)), dtype=np.float64)
    copies = [max(in_parallel(f, draws(pairs))) for f in (time_shift, phase_rotation, frequency_scaling)]
    return Worst(int(runs[:, 0].sum()), *map(float, runs[:, 1:].max(axis=0)), *copies)


def rows(w: Worst) -> tuple[Row, ...]:
    """Largest figures."""
    return (
        at_most(f"values that are not finite, {SCENARIOS} scenarios", float(w.not_finite), 0.0),
        at_most("energy balance over a random window", w.balance, BALANCE_LIMIT, "of S_nom times the window"),
        at_most("the same, as a share of what summing the samples can miss", w.of_bound, 1.0),
        at_most("sum of the three phase currents", w.current_sum, SUM_LIMIT, "pu", 1e-14),
        at_most(f"everything 1234 control periods later, {PAIRS} pairs", w.time_shift, COPY_LIMIT, "of nominal", 1e-7),
        at_most(f"the sag one phase on, {PAIRS} pairs", w.phase_rotation, COPY_LIMIT, "of nominal", 1e-7),
        at_most(f"60 Hz as a scaled 50 Hz, {PAIRS} pairs", w.frequency_scaling, COPY_LIMIT, "of nominal", 1e-7),
    )


def section() -> Section:
    """Section on invariants."""
    return Section("Invariants", _TEXT, rows(worst()))


_TEXT = """Random scenarios: residual voltages from 0 to 1.1 pu and half a radian off their angles, 20 to 400 ms,
any point on wave, 47 to 63 Hz, 0 to 1200 W/m2, -20 to 80 degrees C, stiff or SCR 3 to 50, no relay acting.
`tests/validation/` lets hypothesis draw another 500.

- Energy: what the array gives is stored in the link and the inductances, lost in the resistances, or taken by the
  source, over any window of at least a cycle, summed from the recorded samples. Two things are known of the record
  and seen to: a sag begins and ends within a step between samples, from the plant step on whose middle it precedes,
  so that step is cut there (the trapezium rule would put the jump halfway, and half of 41 us at nominal power is a
  thousandth of a cycle's energy); and the array's current is that of half a plant step before its sample. What is
  left is the trapezium rule's own, at most h^2/12 of the integral of |p''| and, at each jump, h^2/2 of |p'|. With
  voltages up to E and currents up to I, |p''| is within 2 w E |di/dt| + w^2 E I + w E^2/L and |p'| within
  w E I + E |di/dt|; the sum of |di/dt| dt is the way that the current goes. This bound is made for each window,
  whatever its length, from its own samples, and is some 1e-4 of S_nom times the window.
- The three currents sum to zero. The record is made from one vector, so this guards the recorder; the circuit above,
  which has three wires and a zero-sequence voltage, is the evidence for the plant.
- Time shift: a sag that comes 1234 control periods later gives the same record as much later.
- Phase rotation: the same sag in b, c, a instead of a, b, c, and 120 degrees later on the wave, gives the same record
  with its phases renamed.
- Frequency scaling: 60 Hz with every time 5/6 as long. Steps, C, L and all times scale with 5/6, everything per
  second or in hertz (Gamma, w_c, K_I of the DC voltage, guards) with 6/5, resistances, proportional gains and levels
  stay. The equations are then the same in scaled time, and the samples must be equal one by one: it is exact but for
  rounding."""
