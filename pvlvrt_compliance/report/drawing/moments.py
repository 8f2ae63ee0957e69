"""When what a time is demanded of has come: as lines across the panel of its quantity, and in words."""

from collections.abc import Sequence

import numpy as np

from pvlvrt_compliance.report.drawing.colours import FURTHER, GREY
from pvlvrt_compliance.report.drawing.model import Dash, Line, Named, Run, Said, Text
from pvlvrt_compliance.report.format import number
from pvlvrt_compliance.results import Instant, TestResult
from pvlvrt_compliance.waveforms.container import Samples

_DASHES: tuple[Dash, ...] = ("dot", "dashdot", "longdash", "solid")
_GREEN = FURTHER[0]


def instants_of(result: TestResult, quantities: Sequence[str], shown: Sequence[Samples]) -> tuple[Line, ...]:
    """A line across the panel at each instant; those of one name look alike and stand in the legend once.

    Parameters
    ----------
    result : TestResult
    quantities : sequence of str
        What the panel shows.
    shown : sequence of array
        Its curves: the lines are as high.
    """
    here = [one for one in result.instants if one.quantity in quantities]
    if not here or not shown:
        return ()
    starts_s = tuple(dict.fromkeys(round(_counted_from_s(one), 6) for one in here))
    low, high = min(float(np.nanmin(x)) for x in shown), max(float(np.nanmax(x)) for x in shown)
    names = list(dict.fromkeys(one.name for one in here))
    origin = Line(
        "times count from here",
        tuple(Run((at_s, at_s), (low, high)) for at_s in starts_s),
        GREY,
        width=0.8,
        group="instant origin",
    )
    return (
        origin,
        *(
            Line(
                name,
                tuple(Run((one.at_s, one.at_s), (low, high)) for one in here if one.name == name),
                _GREEN,
                dash=_DASHES[k % len(_DASHES)],
                group=f"instant {name}",
            )
            for k, name in enumerate(names)
        ),
    )


def with_times(says: Text, result: TestResult, quantities: Sequence[str]) -> Text:
    """A sentence, and after it the times of the stretch in which one of them is nearest to its limit."""
    here = [one for one in result.instants if one.quantity in quantities]
    if not here:
        return says
    stretch = min(_by_stretch(here), key=lambda one: min(map(_share, one)))
    return Text("figure.moments.with_times", {"says": says, "times": tuple(map(_told, stretch))})


def _by_stretch(instants: Sequence[Instant]) -> list[list[Instant]]:
    """Instants between two steps: none has a name twice."""
    found: list[list[Instant]] = []
    for one in instants:
        if not found or any(other.name == one.name for other in found[-1]):
            found.append([])
        found[-1].append(one)
    return found


def _share(instant: Instant) -> float:
    return (instant.limit_s - instant.took_s) / instant.limit_s if instant.limit_s else float("inf")


def _told(instant: Instant) -> Text:
    took, limit = (number(1e3 * t_s, "ms") for t_s in (instant.took_s, instant.limit_s))
    values: dict[str, Said] = {"name": Named("curve", instant.name), "took": took, "limit": limit}
    return Text("figure.moments.time", {**values, "origin": f"{_counted_from_s(instant):.4f}"})


def _counted_from_s(instant: Instant) -> float:
    """The instant that a time counts from (s)."""
    return instant.at_s - instant.took_s
