"""The hardware around the controller, from parameters. Belongs to `translate.py`."""

import math

import numpy as np

from pvlvrt_compliance.control.controller import Measured
from pvlvrt_compliance.control.delays import DelayLines, DelayParams, filled
from pvlvrt_compliance.control.hardware import Hardware
from pvlvrt_compliance.control.sensors import CHANNELS, SensorParams
from pvlvrt_compliance.scenario.parameters import ControllerParameters, Parameters, SensorParameters
from pvlvrt_compliance.simulation.translate import Start


def sensor_params(s: SensorParameters) -> SensorParams:
    """Parameters of the sensors, channel by channel."""
    ac = np.array([s.voltage_range_v] * 3 + [s.current_range_a] * 3)
    dc = np.array([s.dc_voltage_range_v, s.pv_current_range_a])
    low, high = np.concatenate([-ac, 0 * dc]), np.concatenate([ac, dc])
    step = (high - low) / 2**s.adc_bits
    converts = s.adc_bits > 0
    return SensorParams(
        gain=np.array([*s.voltage_gain, *s.current_gain, s.dc_voltage_gain, s.pv_current_gain]),
        offset=np.array([*s.voltage_offset_v, *s.current_offset_a, s.dc_voltage_offset_v, s.pv_current_offset_a]),
        noise=np.array(
            [s.voltage_noise_v] * 3 + [s.current_noise_a] * 3 + [s.dc_voltage_noise_v, s.pv_current_noise_a]
        ),
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
    rows = periods if sensors.noise.any() else 1
    return Hardware(
        sensors=sensors,
        lines=delay_lines_of(parameters, start),
        random=np.random.default_rng(s.noise_seed).standard_normal((rows, len(CHANNELS))),
    )
