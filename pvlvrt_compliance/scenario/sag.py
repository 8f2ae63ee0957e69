"""Voltage sags by depth and phases, and their symmetrical components."""

from typing import Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from pvlvrt_compliance.space_vectors import ROTATION_120, SQRT3_2, Sequences, fortescue

Phases = Literal["abc", "a", "b", "c", "ab", "bc", "ca"]
PAIRS = ("ab", "bc", "ca")

# The healthy phases a, b, c are 1, a^2, a; the pair that an isolated two-phase sag pulls together leaves this one.
_HEALTHY_OF_PAIR = {"bc": 0, "ca": 1, "ab": 2}


class Sag(BaseModel):
    """A rectangular voltage sag at the terminals without the inverter's current.

    With ``two_phase`` false, the phase-to-neutral magnitudes of ``phases`` become ``1 - depth`` and the angles stay.
    With ``two_phase`` true, the line-to-line voltage of the pair ``phases`` becomes ``1 - depth`` and there is no
    zero sequence (an isolated two-phase fault).
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    depth: float = Field(ge=0, le=1, description="what is lost, 0 (no sag) to 1")
    phases: Phases = "abc"
    two_phase: bool = False

    @model_validator(mode="after")
    def _pair(self) -> Self:
        if self.two_phase and self.phases not in PAIRS:
            raise ValueError(f"a two-phase sag needs a pair of phases: ab, bc or ca, not {self.phases!r}")
        return self

    def phasors_pu(self) -> tuple[complex, complex, complex]:
        """Phase-to-neutral phasors a, b, c during the sag (pu), phase a at angle 0 when healthy."""
        residual = 1 - self.depth
        healthy = (complex(1), ROTATION_120.conjugate(), ROTATION_120)
        if not self.two_phase:
            a, b, c = (residual if name in self.phases else 1.0 for name in "abc")
            return a * healthy[0], b * healthy[1], c * healthy[2]
        first = _HEALTHY_OF_PAIR[self.phases]
        turn = healthy[first]
        phasors = [complex(0)] * 3
        phasors[first] = turn
        phasors[(first + 1) % 3] = turn * complex(-0.5, -SQRT3_2 * residual)
        phasors[(first + 2) % 3] = turn * complex(-0.5, +SQRT3_2 * residual)
        return phasors[0], phasors[1], phasors[2]

    def sequences_pu(self) -> Sequences:
        """Symmetrical components during the sag (pu)."""
        positive, negative, zero = fortescue(*self.phasors_pu())
        return Sequences(complex(positive), complex(negative), complex(zero))

    def describe(self) -> str:
        """Name the sag in words, for tables and reports."""
        if self.depth == 0:
            return "no sag"
        kind = {3: "three-phase", 2: "phases", 1: "phase"}[len(self.phases)]
        if self.two_phase:
            kind = "isolated two-phase"
        where = "" if self.phases == "abc" else f" {self.phases}"
        return f"{kind}{where}, {100 * self.depth:g} %"
