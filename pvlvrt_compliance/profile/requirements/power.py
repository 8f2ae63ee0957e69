"""Active and reactive power during a sag and after it."""

from typing import Self

from pydantic import Field, model_validator

from pvlvrt_compliance.data.marks import Fraction, Frozen, NotNegative, Positive
from pvlvrt_compliance.profile.requirements.base import Requirement
from pvlvrt_compliance.profile.tables import RecoveryTable


class ActivePowerSupport(Requirement):
    """Active power during a sag or a swell: what the reactive power leaves room for, eq (10), and can be had.

    The least of P = sqrt(S_fault^2 - Q^2) with S_fault = (V+ - V-) S, eq (8), and Q by ``reactive_support`` of the
    profile (none without it), where V+ and V- at the terminals are off by ``voltage_pu`` together; from its
    ``no_support_from_pu`` on S_fault. At most the power before and what the array gives.
    """

    kinds = ("active_power_support",)

    tolerance_fraction: NotNegative = Field(description="of rated power")
    voltage_pu: NotNegative = Field(
        description="by which V+ and V- together may be off: eq (10) is steep where Q = S_fault"
    )
    settling_s: NotNegative = Field(description="after each step of the grid, not looked at")


class ActivePowerRecovery(Requirement):
    """Active power after clearing, by the mean V+ of the sag; times count from the voltage's return."""

    kinds = ("active_power_recovery",)

    return_pu: Positive = Field(description="V+ at and above which the voltage has returned")
    first_fraction: Fraction = Field(description="of the active power before the sag, to be reached first")
    tolerance_fraction: NotNegative = Field(description="of rated power, around the final value")
    rows: RecoveryTable


class ConsumptionZones(Frozen):
    """Limits on what the inverter may take from the grid during a fault; what is left out is not limited.

    Zone A is the first ``transient_s`` of the fault, C as long after clearing, B the rest of the fault. Powers are
    means over one cycle within the zone, in fractions of rated power; energies are in seconds of rated power.
    """

    transient_s: Positive
    reactive_power_a: NotNegative | None = None
    reactive_energy_a_s: NotNegative | None = None
    active_power_b: NotNegative | None = None
    reactive_power_b: NotNegative | None = None
    active_energy_b_s: NotNegative | None = None
    reactive_energy_b_s: NotNegative | None = None
    reactive_energy_c_s: NotNegative | None = None
    reactive_current_c_pu: NotNegative | None = None


class Consumption(Requirement):
    """Active and reactive power taken from the grid, by zones of the fault."""

    kinds = ("consumption",)

    balanced: ConsumptionZones
    unbalanced: ConsumptionZones | None = Field(default=None, description="none: an unbalanced fault is not judged")
    unbalanced_from_pu: Positive = Field(description="V- from which a fault is unbalanced")


class ConstantPower(Requirement):
    """Ripple of the active power at twice the grid frequency during a sag."""

    kinds = ("constant_power",)

    limit_fraction: Positive = Field(description="amplitude, of rated power")


class Oscillation(Requirement):
    """Slow swings of P and of Q in a grid that stands still: half-cycle means, which leave 2f and 6f out.

    What only rises or only falls, as a recovery does, is no swing.
    """

    kinds = ("oscillation",)

    limit_fraction: Positive = Field(
        description="peak to peak of what goes to and fro, of rated power, a straight line taken away"
    )
    settling_s: NotNegative = Field(description="after each step of the grid, not looked at")
    array_settling_s: NotNegative = Field(description="the same after a step of the irradiance")
    least_cycles: Positive = Field(description="that a stretch must last from then on")


class ReturnToPrefault(Requirement):
    """Active and reactive power at the end of the record are those before the sag; what is left out is not judged."""

    kinds = ("return_to_prefault",)

    active_fraction: Positive | None = Field(default=None, description="of rated power")
    reactive_fraction: Positive | None = Field(default=None, description="of rated power")
    reactive_pu: Positive | None = Field(default=None, description="reactive power, times V+ S")

    @model_validator(mode="after")
    def _limits_something(self) -> Self:
        if self.active_fraction is None and self.reactive_fraction is None and self.reactive_pu is None:
            raise ValueError("active_fraction, reactive_fraction, reactive_pu: at least one must be given")
        return self


class OverfrequencyPower(Requirement):
    """Active power falls in proportion to the frequency above a threshold (LFSM-O)."""

    kinds = ("overfrequency_power",)

    threshold_hz: Positive = Field(description="frequency above which the power falls")
    droop_fraction: Positive = Field(description="of nominal frequency, for the whole of the active power before")
    activation_s: Positive = Field(description="from crossing the threshold; P must follow from then on")
    tolerance_fraction: Positive = Field(description="of rated power")
