"""What a run found that its baseline says otherwise, besides what stands with each verdict."""

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from pvlvrt_compliance.texts import Name, Text

TOLERANCE = 0.01
"""Share of |limit| + tolerance by which a margin may be lost, chosen: far above what another processor changes
(1e-9) and what a file rounds off (which is allowed for besides), and no more than most verdicts are sure of."""


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore")


class BaselineNote(_Frozen):
    """An entry of a baseline that is out of date."""

    test: Name = Field(description="profile and id")
    check: Name
    was: Text = Field(description="what the entry says: fail, -0.086 pu")
    now: Text = Field(description="what was found, or why nothing can be")

    @property
    def in_words(self) -> str:
        """The whole of it, in a line."""
        return f"{self.check} in {self.test}: was {self.was}; now {self.now}"


class BaselineSummary(_Frozen):
    """The baseline that a run was held against; what it knows, and what is worse, stands with the verdicts."""

    file: Name = Field(description="as it was named")
    digest: Name = Field(description="SHA-256 of its text, whatever ends its lines")
    tolerance: FiniteFloat = Field(description="by what share of |limit| + tolerance a margin may be lost")
    better: tuple[BaselineNote, ...] = Field(default=(), description="what is better than its entry says")
    gone: tuple[BaselineNote, ...] = Field(default=(), description="entries of tests and checks that there are not")

    @property
    def has_own_tolerance(self) -> bool:
        """Whether another tolerance than `TOLERANCE` was asked for, which whoever reads the verdict has to know."""
        return self.tolerance != TOLERANCE
