"""Parameters of the control subsystem, in words with units; `simulation.parameters` joins all."""

from typing import Literal, Self

from pydantic import Field, model_validator

from pvlvrt_compliance.parameter_group import NotNegative, ParameterGroup, Positive

Precision = Literal["double", "single"]
PowerStrategy = Literal["constant-p-q", "constant-p-light-q", "constant-p-sinusoidal", "constant-q", "balanced"]
SynchronisationName = Literal["msogi-fll", "dsogi-fll", "srf-pll", "ddsrf-pll", "dsc-pll"]


class ControllerParameters(ParameterGroup):
    """The control subsystem (Table 3); what the paper leaves open is said so."""

    synchronisation: SynchronisationName = "msogi-fll"
    sogi_gain: Positive = Field(default=2**0.5, description="K")
    fll_gain: NotNegative = Field(default=50.0, description="Gamma (1/s)")
    fll_frequency_min_hz: Positive = Field(default=40.0, description="guard of every synchronisation, not in the paper")
    fll_frequency_max_hz: Positive = Field(default=70.0, description="guard of every synchronisation, not in the paper")
    pll_bandwidth_hz: Positive = Field(default=10.0, description="natural frequency of a PLL; not in the paper")
    pll_damping: Positive = Field(default=2**-0.5, description="damping of a PLL; not in the paper")
    pnsd_notch_damping: Positive = Field(
        default=2**-0.5, description="damping of the srf-pll's notch at twice the frequency; not in the paper"
    )
    ddsrf_filter_ratio: Positive = Field(
        default=2**-0.5, description="cut-off of the ddsrf-pll's filters by the grid's frequency; not in the paper"
    )
    fault_threshold_pu: Positive = Field(default=0.85, description="a fault is flagged below it")
    reactive_plateau_voltage_pu: NotNegative = Field(default=0.5, description="eq (9): full reactive power below it")
    reactive_plateau_pu: NotNegative = Field(default=0.75, description="eq (9): full reactive power")
    power_strategy: PowerStrategy = "constant-p-sinusoidal"
    sequence_difference_min_pu: Positive = Field(
        default=0.005, description="below this V+ - V- the current reference is zero; guard, not in the paper"
    )
    dc_proportional_gain_w_per_v: NotNegative = 3977.5
    dc_integral_gain_w_per_vs: NotNegative = 152110.0
    pr_proportional_gain: NotNegative = Field(default=0.0011, description="1/A")
    pr_integral_gain: NotNegative = Field(default=0.1, description="1/A at resonance")
    pr_cutoff_rad_s: Positive = Field(default=1.0, description="w_c of every resonator")
    hc5_integral_gain: NotNegative = Field(default=0.1, description="1/A at resonance; not in the paper")
    hc7_integral_gain: NotNegative = Field(default=0.1, description="1/A at resonance; not in the paper")
    hc11_integral_gain: NotNegative = Field(default=0.1, description="1/A at resonance; not in the paper")
    hc13_integral_gain: NotNegative = Field(default=0.1, description="1/A at resonance; not in the paper")
    resonator_lead_samples: int = Field(default=2, ge=0, le=20, description="delay compensation; not in the paper")
    mppt_period_s: Positive = Field(default=0.04, description="between two perturbations; not in the paper")
    mppt_step_v: NotNegative = Field(default=0.5, description="size of a perturbation; not in the paper")
    mppt_voltage_min_v: NotNegative = Field(default=600.0, description="lower limit of v*_DC; not in the paper")
    mppt_voltage_max_v: Positive = Field(default=1000.0, description="upper limit of v*_DC; not in the paper")
    precision: Precision = Field(default="double", description="of the controller's arithmetic: 64 or 32 bits")
    computation_delay_samples: int = Field(
        default=1, ge=0, le=20, description="from a sample to the period in which its modulating signal acts"
    )
    grid_voltage_feedforward: bool = Field(default=False, description="the paper names none")

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        for low, high in (
            ("fll_frequency_min_hz", "fll_frequency_max_hz"),
            ("reactive_plateau_voltage_pu", "fault_threshold_pu"),
            ("mppt_voltage_min_v", "mppt_voltage_max_v"),
        ):
            if getattr(self, low) >= getattr(self, high):
                raise ValueError(f"{low} must be below {high}")
        return self
