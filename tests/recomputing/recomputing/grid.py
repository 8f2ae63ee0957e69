"""What the grid did, as `results.json` says it."""

from itertools import pairwise
from typing import Any, NamedTuple

Stretch = dict[str, Any]


class Level(NamedTuple):
    """V+, V- and V0 of the source (pu)."""

    positive: float
    negative: float
    zero: float


def _level(of: dict[str, float]) -> Level:
    return Level(of["positive_pu"], of["negative_pu"], of["zero_pu"])


class Grid:
    """The disturbance: steps, and the stretches between them."""

    def __init__(self, told: dict[str, Any]) -> None:
        self.told = told
        self.start_s, self.clear_s, self.end_s = told["start_s"], told["clear_s"], told["end_s"]
        self.stretches: list[Stretch] = told["stretches"]
        self.steps = told["steps"]
        self.frequency_moves = bool(told.get("frequency_moves"))
        self.irradiance = told.get("irradiance_w_m2")
        self.found = told.get("origin", "asked") == "found"

    def steps_of(self, *moved: str) -> list[float]:
        """Instants at which one of these steps (s)."""
        return [step["at_s"] for step in self.steps if any(what in step["moved"] for what in moved)]

    def stretch_at(self, t_s: float) -> Stretch:
        """The last stretch that has begun."""
        begun = [part for part in self.stretches if part["begin_s"] <= t_s]
        return begun[-1] if begun else self.stretches[0]

    def level(self, t_s: float) -> Level:
        """Voltage of the source at an instant, along a straight line where it ramps."""
        part = self.stretch_at(t_s)
        first, last = _level(part["voltage"]), part.get("voltage_at_end")
        if last is None or part["end_s"] <= part["begin_s"]:
            return first
        share = (t_s - part["begin_s"]) / (part["end_s"] - part["begin_s"])
        return Level(*(a + share * (b - a) for a, b in zip(first, _level(last), strict=True)))

    def is_normal(self, level: Level) -> bool:
        """Whether a voltage is that of normal operation."""
        normal = self.told["normal"]
        return normal["low_pu"] <= level.positive <= normal["high_pu"] and level.negative <= normal["negative_pu"]

    def following(self, end_s: float) -> list[Stretch]:
        """From the start of the test on, one after each step of anything, the last up to an instant."""
        begins = sorted({self.start_s, *(step["at_s"] for step in self.steps if step["at_s"] > self.start_s)})
        begins = [t for t in begins if t < end_s]
        return [
            {**self.stretch_at(a), "begin_s": a, "end_s": b, "first": self.level(a)}
            for a, b in zip(begins, [*begins[1:], end_s], strict=True)
        ]

    def of_voltage(self, end_s: float) -> list[Stretch]:
        """One after each step of the voltage, the last up to an instant."""
        bounds = [*(t for t in self.steps_of("voltage") if t < end_s), end_s]
        pairs = pairwise(bounds)
        return [{**self.stretch_at(a), "begin_s": a, "end_s": b, "first": self.level(a)} for a, b in pairs if a < b]

    def beside(self, at_s: float, begin_s: float, end_s: float) -> tuple[float, float]:
        """The steps of the voltage next to an instant, or the ends of the record."""
        steps = self.steps_of("voltage")
        before, after = [t for t in steps if t <= at_s], [t for t in steps if t > at_s]
        return before[-1] if before else begin_s, after[0] if after else end_s
