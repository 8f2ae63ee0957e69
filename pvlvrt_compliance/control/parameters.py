"""Parameters of the control subsystem, in words with units; `simulation.parameters` joins all."""

from typing import Literal, Self

from pydantic import Field, FiniteFloat, model_validator

from pvlvrt_compliance.parameter_group import ParameterGroup

Precision = Literal["double", "single"]
PowerStrategy = Literal["constant-p-q", "constant-p-light-q", "constant-p-sinusoidal", "constant-q", "balanced"]
SynchronisationName = Literal["msogi-fll", "dsogi-fll", "srf-pll", "ddsrf-pll", "dsc-pll"]


Hold = Literal["each", "once", "run"]


class ControllerParameters(ParameterGroup):
    """The control subsystem (Table 3); what the paper leaves open is said so."""

    synchronisation: SynchronisationName = "msogi-fll"
    sogi_gain: FiniteFloat = Field(default=2**0.5, ge=0.001, le=1000, description="K")
    fll_gain: FiniteFloat = Field(default=50.0, ge=0, le=1e5, description="Gamma (1/s)")
    fll_frequency_min_hz: FiniteFloat = Field(
        default=40.0, ge=1, le=1000, description="guard of every synchronisation, not in the paper"
    )
    fll_frequency_max_hz: FiniteFloat = Field(
        default=70.0, ge=1, le=1000, description="guard of every synchronisation, not in the paper"
    )
    pll_bandwidth_hz: FiniteFloat = Field(
        default=10.0, ge=0.01, le=1e4, description="natural frequency of a PLL; not in the paper"
    )
    pll_damping: FiniteFloat = Field(default=2**-0.5, ge=0.01, le=100, description="damping of a PLL; not in the paper")
    pnsd_notch_damping: FiniteFloat = Field(
        ge=0.01,
        le=100,
        default=2**-0.5,
        description="damping of the srf-pll's notch at twice the frequency; not in the paper",
    )
    ddsrf_filter_ratio: FiniteFloat = Field(
        ge=0.001,
        le=100,
        default=2**-0.5,
        description="cut-off of the ddsrf-pll's filters by the grid's frequency; not in the paper",
    )
    fault_threshold_pu: FiniteFloat = Field(default=0.85, ge=0.01, le=2, description="a fault is flagged below it")
    reactive_plateau_voltage_pu: FiniteFloat = Field(
        default=0.5, ge=0, le=2, description="eq (9): full reactive power below it"
    )
    reactive_plateau_pu: FiniteFloat = Field(default=0.75, ge=0, le=10, description="eq (9): full reactive power")
    power_strategy: PowerStrategy = "constant-p-sinusoidal"
    sequence_difference_min_pu: FiniteFloat = Field(
        ge=1e-6,
        le=1,
        default=0.005,
        description="below this V+ - V- the current reference is zero; guard, not in the paper",
    )
    dc_proportional_gain_w_per_v: FiniteFloat = Field(default=3977.5, ge=0, le=1e9)
    dc_integral_gain_w_per_vs: FiniteFloat = Field(default=152110.0, ge=0, le=1e9)
    pr_proportional_gain: FiniteFloat = Field(default=0.0011, ge=0, le=1e4, description="1/A")
    pr_integral_gain: FiniteFloat = Field(default=0.1, ge=0, le=1e4, description="1/A at resonance")
    pr_cutoff_rad_s: FiniteFloat = Field(default=1.0, ge=1e-6, le=1e5, description="w_c of every resonator")
    hc5_integral_gain: FiniteFloat = Field(default=0.1, ge=0, le=1e4, description="1/A at resonance; not in the paper")
    hc7_integral_gain: FiniteFloat = Field(default=0.1, ge=0, le=1e4, description="1/A at resonance; not in the paper")
    hc11_integral_gain: FiniteFloat = Field(default=0.1, ge=0, le=1e4, description="1/A at resonance; not in the paper")
    hc13_integral_gain: FiniteFloat = Field(default=0.1, ge=0, le=1e4, description="1/A at resonance; not in the paper")
    resonator_lead_samples: int = Field(default=2, ge=0, le=20, description="delay compensation; not in the paper")
    mppt_period_s: FiniteFloat = Field(
        default=0.04, ge=1e-5, le=3600, description="between two perturbations; not in the paper"
    )
    mppt_step_v: FiniteFloat = Field(default=0.5, ge=0, le=1000, description="size of a perturbation; not in the paper")
    mppt_voltage_min_v: FiniteFloat = Field(
        default=600.0, ge=0, le=1e5, description="lower limit of v*_DC; not in the paper"
    )
    mppt_voltage_max_v: FiniteFloat = Field(
        default=1000.0, ge=1, le=1e5, description="upper limit of v*_DC; not in the paper"
    )
    precision: Precision = Field(default="double", description="of the controller's arithmetic: 64 or 32 bits")
    hold: Hold = Field(
        default="each",
        description="how often a controller of your own is told that it does not act yet: before each call, once, or"
        " never (run); of a model, when its Initialize is called",
    )
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
