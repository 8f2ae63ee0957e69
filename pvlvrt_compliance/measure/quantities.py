"""The quantities that every record is measured for, as `results.json` spells them."""

from typing import Any

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, SerializerFunctionWrapHandler, model_serializer

from pvlvrt_compliance.texts import Name, Text


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore")


class WindowMeasurements(_Frozen):
    """What is measured in one window of a record. None where a quantity cannot be had (no current, no DC channel)."""

    start_s: FiniteFloat
    end_s: FiniteFloat
    voltage_positive_pu: FiniteFloat | None = None
    voltage_negative_pu: FiniteFloat | None = None
    active_power_kw: FiniteFloat | None = None
    reactive_power_kvar: FiniteFloat | None = None
    active_power_2f_kw: FiniteFloat | None = None
    current_phase_pu: tuple[FiniteFloat, FiniteFloat, FiniteFloat] | None = None
    current_peak_pu: FiniteFloat | None = None
    dc_voltage_mean_v: FiniteFloat | None = None
    dc_voltage_2f_percent: FiniteFloat | None = None
    current_thd_percent: FiniteFloat | None = None
    frequency_hz: FiniteFloat | None = None


class ControllerBeliefs(_Frozen):
    """What the controller believed and asked for, mean over the window `during`."""

    v_fault_pu: FiniteFloat | None = None
    q_ref_kvar: FiniteFloat | None = None
    p_ref_kw: FiniteFloat | None = None


class MeasuredStretch(_Frozen):
    """What is measured between two steps of the voltage."""

    begin_s: FiniteFloat
    end_s: FiniteFloat
    in_words: Text = ""
    window: WindowMeasurements | None = Field(default=None, description="none: too short for a settled cycle")


class Cursor(_Frozen):
    """What one quantity does between two steps of what the grid does; None where it cannot be had.

    Extremes and mean are of the settled series, times (s) count from the step that the stretch begins with, of the
    change from ``initial`` to ``final``.
    """

    quantity: Name = Field(description="voltage_positive_pu and its like, as limits of figures name them")
    minimum: FiniteFloat
    maximum: FiniteFloat
    mean: FiniteFloat
    initial: FiniteFloat | None = Field(default=None, description="mean of the last cycle before the step")
    final: FiniteFloat | None = Field(default=None, description="mean of the last part of the stretch")
    reaction_s: FiniteFloat | None = Field(default=None, description="to 10 % of the change")
    rise_s: FiniteFloat | None = Field(default=None, description="10 % to 90 % of the change")
    response_s: FiniteFloat | None = Field(default=None, description="to 90 % of the change")
    settling_s: FiniteFloat | None = Field(default=None, description="to the last entry into the tolerance band")
    overshoot_percent: FiniteFloat | None = Field(default=None, description="beyond the final value, of the change")

    @model_serializer(mode="wrap")
    def _leave_out_absent(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        return {name: value for name, value in handler(self).items() if value is not None}


class CursorStretch(_Frozen):
    """The cursors of one stretch: of the window before the disturbance, or of what follows a step."""

    begin_s: FiniteFloat
    end_s: FiniteFloat
    is_before: bool = Field(default=False, description="the window before the disturbance, in which nothing is timed")
    in_words: Text = ""
    band_percent: FiniteFloat | None = Field(
        default=None, description="of the change, on both sides of the final value: what the settling time is of"
    )
    cursors: tuple[Cursor, ...] = ()


class MeasuredWindows(_Frozen):
    """Measurements of one record by window; a window that the record does not hold is left out."""

    before: WindowMeasurements | None = None
    during: WindowMeasurements | None = None
    after: WindowMeasurements | None = None
    controller: ControllerBeliefs | None = None
    stretches: tuple[MeasuredStretch, ...] | None = Field(
        default=None, description="of a record with further steps of the voltage than one sag's two"
    )

    @model_serializer(mode="wrap")
    def _leave_out_absent(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        return {name: value for name, value in handler(self).items() if value is not None}
