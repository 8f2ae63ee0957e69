"""One row of the table of speeds: a figure, with what it is held against in the same run."""

import statistics
from collections.abc import Sequence
from typing import Any, NamedTuple


class Row(NamedTuple):
    """A figure, the median of some runs.

    Parameters
    ----------
    what : str
        What is measured.
    values : sequence of float
        One a run, in ``unit``.
    unit : str
        Of values and goals; ``x`` of a ratio to the reference, each run's to its own.
    must, stretch : float, optional
        What is to be reached, and what would be still better.
    is_at_least : bool
        Whether more is better.
    reference : str
        What was run in turn with it.
    reference_values : sequence of float
        One a run, in ``reference_unit``.
    reference_unit : str
    remark : str
        What there is to know besides.
    """

    what: str
    values: Sequence[float]
    unit: str
    must: float | None = None
    stretch: float | None = None
    is_at_least: bool = False
    reference: str = ""
    reference_values: Sequence[float] = ()
    reference_unit: str = "s"
    remark: str = ""

    @property
    def value(self) -> float:
        """Median of the runs."""
        return statistics.median(self.values)

    @property
    def reference_value(self) -> float | None:
        """Median of the reference's runs."""
        return statistics.median(self.reference_values) if self.reference_values else None

    def reaches(self, goal: float | None) -> bool | None:
        """Whether the median is as good as a goal; None without one."""
        if goal is None:
            return None
        return self.value >= goal if self.is_at_least else self.value <= goal

    @property
    def goals(self) -> str:
        """The goals in words: which of them are reached."""
        sign = ">=" if self.is_at_least else "<="
        words = []
        for name, goal in (("must", self.must), ("stretch", self.stretch)):
            if goal is not None:
                words.append(f"{name} {sign} {goal:g}: {'yes' if self.reaches(goal) else 'no'}")
        return ", ".join(words)

    def as_json(self) -> dict[str, Any]:
        """Everything, for a program to read."""
        return {
            **self._asdict(),
            "value": self.value,
            "reference_value": self.reference_value,
            "reaches_must": self.reaches(self.must),
            "reaches_stretch": self.reaches(self.stretch),
        }


def shown(value: float, unit: str) -> str:
    """A figure with its unit, to three digits."""
    digits = 0 if abs(value) >= 100 else 1 if abs(value) >= 10 else 2
    return f"{value:.{digits}f} {unit}"
