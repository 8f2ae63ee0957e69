"""Active and reactive power during a sag and after it."""

from pydantic import Field

from pvlvrt_compliance.data.marks import Fraction, Frozen, NotNegative, Positive
from pvlvrt_compliance.profile.requirements.base import Requirement
from pvlvrt_compliance.profile.tables import RecoveryTable


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


class ReturnToPrefault(Requirement):
    """Active and reactive power at the end of the record are those before the sag."""

    kinds = ("return_to_prefault",)

    active_fraction: Positive = Field(description="of rated power")
    reactive_fraction: Positive = Field(description="of rated power")


class OverfrequencyPower(Requirement):
    """Active power falls in proportion to the frequency above a threshold (LFSM-O)."""

    kinds = ("overfrequency_power",)

    threshold_hz: Positive
    droop_fraction: Positive = Field(description="of nominal frequency, for the whole of the active power before")
    activation_s: Positive = Field(description="from crossing the threshold; P must follow from then on")
    tolerance_fraction: Positive = Field(description="of rated power")
