"""The worst instant of each check, pointed out on the curve that it judged."""

from collections.abc import Sequence

import numpy as np

from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.report.drawing.colours import BLACK, VERMILION
from pvlvrt_compliance.report.drawing.curves import Group, Shown
from pvlvrt_compliance.report.drawing.model import Named, Spot, Text
from pvlvrt_compliance.report.drawing.sentences import judged_in
from pvlvrt_compliance.results import Band, Status, TestResult, Verdict
from pvlvrt_compliance.results import band as of
from pvlvrt_compliance.waveforms.container import Samples


def worst_of(
    group: Group, bands: Sequence[Band], found: Sequence[tuple[Shown, Samples]], evidence: Evidence, result: TestResult
) -> tuple[Spot, ...]:
    """A spot for each verdict on what a panel shows that says when it was worst.

    Parameters
    ----------
    group : Group
    bands : sequence of Band
        The limits that stand in the panel.
    found : sequence
        Its series, with their samples.
    evidence : Evidence
    result : TestResult
    """
    return tuple(
        Spot(verdict.at_s, level, _words(verdict), VERMILION if _is_broken(verdict) else BLACK, _is_broken(verdict))
        for verdict, quantity in judged_in(group, bands, result)
        if verdict.at_s is not None and (level := _level(evidence, _curve(quantity, found), verdict.at_s)) is not None
    )


def _words(verdict: Verdict) -> Text:
    return Text("mark.nearest", {"check": Named("check", verdict.check)})


def _is_broken(verdict: Verdict) -> bool:
    return verdict.status is Status.FAIL


def _curve(quantity: str, found: Sequence[tuple[Shown, Samples]]) -> Samples:
    """The curve of a panel that is judged: of its quantity's name, or else the one in front.

    In a record shorter than a cycle what is judged is known nowhere, and so is the curve.
    """
    strong = {shown.name: samples for shown, samples in found if not shown.is_faint}
    names = {
        of.VOLTAGE_POSITIVE: "V<sup>+</sup>",
        of.VOLTAGE_NEGATIVE: "V<sup>−</sup>",
        of.REACTIVE_CURRENT: "positive",
        of.REACTIVE_CURRENT_NEGATIVE: "negative",
    }
    name = names.get(quantity, of.voltage_in(quantity).replace("_", " "))
    return strong.get(name, [np.empty(0), *strong.values()][-1])


def _level(evidence: Evidence, samples: Samples, at_s: float) -> float | None:
    """What a curve is at an instant; None where it is not known there."""
    at = min(int(np.searchsorted(evidence.t_s, at_s - 1e-9)), len(samples) - 1)
    return float(samples[at]) if at >= 0 and np.isfinite(samples[at]) else None
