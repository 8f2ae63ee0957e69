"""What is to be seen in a panel, in a sentence: which curve was judged, by which limit, and what came nearest to it."""

from collections.abc import Iterator, Sequence

from pvlvrt_compliance.report.drawing.curves import Group
from pvlvrt_compliance.report.drawing.model import Named, Said, Text
from pvlvrt_compliance.report.format import bare, row
from pvlvrt_compliance.results import JUDGED, Band, Status, TestResult, Verdict, worst
from pvlvrt_compliance.results import band as of

_SWINGING = ("active_power", "reactive_power")  # panels of quantities that are held at times by their swing alone

_IN = {"kW": of.ACTIVE_POWER, "kvar": of.REACTIVE_POWER}
"""What a verdict in a unit can only be of, where its check limits several quantities."""


def says_of(group: Group, result: TestResult) -> Text:
    """The sentence of a panel: what is drawn where nothing is limited, or else what came nearest to its limit."""
    bands = result.bands if group.bands is None else group.bands
    if not any(band.quantity in group.quantities for band in bands):
        return Text(f"figure.{group.key}.seen", {})
    judged = [verdict for verdict, quantity in judged_in(group, bands, result) if not _is_of_another(verdict, quantity)]
    nearest = nearest_of(judged, group.unit)
    swings = "swings." if group.key in _SWINGING and _is_swing_alone(group, bands) else ""
    said = told(f"figure.{group.key}.{swings}", nearest)
    if nearest is not None and any(one.check == nearest.check for one in result.characteristics):
        deviation = Text("figure.droop.deviation", {"measured": said.values["measured"]})
        return said._replace(values={**said.values, "measured": deviation})
    return said


def told(table: str, nearest: Verdict | None) -> Text:
    """The sentence of a table of the catalogues for the verdict that came nearest to its limit, or for none."""
    if nearest is None:
        return Text(f"{table}limits", {})
    kind = "failed" if nearest.status is Status.FAIL else "kept"
    values: dict[str, Said] = {
        "check": Named("check", nearest.check),
        "measured": row(nearest).measured,
        "limit": _limit(nearest),
    }
    return Text(f"{table}{kind}", values)


def _limit(verdict: Verdict) -> Text:
    """As `format.limit_in_words`, in the language that is asked for later."""
    numbers, kind = row(verdict), verdict.bound or "plain"
    if not numbers.tolerance:
        return Text(f"limit.{kind}", {"limit": numbers.limit})
    return Text(f"limit.{kind}_with_tolerance", {"limit": numbers.limit, "tolerance": bare(numbers.tolerance)})


def _is_of_another(verdict: Verdict, quantity: str) -> bool:
    """Whether what was measured is no matter of the voltage: how long the power takes to come back."""
    return quantity.startswith("voltage_") and (verdict.unit, verdict.bound) == ("s", "at_most")


def _is_swing_alone(group: Group, bands: Sequence[Band]) -> bool:
    return all(band.half_cycle for band in bands if band.quantity in group.quantities)


def judged_in(group: Group, bands: Sequence[Band], result: TestResult) -> Iterator[tuple[Verdict, str]]:
    """Verdicts whose limits stand in a panel, each with the quantity that it is shown on."""
    for verdict in result.checks:
        limited = {band.quantity for band in bands if band.check == verdict.check}
        shown = [name for name in group.quantities if name in limited and _IN.get(verdict.unit, name) == name]
        if shown and verdict.status in JUDGED:
            yield verdict, shown[0]


def nearest_of(verdicts: Sequence[Verdict], unit: str = "") -> Verdict | None:
    """A verdict that failed, or else the one that came nearest to its limit; None where none has numbers.

    One in ``unit``, which can be read off the panel, comes before all others, such as times.
    """
    judged = [v for v in verdicts if v.status in JUDGED]
    known = [v for v in judged if v.measured is not None and v.limit is not None]
    if not known:
        return None
    status = worst(v.status for v in known)
    return min((v for v in known if v.status is status), key=lambda v: (v.unit != unit, _share(v)))


def _share(verdict: Verdict) -> float:
    return float("inf") if verdict.relative_margin is None else verdict.relative_margin
