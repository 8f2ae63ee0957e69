"""Every parameter of plant, protection, controller and simulation, in words with units: what `--set` reaches."""

import json
import math
from collections.abc import Iterable
from itertools import pairwise
from typing import Annotated, Any, Literal, Self, get_origin

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, ValidationError, model_validator

from pvlvrt_compliance.errors import UsageError, did_you_mean

Positive = Annotated[FiniteFloat, Field(gt=0)]
NotNegative = Annotated[FiniteFloat, Field(ge=0)]
PhaseValues = tuple[FiniteFloat, FiniteFloat, FiniteFloat]

Precision = Literal["double", "single"]
Fidelity = Literal["averaged", "switched"]
PowerStrategy = Literal["constant-p-q", "constant-p-light-q", "constant-p-sinusoidal", "constant-q", "balanced"]
SynchronisationName = Literal["msogi-fll", "dsogi-fll", "srf-pll", "ddsrf-pll", "dsc-pll"]


class _Group(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class SimulationParameters(_Group):
    """How closely the inverter is modelled, the two rates, and the unrecorded time before a record."""

    fidelity: Fidelity = Field(
        default="averaged", description="the mean over a carrier period, or every leg as it switches"
    )
    plant_step_us: Positive = 5.1196
    control_ratio: int = Field(default=8, ge=1, le=1000, description="plant steps in a control period")
    settling_s: Annotated[FiniteFloat, Field(ge=0, le=60)] = Field(
        default=0.5, description="before a record, not judged; with a controller of the user's own 1 s unless set"
    )
    record_settling: bool = Field(
        default=False,
        description="write the settling into the waveforms, too, at times below 0; what is judged stays the same",
    )
    synchronising_s: Annotated[FiniteFloat, Field(ge=0, le=60)] = Field(
        default=0.2,
        description="before settling: a controller of the user's own sees the steady state, and does not act yet",
    )
    time_limit_s: Positive | None = Field(
        default=None,
        description="of computing, for one run of a user's own controller; none: 60 s and 20 times the run's length",
    )


class PlantParameters(_Group):
    """The power subsystem (Tables 1 and 2)."""

    apparent_power_kva: Positive = 500.0
    phase_voltage_v: Positive = 230.0
    dc_link_capacitance_f: Positive = 0.065
    filter_inductance_h: Positive = 0.15e-3
    filter_resistance_ohm: NotNegative = 1e-3
    dead_time_us: Annotated[FiniteFloat, Field(ge=0, le=10)] = Field(
        default=0.5, description="of the switched inverter; usual for SiC, not in the paper"
    )
    device_drop_v: NotNegative = Field(
        default=0.22, description="of the switched inverter: each conducting device at no current; not in the paper"
    )
    device_resistance_ohm: NotNegative = Field(
        default=0.5e-3, description="of the switched inverter: each conducting device; not in the paper"
    )
    switching_energy_mj: NotNegative = Field(
        default=24.76,
        description="of the switched inverter: a leg's turn-on and turn-off at 800 V and 1000 A. With the two above"
        " 2436 W at nominal, the paper's figure; its shares are not in the paper",
    )
    modules_in_series: int = Field(default=22, ge=1, le=1000)
    strings_in_parallel: int = Field(default=72, ge=1, le=100000)
    breaker_opening_s: NotNegative = Field(
        default=0.05, description="a tripped breaker parts once the current has ended, at the latest after this"
    )


class ProtectionParameters(_Group):
    """Relays of the plant. Never taken from the profile under test."""

    overcurrent_pu: Positive = 2.0
    dc_overvoltage_v: Positive = 1100.0
    undervoltage_curve: tuple[tuple[NotNegative, NotNegative], ...] = Field(
        default=((0.0, 0.0), (0.15, 0.0), (1.5, 0.85)), min_length=1, description="points (s, pu of positive sequence)"
    )
    undervoltage_delay_s: NotNegative = 0.05
    frequency_min_hz: Positive | None = Field(default=None, description="none: 5 Hz below nominal")
    frequency_max_hz: Positive | None = Field(default=None, description="none: 5 Hz above nominal")
    frequency_delay_s: NotNegative = 0.2

    @model_validator(mode="after")
    def _times_increase(self) -> Self:
        times = [t for t, _ in self.undervoltage_curve]
        if any(b <= a for a, b in pairwise(times)):
            raise ValueError("the times of undervoltage_curve must increase")
        return self


class ControllerParameters(_Group):
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


class SensorParameters(_Group):
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


class Parameters(_Group):
    """All parameters of a run but its scenario."""

    simulation: SimulationParameters = SimulationParameters()
    plant: PlantParameters = PlantParameters()
    protection: ProtectionParameters = ProtectionParameters()
    sensors: SensorParameters = SensorParameters()
    controller: ControllerParameters = ControllerParameters()


def parameter_names() -> list[str]:
    """All names that `--set` takes, as ``group.name``."""
    return [
        f"{group}.{name}"
        for group, field in Parameters.model_fields.items()
        for name in field.annotation.model_fields  # type: ignore[union-attr]
    ]


def parameters_from(assignments: Iterable[str]) -> Parameters:
    """Defaults with ``group.name=value`` applied; values are written as in JSON, words also without quotes.

    Raises
    ------
    UsageError
        When a name is unknown (with the near misses), given twice, or a value is not allowed.
    """
    known = parameter_names()
    groups: dict[str, dict[str, Any]] = {}
    for assignment in assignments:
        name, equals, text = assignment.partition("=")
        name = name.strip()
        if not equals:
            raise UsageError(f"--set {assignment}: write --set group.name=value")
        if name not in known:
            raise UsageError(f"--set {name}: unknown parameter{did_you_mean(name, known)}")
        group, _, key = name.partition(".")
        if key in groups.setdefault(group, {}):
            raise UsageError(f"--set {name}: given twice")
        groups[group][key] = _value(name, text)
    try:
        # As JSON and strict: a list is a tuple there, but neither true nor "1.2" is a number.
        return Parameters.model_validate_json(json.dumps(groups), strict=True)
    except ValidationError as error:
        raise UsageError("; ".join(_problem(e["loc"], e["msg"]) for e in error.errors())) from None


OF_THE_HOST = frozenset({"computation_delay_samples"})
"""Names in the group ``controller`` that say how any controller is run, also one of the user's own."""


def own_parameters(assignments: Iterable[str]) -> tuple[dict[str, float | int | bool | str], tuple[str, ...]]:
    """Split ``controller.NAME=value``, the parameters of a user's own controller, from the assignments that are not.

    Returns
    -------
    tuple of dict and tuple
        Values by name, a word where it is not JSON; the other assignments as they are.

    Raises
    ------
    UsageError
        When a name is given twice, or a value is not a number, a word or a switch.
    """
    own: dict[str, float | int | bool | str] = {}
    others = []
    for assignment in assignments:
        name, equals, text = assignment.partition("=")
        group, _, key = name.strip().partition(".")
        if not equals or group != "controller" or key in OF_THE_HOST:
            others.append(assignment)
            continue
        if key in own:
            raise UsageError(f"--set {name}: given twice")
        own[key] = _plain_value(name, text)
    return own, tuple(others)


def _plain_value(name: str, text: str) -> float | int | bool | str:
    try:
        value = json.loads(text, parse_constant=_refuse)
    except (ValueError, RecursionError):
        value = text.strip()
    if isinstance(value, float) and not math.isfinite(value):
        raise UsageError(f"--set {name}: {text} is not a number that can be used")
    if not isinstance(value, (bool, int, float, str)):
        raise UsageError(f"--set {name}: {text!r} is not a number, true, false or a word")
    return value


def _takes_words(name: str) -> bool:
    group, _, key = name.partition(".")
    annotation: Any = Parameters.model_fields[group].annotation
    return get_origin(annotation.model_fields[key].annotation) is Literal


def _value(name: str, text: str) -> Any:
    try:
        return json.loads(text, parse_constant=_refuse)
    except (ValueError, RecursionError):
        if _takes_words(name):
            return text.strip()
        raise UsageError(f"--set {name}: {text!r} is not a value; write a number, true, false, null or [..]") from None


def _refuse(constant: str) -> None:
    raise ValueError(f"{constant} is not a number that can be used")


def _problem(location: tuple[int | str, ...], message: str) -> str:
    return f"--set {'.'.join(str(part) for part in location)}: {message.removeprefix('Value error, ')}"
