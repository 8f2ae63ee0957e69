"""What the grid did in a record, as plain data: all that judges, draws or tells takes it from here and nowhere else."""

import math
from bisect import bisect_left, bisect_right
from collections.abc import Mapping
from functools import cached_property
from itertools import pairwise
from typing import Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from pvlvrt_compliance.texts import Name, Text

Moved = Literal["voltage", "angle", "frequency", "strength", "irradiance", "harmonics", "recording"]
"""What can move at a step."""

Kind = Literal["normal", "sag", "swell"]
"""What a stretch is by its voltage."""


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore")


class NormalVoltage(_Frozen):
    """Voltages of normal operation (pu): what lies beyond is a sag or a swell."""

    low_pu: FiniteFloat
    high_pu: FiniteFloat
    negative_pu: FiniteFloat

    def is_left_by(self, positive_pu: Any, negative_pu: Any) -> Any:
        """Whether V+ and V- are not those of normal operation, or not balanced: numbers, or arrays of one shape."""
        return (positive_pu < self.low_pu) | (positive_pu > self.high_pu) | (negative_pu > self.negative_pu)

    def holds(self, voltage: "Voltage") -> bool:
        """Whether a voltage is normal and balanced."""
        return not self.is_left_by(voltage.positive_pu, voltage.negative_pu)


class Voltage(_Frozen):
    """Amplitudes of the symmetrical components of the voltage without the inverter's current (pu)."""

    positive_pu: FiniteFloat
    negative_pu: FiniteFloat
    zero_pu: FiniteFloat


def kind_of(normal: NormalVoltage, first: Voltage, last: Voltage | None = None) -> Kind:
    """What a stretch is by its voltage; one that moves in it is what it begins as, or else what it comes to."""
    beyond = [voltage for voltage in (first, last) if voltage is not None and not normal.holds(voltage)]
    if not beyond:
        return "normal"
    return "swell" if beyond[0].positive_pu > normal.high_pu else "sag"


class Step(_Frozen):
    """An instant at which something jumps, or begins or ends to move."""

    at_s: FiniteFloat = Field(description="from the start of the record")
    moved: tuple[Moved, ...]


class Jump(_Frozen):
    """A jump of the angle of the voltage (deg, ahead is positive)."""

    at_s: FiniteFloat
    positive_deg: FiniteFloat = Field(description="of the positive sequence")
    phase_deg: FiniteFloat = Field(description="of the phase that jumps the furthest")


class Stretch(_Frozen):
    """What holds from one step to the next."""

    begin_s: FiniteFloat
    end_s: FiniteFloat
    kind: Kind
    voltage: Voltage = Field(description="at the beginning")
    voltage_at_end: Voltage | None = Field(
        default=None, description="where it moves along a straight line; none: holds"
    )
    frequency_hz: FiniteFloat | None = Field(default=None, description="at the beginning; none: not known")
    rocof_hz_s: FiniteFloat = 0.0
    irradiance_w_m2: FiniteFloat | None = Field(default=None, description="at the beginning; none: not known")
    ramps: tuple[Moved, ...] = Field(default=(), description="what moves all along it: means are of no one level")
    in_words: Text = ""

    def voltage_at(self, t_s: float) -> Voltage:
        """Voltage at an instant of the stretch (s, from the start of the record)."""
        last = self.voltage_at_end
        if last is None or self.end_s <= self.begin_s:
            return self.voltage
        share = (t_s - self.begin_s) / (self.end_s - self.begin_s)
        first = self.voltage
        return Voltage(
            positive_pu=first.positive_pu + share * (last.positive_pu - first.positive_pu),
            negative_pu=first.negative_pu + share * (last.negative_pu - first.negative_pu),
            zero_pu=first.zero_pu + share * (last.zero_pu - first.zero_pu),
        )

    def cut(self, begin_s: float, end_s: float) -> "Stretch":
        """The part of the stretch between two instants (s); beyond its end it goes on as it ended."""
        if (begin_s, end_s) == (self.begin_s, self.end_s):
            return self
        last = None if self.voltage_at_end is None else self.voltage_at(min(end_s, self.end_s))
        moved = {"voltage": self.voltage_at(begin_s), "voltage_at_end": last} if last is not None else {}
        return self.model_copy(update={"begin_s": begin_s, "end_s": end_s, **moved})


class Fact(_Frozen):
    """One thing that is known of a test, for people."""

    name: Name
    text: Text


class Disturbance(_Frozen):
    """What the grid did in one record. Times are in s from the start of the record.

    The times of a code count from ``start_s``. ``clear_s`` is the end of the first sag (of a test without one, of the
    time that it gives to what happens), ``end_s`` the instant from which the voltage moves no more.
    """

    start_s: FiniteFloat = Field(description="first departure, what times count from")
    clear_s: FiniteFloat = Field(description="end of the first sag")
    end_s: FiniteFloat = Field(description="last return")
    record_end_s: FiniteFloat | None = Field(default=None, description="end that the record was asked to have")
    origin: Literal["asked", "found"] = Field(default="asked", description="made from a scenario, or from the record")
    normal: NormalVoltage
    steps: tuple[Step, ...] = ()
    jumps: tuple[Jump, ...] = ()
    stretches: tuple[Stretch, ...] = Field(min_length=1)
    frequency_moves: bool = Field(default=False, description="steps, ramps, or what a recording holds")
    irradiance_w_m2: tuple[FiniteFloat, FiniteFloat] | None = Field(default=None, description="first and last")
    in_words: Text = ""
    facts: tuple[Fact, ...] = ()

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """The same with other fields; what has been made of the old ones is made anew."""
        copied = super().model_copy(update=update, deep=deep)
        for name in [name for name in vars(copied) if name not in type(self).model_fields]:
            del copied.__dict__[name]
        return copied

    @property
    def duration_s(self) -> float:
        """Length of the first sag (s)."""
        return self.clear_s - self.start_s

    def steps_of(self, *moved: Moved) -> tuple[float, ...]:
        """Instants at which any of these moves (s), in order of time."""
        return tuple(step.at_s for step in self.steps if not set(moved).isdisjoint(step.moved))

    def has_step_at(self, at_s: float) -> bool:
        """Whether anything steps at an instant (s)."""
        return at_s in self._steps_s

    @cached_property
    def _steps_s(self) -> frozenset[float]:
        return frozenset(step.at_s for step in self.steps)

    @cached_property
    def voltage_steps_s(self) -> tuple[float, ...]:
        """Instants at which the voltage jumps, or begins or ends to move (s)."""
        return self.steps_of("voltage")

    @cached_property
    def angle_steps_s(self) -> tuple[float, ...]:
        """Instants at which an angle of the voltage is meant to jump (s)."""
        return self.steps_of("angle")

    def jump_at(self, at_s: float) -> Jump:
        """The jump of the angle at a step of it (s); raises KeyError where there is none."""
        return self._jump_at[at_s]

    @cached_property
    def _jump_at(self) -> dict[float, Jump]:
        return {jump.at_s: jump for jump in self.jumps}

    def stretch_at(self, t_s: float) -> Stretch:
        """The stretch that an instant lies in, its beginning included; before the first, the first."""
        return self.stretches[max(bisect_right(self._begins_s, t_s) - 1, 0)]

    @cached_property
    def _begins_s(self) -> list[float]:
        """When each stretch begins (s)."""
        return [part.begin_s for part in self.stretches]

    def no_load(self, t_s: float) -> Voltage:
        """Voltage without the inverter's current at an instant."""
        return self.stretch_at(t_s).voltage_at(t_s)

    def is_normal(self, t_s: float) -> bool:
        """Whether the voltage at an instant is that of normal operation and balanced."""
        return self.normal.holds(self.no_load(t_s))

    def voltage_stretch(self, at_s: float) -> tuple[float | None, float | None]:
        """Steps of the voltage next to an instant (s), none where the record has no more."""
        steps_s = self.voltage_steps_s
        k = bisect_right(steps_s, at_s)
        return steps_s[k - 1] if k else None, steps_s[k] if k < len(steps_s) else None

    def voltage_stretches(self, end_s: float) -> tuple[Stretch, ...]:
        """What follows each step of the voltage up to the next, the last to the end of the record (s)."""
        return tuple(
            self.stretch_at(begin_s).model_copy(update={"end_s": until_s, "voltage_at_end": None})
            for begin_s, until_s in pairwise((*(t for t in self.voltage_steps_s if t < end_s), end_s))
        )

    def following_stretches(self, end_s: float, from_s: float = -math.inf) -> tuple[Stretch, ...]:
        """What follows each step of anything from the start of the test on, the last to the end of the record (s).

        Only what begins at ``from_s`` or later.
        """
        begins_s = self._following_s[bisect_left(self._following_s, from_s) : bisect_left(self._following_s, end_s)]
        return tuple(
            self.stretch_at(begin_s).cut(begin_s, until_s) for begin_s, until_s in pairwise((*begins_s, end_s))
        )

    @cached_property
    def _following_s(self) -> list[float]:
        """The start of the test, and each step of anything after it (s)."""
        return sorted({self.start_s, *(step.at_s for step in self.steps if step.at_s > self.start_s)})

    def is_frequency_steady(self, begin_s: float, end_s: float) -> bool:
        """Whether the frequency stays the same from one instant to another."""
        first = max(bisect_right(self._begins_s, begin_s) - 1, 0)
        near = self.stretches[first : bisect_right(self._begins_s, end_s)]
        seen = [part for part in near if part.end_s > begin_s]
        return len({part.frequency_hz for part in seen}) == 1 and not any(part.rocof_hz_s for part in seen)

    @property
    def leaves_voltage_alone(self) -> bool:
        """Whether frequency or angle move and the voltage does not."""
        return not self.voltage_steps_s and bool(self.steps_of("frequency", "angle"))
