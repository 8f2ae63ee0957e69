"""Sensors and delays: what they make of a number and of a frequency, as they run and in closed form."""

import cmath
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.hardware.delays import DelayParams, acting, filled, put
from pvlvrt_compliance.hardware.sensors import CHANNELS, SensorParams, converted
from pvlvrt_compliance.kernel import in_python
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.simulation.electronics import sensor_params
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.translate import control_period_s
from validation.blocks.svg import Axes, Figure, curve
from validation.simulator import loops
from validation.simulator.evidence import Row, at_most, shown

_NOTHING = Measured(u_g_ab=0j, i_ab=0j, v_dc=0.0, i_pv=0.0)


def sensors(*settings: str) -> SensorParams:
    """Sensors under settings, as ``name=value``."""
    return sensor_params(parameters_from(f"sensors.{text}" for text in settings).sensors)


def seen(channel: str, values: NDArray[np.float64], p: SensorParams) -> NDArray[np.float64]:
    """What the controller reads of a channel, without noise."""
    k = CHANNELS.index(channel)
    return np.array([in_python(converted)(float(v), k, 0.0, p) for v in values])


def sensor_rows() -> tuple[Row, ...]:
    """Resolution of a usual converter, and the noise of rounding."""
    p = sensors("adc_bits=12")
    values = 300 * np.cos(np.arange(4001) * 0.7391)
    error = seen("u_a", values, p) - values
    step = dict(zip(CHANNELS, p.step, strict=True))
    return (
        shown("12 bits: step of a phase voltage", step["u_a"], "V"),
        shown("12 bits: step of a phase current", step["i_a"], "A"),
        shown("12 bits: step of v_DC", step["v_dc"], "V"),
        Row(
            "rms of what rounding adds to a voltage",
            float(np.sqrt(np.mean(error**2))),
            step["u_a"] / math.sqrt(12),
            0.003,
            "V",
        ),
        Row(
            "largest voltage that can be read", float(seen("u_a", np.array([1e4]), p)[0]), 600 - step["u_a"], 1e-9, "V"
        ),
        at_most(
            "ideal: difference from what there is",
            float(np.abs(seen("u_a", values, sensors()) - values).max()),
            0.0,
            "V",
        ),
    )


def sensor_figure() -> Figure:
    """A coarse converter, and one that is wrong."""
    values = np.linspace(-750, 750, 301)
    coarse = seen("u_a", values, sensors("adc_bits=4"))
    wrong = seen("u_a", values, sensors("voltage_gain=[1.1, 1, 1]", "voltage_offset_v=[60, 0, 0]", "adc_bits=12"))
    few = np.r_[0:301:2]
    curves = (
        curve("ideal", values[[0, -1]], values[[0, -1]], dashed=True),
        curve("4 bits, ±600 V", values, coarse),
        curve("12 bits, gain 1.1, offset 60 V", values[few], wrong[few]),
    )
    panel = Axes("phase voltage (V)", "what the controller reads (V)", curves)
    return Figure(
        "hardware/figures/sensors.svg",
        "What a sensor makes of a voltage: steps, ends of its range, gain, offset",
        (panel,),
    )


def sent(periods: int, f: float, samples: int) -> NDArray[np.complex128]:
    """What acts from each sample on, of a signal that turns at a frequency (Hz), computed from each sample."""
    T = control_period_s(parameters_from(()))
    lines = filled(DelayParams(measurement=0, computation=periods), _NOTHING, 0j)
    found = np.empty(samples, dtype=np.complex128)
    for n in range(samples):
        in_python(put)(lines, n, cmath.exp(2j * math.pi * f * T * n))
        found[n] = in_python(acting)(lines, n)
    return found


def lag(periods: int, f: float) -> float:
    """Phase (degrees) of what acts, held until the next sample, behind what was sampled."""
    T = control_period_s(parameters_from(()))
    late = sent(periods, f, 30)[-1] / cmath.exp(2j * math.pi * f * T * 29)
    return math.degrees(cmath.phase(late)) - 180 * f * T


def delay_rows() -> tuple[Row, ...]:
    """What a period costs."""
    T = control_period_s(parameters_from(()))
    crossover = loops.margin(loops.sampled_current_loop((1,)), 300, 2000).crossover_hz
    return (
        shown("a control period", 1e6 * T, "µs"),
        Row(
            "default: from the sample to the middle of what acts, by its phase at 50 Hz",
            -lag(1, 50) / 360 / 50 * 1e6,
            1.5e6 * T,
            1e-6,
            "µs",
        ),
        Row(
            "phase that it costs at the current loop's crossover", -lag(1, crossover), 540 * crossover * T, 1e-6, "deg"
        ),
        shown("that a further period would cost there", 360 * crossover * T, "deg"),
        shown("that a period of measurement delay turns a current of 50 Hz by", 360 * 50 * T, "deg"),
    )


def delay_figure() -> Figure:
    """A signal and what acts; phases over the frequency."""
    T, f = control_period_s(parameters_from(())), 610.4
    n = np.arange(42)
    samples, stairs = np.exp(2j * math.pi * f * T * n).real, sent(1, f, 42).real
    us, first = 1e6 * T * n, slice(2, None)
    held = (
        curve("sampled", us[first], samples[first], dots=True),
        curve("what acts", np.repeat(us, 2)[5:], np.repeat(stairs, 2)[4:-1]),
    )
    hz, few = np.array([10.0, 5000.0]), np.linspace(100, 5000, 15)
    phases = []
    for k in (0, 1, 2):
        phases.append(curve(f"{k} period{'s' if k != 1 else ''}", hz, -360 * hz * (k + 0.5) * T))
        dots = np.degrees(np.unwrap(np.radians([lag(k, float(x)) for x in few])))
        phases.append(curve("" if k else "as it runs", few, dots, dots=True, like=2 * k))
    panels = (
        Axes(f"time (µs), signal of {f:g} Hz", "modulating signal", held),
        Axes("frequency (Hz)", "phase of what acts (degrees)", tuple(phases)),
    )
    return Figure(
        "hardware/figures/delays.svg", "What is computed from a sample acts a period later and is held", panels
    )


ROWS: dict[str, Callable[[], tuple[Row, ...]]] = {"sensors": sensor_rows, "delays": delay_rows}
FIGURES: tuple[Callable[[], Figure], ...] = (sensor_figure, delay_figure)
