"""The hardware around the controller, from parameters. Belongs to `translate.py`."""

import math

import numpy as np
from numpy.typing import NDArray

from pvlvrt_compliance.control.parameters import ControllerParameters
from pvlvrt_compliance.hardware.delays import DelayLines, DelayParams, filled
from pvlvrt_compliance.hardware.hardware import Hardware
from pvlvrt_compliance.hardware.parameters import SensorParameters
from pvlvrt_compliance.hardware.sensors import CHANNELS, SensorParams
from pvlvrt_compliance.measured import Measured
from pvlvrt_compliance.parameter_group import PhaseValues
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import Start


def per_channel(u: PhaseValues | float, i: PhaseValues | float, v_dc: float, i_pv: float) -> NDArray[np.float64]:
    """Numbers of `CHANNELS`, in their order; of voltages and currents one a phase, or one for all three."""
    phases = {"u": u if isinstance(u, tuple) else (u,) * 3, "i": i if isinstance(i, tuple) else (i,) * 3}
    named = {f"{name}_{phase}": x for name, of in phases.items() for phase, x in zip("abc", of, strict=True)}
    named |= {"v_dc": v_dc, "i_pv": i_pv}
    return np.array([named[channel] for channel in CHANNELS], dtype=np.float64)


_MOST_NOISE = 2**20  # samples of sensor noise (43 s of control periods), after which it begins anew


def sensor_params(s: SensorParameters) -> SensorParams:
    """Parameters of the sensors, channel by channel."""
    u, i = s.voltage_range_v, s.current_range_a
    low, high = per_channel(-u, -i, 0.0, 0.0), per_channel(u, i, s.dc_voltage_range_v, s.pv_current_range_a)
    step = (high - low) / 2**s.adc_bits
    converts = s.adc_bits > 0
    return SensorParams(
        gain=per_channel(s.voltage_gain, s.current_gain, s.dc_voltage_gain, s.pv_current_gain),
        offset=per_channel(s.voltage_offset_v, s.current_offset_a, s.dc_voltage_offset_v, s.pv_current_offset_a),
        noise=per_channel(s.voltage_noise_v, s.current_noise_a, s.dc_voltage_noise_v, s.pv_current_noise_a),
        step=step if converts else 0 * step,
        low=low if converts else np.full(len(CHANNELS), -math.inf),
        high=high - step if converts else np.full(len(CHANNELS), math.inf),
    )


def delay_lines_of(parameters: Parameters, start: Start) -> DelayLines:
    """What is under way around the controller in the steady state of the start."""
    at_start = Measured(u_g_ab=start.u_g_ab, i_ab=start.plant.i, v_dc=start.plant.v_dc, i_pv=start.plant.i_pv)
    periods = DelayParams(
        measurement=parameters.sensors.measurement_delay_samples,
        computation=parameters.controller.computation_delay_samples,
    )
    return filled(periods, at_start, start.m)


def hardware_of(parameters: Parameters, start: Start, periods: int) -> Hardware | None:
    """Hardware of a run over so many control periods, in the steady state of its start; none where it is ideal."""
    s, delay = parameters.sensors, parameters.controller.computation_delay_samples
    default = ControllerParameters.model_fields["computation_delay_samples"].default
    if s == SensorParameters() and delay == default:
        return None
    sensors = sensor_params(s)
    rows = min(periods, _MOST_NOISE) if sensors.noise.any() else 1
    return Hardware(
        sensors=sensors,
        lines=delay_lines_of(parameters, start),
        random=np.random.default_rng(s.noise_seed).standard_normal((rows, len(CHANNELS))),
    )
