"""Rows of a test table made into the runs they stand for."""

from collections.abc import Iterator
from typing import Any

from pydantic import ValidationError

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile.curves import Envelope
from pvlvrt_compliance.profile.problems import dotted, problem_lines
from pvlvrt_compliance.profile.procedure import BY_ENVELOPE, Procedure, TestCase, TestRow
from pvlvrt_compliance.profile.provenance import weakest
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario

_RESOLUTION_DIGITS = 9  # of V+ in pu: a sag to exactly the last level must not fall below it by rounding
_ONE_RUN_AT_MAXIMUM = (0.0,)


def sag_duration_s(sag: Sag, envelope: Envelope | None, procedure: Procedure) -> float:
    """How long the envelope asks a sag to be ridden through (s), or the default where it sets no time."""
    v_positive = round(abs(sag.sequences_pu().positive), _RESOLUTION_DIGITS)
    return (envelope and envelope.time_of(v_positive)) or procedure.default_duration_s.value


def make_scenario(procedure: Procedure, **fields: Any) -> Scenario:
    """Scenario with the procedure's times before and after the sag.

    Raises
    ------
    UsageError
        When a field is unknown or out of its range; names all of them.
    """
    times = {"before_s": procedure.before_s.value, "after_s": procedure.after_s.value}
    try:
        return Scenario.model_validate(times | fields)
    except ValidationError as error:
        problems = (f"{dotted(location)}: {text}" for location, text in problem_lines(error, Scenario))
        raise UsageError("; ".join(problems)) from None


def expand(
    row: TestRow, procedure: Procedure, envelope: Envelope | None, overrides: dict[str, Any]
) -> Iterator[TestCase]:
    """Every run of a row: each power level at each point on wave.

    Raises
    ------
    UsageError
        When the row names a power level that the procedure lacks, or a scenario field is out of its range.
    """
    angles = _angles_deg(row, procedure)
    for power in row.powers:
        for run, angle in enumerate(angles, start=1):
            fields = {
                "sag": row.sag,
                "duration_s": _duration_s(row, envelope, procedure),
                "irradiance_w_m2": _irradiance_w_m2(power, procedure),
                "point_on_wave_deg": angle,
            }
            yield TestCase(
                id=_case_id(row, power, run, len(angles)),
                title=f"{row.title or row.sag.describe()}, {power} power, {angle:g} deg",
                scenario=make_scenario(procedure, **(fields | overrides)),
                clause=row.clause,
                confidence=_confidence(row, envelope),
            )


def _case_id(row: TestRow, power: str, run: int, runs: int) -> str:
    parts = [row.id, power if len(row.powers) > 1 else "", str(run) if runs > 1 else ""]
    return "-".join(part for part in parts if part)


def _angles_deg(row: TestRow, procedure: Procedure) -> tuple[float, ...]:
    if row.points_on_wave_deg:
        return row.points_on_wave_deg
    return procedure.points_on_wave_deg.values if procedure.points_on_wave_deg else _ONE_RUN_AT_MAXIMUM


def _duration_s(row: TestRow, envelope: Envelope | None, procedure: Procedure) -> float:
    if row.duration_s != BY_ENVELOPE:
        return float(row.duration_s)
    if envelope is None:
        raise UsageError('duration_s: "envelope" needs requirements.ride_through.envelope')
    return sag_duration_s(row.sag, envelope, procedure)


def _irradiance_w_m2(power: str, procedure: Procedure) -> float:
    if power not in procedure.irradiance_w_m2:
        known = ", ".join(procedure.irradiance_w_m2) or "none"
        raise UsageError(f"powers: {power!r} is not in procedure.irradiance_w_m2; it has: {known}")
    return procedure.irradiance_w_m2[power].value


def _confidence(row: TestRow, envelope: Envelope | None) -> str:
    by_envelope = envelope is not None and row.duration_s == BY_ENVELOPE
    return weakest([row.confidence, envelope.confidence] if envelope and by_envelope else [row.confidence])
