"""Parameters of what lies between plant and controller, in words with units; `simulation.parameters` joins all."""

from pydantic import Field, FiniteFloat

from pvlvrt_compliance.parameter_group import NotNegative, ParameterGroup, PhaseValues, Positive


class SensorParameters(ParameterGroup):
    """What lies between the plant and the controller's numbers; the defaults are ideal."""

    adc_bits: int = Field(default=0, ge=0, le=24, description="resolution over the range; 0: none, and no range")
    voltage_range_v: Positive = Field(default=600.0, description="grid voltages, both signs")
    current_range_a: Positive = Field(default=3000.0, description="phase currents, both signs")
    dc_voltage_range_v: Positive = Field(default=1500.0, description="from 0")
    pv_current_range_a: Positive = Field(default=1000.0, description="from 0")
    voltage_gain: PhaseValues = (1.0, 1.0, 1.0)
    current_gain: PhaseValues = (1.0, 1.0, 1.0)
    dc_voltage_gain: FiniteFloat = 1.0
    pv_current_gain: FiniteFloat = 1.0
    voltage_offset_v: PhaseValues = (0.0, 0.0, 0.0)
    current_offset_a: PhaseValues = (0.0, 0.0, 0.0)
    dc_voltage_offset_v: FiniteFloat = 0.0
    pv_current_offset_a: FiniteFloat = 0.0
    voltage_noise_v: NotNegative = Field(default=0.0, description="standard deviation")
    current_noise_a: NotNegative = 0.0
    dc_voltage_noise_v: NotNegative = 0.0
    pv_current_noise_a: NotNegative = 0.0
    noise_seed: int = Field(default=0, ge=0, description="the same seed gives the same noise")
    measurement_delay_samples: int = Field(default=0, ge=0, le=20)
