"""Voltage sags by depth and phases, and their symmetrical components."""

import cmath
import math
from typing import Literal, Self, get_args

from pydantic import BaseModel, ConfigDict, Field, model_validator

from pvlvrt_compliance.space_vectors import ROTATION_120, SQRT3_2, Sequences, fortescue

Type = Literal["A", "B", "C", "D", "E", "F", "G"]
PhaseNames = Literal["abc", "a", "b", "c", "ab", "bc", "ca"]
PAIRS = ("ab", "bc", "ca")

# How else phases are called: L1 to L3 in IEC 60445 (here without their L), and in older and other texts.
_OTHER_NAMES = ("123", "rst", "uvw")

# The healthy phases a, b, c are 1, a^2, a; the pair that an isolated two-phase sag pulls together leaves this one.
_HEALTHY_OF_PAIR = {"bc": 0, "ca": 1, "ab": 2}


class Sag(BaseModel):
    """A rectangular voltage sag at the terminals without the inverter's current.

    With ``two_phase`` false, the phase-to-neutral magnitudes of ``phases`` become ``1 - depth`` and the angles stay, or
    turn by ``angle_deg`` (with depth 0: a jump of the angle of these phases alone).
    With ``type``, the sag is one of Bollen's types A to G with the characteristic voltage ``1 - depth``; ``phases``
    then names the symmetrical phase (a by default).
    With ``two_phase`` true, the line-to-line voltage of the pair ``phases`` becomes ``1 - depth`` and there is no
    zero sequence (an isolated two-phase fault).
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    depth: float = Field(ge=0, le=1, description="what is lost, 0 (no sag) to 1")
    phases: PhaseNames = "abc"
    two_phase: bool = False
    type: Type | None = Field(default=None, description="of Bollen's classification, in place of two_phase")
    angle_deg: float = Field(default=0, ge=-180, le=180, description="that the phases named are turned ahead by")

    @model_validator(mode="after")
    def _pair(self) -> Self:
        if self.two_phase and self.phases not in PAIRS:
            raise ValueError(f"a two-phase sag needs a pair of phases: ab, bc or ca, not {self.phases!r}")
        if self.type and (self.two_phase or len(self.phases) == 2):
            raise ValueError("a sag by type has one symmetrical phase: a, b or c, and no two_phase")
        if self.angle_deg and (self.two_phase or self.type):
            raise ValueError("angle_deg does not go with two_phase or type, which set the angles themselves")
        return self

    def phasors_pu(self) -> tuple[complex, complex, complex]:
        """Phase-to-neutral phasors a, b, c during the sag (pu), phase a at angle 0 when healthy."""
        residual = 1 - self.depth
        healthy = (complex(1), ROTATION_120.conjugate(), ROTATION_120)
        if self.type:
            return _turned(_phasors_of_type(self.type, residual), "abc".index(self.phases[0]))
        if not self.two_phase:
            left = cmath.rect(residual, math.radians(self.angle_deg)) if self.angle_deg else residual
            a, b, c = (left if name in self.phases else 1.0 for name in "abc")
            return a * healthy[0], b * healthy[1], c * healthy[2]
        # The line-to-line voltage of a pair is what type C leaves of it, seen from the third phase.
        return _turned(_phasors_of_type("C", residual), _HEALTHY_OF_PAIR[self.phases])

    def sequences_pu(self) -> Sequences:
        """Symmetrical components during the sag (pu)."""
        positive, negative, zero = fortescue(*self.phasors_pu())
        return Sequences(complex(positive), complex(negative), complex(zero))

    def describe(self) -> str:
        """Name the sag in words, for tables and reports."""
        if self.depth == 0 and self.angle_deg:
            return f"phase{'s' if len(self.phases) > 1 else ''} {self.phases} turned by {self.angle_deg:g} deg"
        if self.depth == 0:
            return "no sag"
        if self.type:
            return f"type {self.type}{'' if self.phases == 'abc' else ' ' + self.phases}, {100 * self.depth:g} %"
        kind = {3: "three-phase", 2: "phases", 1: "phase"}[len(self.phases)]
        if self.two_phase:
            kind = "isolated two-phase"
        where = "" if self.phases == "abc" else f" {self.phases}"
        return f"{kind}{where}, {100 * self.depth:g} %"


def near_phases(text: str) -> str:
    """Return ``'; did you mean "ca"?'`` for phases in another order or of other names, or an empty string."""
    letters = {name: "abc"[k] for names in ("abc", *_OTHER_NAMES) for k, name in enumerate(names)}
    named = {letters.get(letter, letter) for letter in text.casefold().replace("l", "") if letter.isalnum()}
    return next((f'; did you mean "{known}"?' for known in get_args(PhaseNames) if set(known) == named), "")


def through_transformer(sequences: Sequences, vector_group: str) -> Sequences:
    """Symmetrical components on the second side of a transformer, its healthy phase a at angle 0.

    A vector group turns the positive sequence by its clock number times 30 degrees and the negative sequence as much
    the other way; the zero sequence passes only where both sides are earthed stars (``YNyn``).
    """
    clock = int(vector_group.lstrip("DYNdyn"))
    earthed = vector_group.startswith("YNyn")
    return Sequences(
        positive=sequences.positive,
        negative=sequences.negative * cmath.rect(1, math.radians(60 * clock)),
        zero=sequences.zero if earthed else 0j,
    )


def _phasors_of_type(name: str, V: float) -> tuple[complex, complex, complex]:
    """Phasors a, b, c of Bollen's seven types with characteristic voltage ``V``, phase a being the symmetrical one."""
    across = {
        "A": SQRT3_2 * V,
        "B": SQRT3_2,
        "C": SQRT3_2 * V,
        "D": SQRT3_2,
        "E": SQRT3_2 * V,
        "F": (2 + V) / (2 * math.sqrt(3)),
        "G": SQRT3_2 * V,
    }[name]
    along_a = {"A": V, "B": V, "C": 1.0, "D": V, "E": 1.0, "F": V, "G": (2 + V) / 3}[name]
    along_bc = {"A": V / 2, "B": 0.5, "C": 0.5, "D": V / 2, "E": V / 2, "F": V / 2, "G": (2 + V) / 6}[name]
    return complex(along_a), complex(-along_bc, -across), complex(-along_bc, across)


def _turned(phasors: tuple[complex, complex, complex], first: int) -> tuple[complex, complex, complex]:
    """The same sag with another symmetrical phase: phase ``first`` takes the place of a."""
    turn = (complex(1), ROTATION_120.conjugate(), ROTATION_120)[first]
    found = [turn * phasors[(k - first) % 3] for k in range(3)]
    return found[0], found[1], found[2]
