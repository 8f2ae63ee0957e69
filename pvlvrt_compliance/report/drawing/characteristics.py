"""What is judged over another quantity than the time: active power over the frequency."""

import numpy as np

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.evidence.frequency import frequency_hz
from pvlvrt_compliance.report.drawing.colours import BLACK
from pvlvrt_compliance.report.drawing.limits import limits_of
from pvlvrt_compliance.report.drawing.model import Axis, Line, Panel, Run, Text
from pvlvrt_compliance.report.drawing.orbits import sketched_path
from pvlvrt_compliance.report.drawing.sentences import nearest_of, told
from pvlvrt_compliance.results import Band, Characteristic, TestResult
from pvlvrt_compliance.results.band import ACTIVE_POWER, FREQUENCY

_LESS_THAN_LIMITED = 0.2  # of the span of the characteristic: what of the path before it is drawn, too


def panels(evidence: Evidence, result: TestResult) -> tuple[Panel, ...]:
    """A panel for each limit of the active power over the frequency, which is the one kind that there is."""
    here = [one for one in result.characteristics if (one.over, one.quantity) == (FREQUENCY, ACTIVE_POWER)]
    drawn = (_droop(evidence, result, one) for one in here)
    return tuple(panel for panel in drawn if panel is not None)


def _droop(evidence: Evidence, result: TestResult, limit: Characteristic) -> Panel | None:
    try:
        frequency, power, opened_s = frequency_hz(evidence), evidence.active_power_kw, evidence.known_opening_s
    except MeasurementError:
        return None
    from_hz = limit.x[0] - _LESS_THAN_LIMITED * (limit.x[-1] - limit.x[0])
    with np.errstate(invalid="ignore"):
        inside = np.isfinite(power) & (frequency >= from_hz)
    if opened_s is not None:
        inside &= evidence.t_s < opened_s
    if not inside.any():
        return None
    kept = sketched_path(frequency[inside], power[inside])
    x, y = (np.round(series[inside][kept], 4).tolist() for series in (frequency, power))
    band = Band(
        check=limit.check, quantity=limit.quantity, name=limit.name, t_s=limit.x, lower=limit.lower, upper=limit.upper
    )
    limits, _ = limits_of((band,), (ACTIVE_POWER,))
    return Panel(
        title="Active power over the frequency",
        x=Axis("frequency (Hz)"),
        y=Axis("kW", from_zero=True),
        lines=(Line("P", (Run(tuple(x), tuple(y)),), BLACK, told=True), *limits),
        height=1.4,
        key="droop",
        says=_says(result, limit),
        over="other",
    )


def _says(result: TestResult, limit: Characteristic) -> Text:
    return told("figure.droop.", nearest_of([verdict for verdict in result.checks if verdict.check == limit.check]))
