"""Parameters of what lies between plant and controller, in words with units; `simulation.parameters` joins all."""

from pydantic import Field, FiniteFloat

from pvlvrt_compliance.parameter_group import Gain, Offset, ParameterGroup, PhaseGains, PhaseOffsets


class SensorParameters(ParameterGroup):
    """What lies between the plant and the controller's numbers; the defaults are ideal."""

    adc_bits: int = Field(default=0, ge=0, le=24, description="resolution over the range; 0: none, and no range")
    voltage_range_v: FiniteFloat = Field(default=600.0, ge=0.001, le=1e7, description="grid voltages, both signs")
    current_range_a: FiniteFloat = Field(default=3000.0, ge=0.001, le=1e7, description="phase currents, both signs")
    dc_voltage_range_v: FiniteFloat = Field(default=1500.0, ge=0.001, le=1e7, description="from 0")
    pv_current_range_a: FiniteFloat = Field(default=1000.0, ge=0.001, le=1e7, description="from 0")
    voltage_gain: PhaseGains = (1.0, 1.0, 1.0)
    current_gain: PhaseGains = (1.0, 1.0, 1.0)
    dc_voltage_gain: Gain = 1.0
    pv_current_gain: Gain = 1.0
    voltage_offset_v: PhaseOffsets = (0.0, 0.0, 0.0)
    current_offset_a: PhaseOffsets = (0.0, 0.0, 0.0)
    dc_voltage_offset_v: Offset = 0.0
    pv_current_offset_a: Offset = 0.0
    voltage_noise_v: FiniteFloat = Field(default=0.0, ge=0, le=1e5, description="standard deviation")
    current_noise_a: FiniteFloat = Field(default=0.0, ge=0, le=1e5)
    dc_voltage_noise_v: FiniteFloat = Field(default=0.0, ge=0, le=1e5)
    pv_current_noise_a: FiniteFloat = Field(default=0.0, ge=0, le=1e5)
    noise_seed: int = Field(default=0, ge=0, le=2**63 - 1, description="the same seed gives the same noise")
    measurement_delay_samples: int = Field(default=0, ge=0, le=20)
