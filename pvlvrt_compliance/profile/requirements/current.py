"""Currents: how large they may be, and what they must do for the voltage during a sag."""

import math
from typing import Literal, Self

from pydantic import Field, model_validator

from pvlvrt_compliance.data.marks import Choice, Flag, Fraction, NotNegative, Numbers, Positive
from pvlvrt_compliance.profile.curves import RatioCurve, SupportCurve
from pvlvrt_compliance.profile.requirements.base import Requirement

DeadBandMode = Literal["none", "shift", "step"]
Reference = Literal["prefault", "nominal"]


class CurrentLimit(Requirement):
    """Fundamental phase currents, once settled, and the instantaneous peak, always.

    With ``stage_pu`` the fundamental has a limit on its way to the settled one, too.
    """

    kinds = ("current_limit",)

    limit_pu: Positive = Field(description="largest amplitude of a phase's fundamental, once settled")
    tolerance_pu: NotNegative = Field(description="on top of limit_pu")
    settling_s: NotNegative = Field(description="after each step of voltage, angle, frequency or strength of the grid")
    peak_pu: Positive = Field(description="largest instantaneous current, always")
    stage_pu: Positive | None = Field(default=None, description="limit of the fundamental before it is settled")
    stage_from_cycles: Positive | None = Field(default=None, description="after each step, up to settling_s")

    @model_validator(mode="after")
    def _stage_whole(self) -> Self:
        if (self.stage_pu is None) != (self.stage_from_cycles is None):
            raise ValueError("stage_pu and stage_from_cycles go together")
        if self.stage_from_cycles is not None and self.stage_from_cycles.value < 1:
            raise ValueError("stage_from_cycles: must be 1 at least: until then a cycle reaches back before the step")
        return self

    @property
    def allowed_pu(self) -> float:
        """Largest fundamental amplitude that passes (pu)."""
        return self.limit_pu.value + self.tolerance_pu.value


class ReactiveSupport(Requirement):
    """Mean reactive power during a sag against a curve over the voltage: Q of V."""

    kinds = ("reactive_support",)

    curve: SupportCurve
    clip_to_capability: Flag = Field(description="demand at most (V+ - V-) S")
    no_support_from_pu: Positive = Field(description="V+ at and above which no reactive power is wanted")
    tolerance_pu: NotNegative = Field(description="times V+ S")


class ReactiveCurrent(Requirement):
    """Additional reactive current of a sequence in proportion to the change of its voltage: delta i = K f(delta u).

    Positive are a fall of V+, a rise of V-, and the current that counters either. With the dead band d, f is delta u
    (``none``), what exceeds d (``shift``), or delta u once it exceeds d (``step``). Where the reactive currents of both
    sequences, with what flowed before, add up to more than ``limit_pu``, both are clipped in the same proportion. A
    test may set another K.
    """

    kinds = ("reactive_current", "negative_sequence_current")

    k: Positive = Field(description="additional current for each pu of voltage")
    k_range: Numbers | None = Field(default=None, description="lowest and highest K that the code lets be set")
    dead_band_pu: NotNegative = Field(description="change of voltage up to which nothing is due")
    dead_band_mode: Choice[DeadBandMode] = Field(description="how the dead band enters: none, shift or step")
    reference: Choice[Reference] = Field(description="what delta u counts from")
    tolerance_plus_pu: NotNegative = Field(description="more support than demanded")
    tolerance_minus_pu: NotNegative = Field(description="less support than demanded")
    limit_pu: Positive = Field(description="total current up to which support is demanded")
    blocking_allowed_below_pu: NotNegative = Field(description="V+ below which a blocked bridge is let off")


def beyond_dead_band(delta_u_pu: float, dead_band_pu: float, mode: DeadBandMode) -> float:
    """Return f(delta u) of the three readings of a dead band (pu)."""
    if mode == "none":
        return delta_u_pu
    exceeding = max(abs(delta_u_pu) - dead_band_pu, 0.0)
    if mode == "shift":
        return math.copysign(exceeding, delta_u_pu)
    return delta_u_pu if exceeding > 0 else 0.0


class SupportDynamics(Requirement):
    """How fast the additional reactive current of the positive sequence comes and settles.

    Activation: it has moved by ``activation_pu``. Response: it has come ``response_fraction`` of the way to what is
    due. Both from the first V+ beyond the thresholds of detection; without those, from the step of the voltage.
    Settling: from activation to the last entry into a band, from ``band_minus`` below what is due to ``band_plus``
    above the final value. Due is what reactive_current demands less what it forgives; in a profile without it, the
    final value.
    """

    kinds = ("support_dynamics",)

    activation_pu: Positive = Field(description="move of the current that shows that it has begun")
    activation_s: Positive = Field(description="longest time to that")
    response_fraction: Fraction = Field(description="of the way to what is due")
    response_s: Positive = Field(description="longest time to that")
    settling_s: Positive = Field(description="longest time from activation to staying in the band")
    band_plus: Positive = Field(description="fraction of the final value")
    band_minus: Positive = Field(description="fraction of what is due")
    least_change_pu: Positive = Field(description="a change that is due by less is not timed")


class ReactiveRatio(Requirement):
    """Share of the reactive current in the total current of the positive sequence, at least a curve over V+."""

    kinds = ("reactive_ratio",)

    curve: RatioCurve
    within_s: NotNegative = Field(description="from each step")
    tolerance: NotNegative = Field(description="taken from the share that is asked for")
    least_current_pu: Positive = Field(description="total current where a share is due, at most what flowed before")


class Toggling(Requirement):
    """Support that switches on and off at a threshold although the voltage stands still."""

    kinds = ("toggling",)

    on_pu: Positive = Field(description="reactive current above which support is on")
    off_pu: Positive = Field(description="reactive current below which it is off again")
    most_activations: Positive = Field(description="between two steps of the voltage")
    settling_s: NotNegative = Field(description="after each step of the voltage, not looked at")
