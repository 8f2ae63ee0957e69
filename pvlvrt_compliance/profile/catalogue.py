"""Rows of a test table made into the runs they stand for."""

from collections.abc import Iterator
from itertools import accumulate
from typing import Any

from pvlvrt_compliance.data.marks import weakest
from pvlvrt_compliance.data.models import made
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile.curves import Envelope
from pvlvrt_compliance.profile.procedure import BY_ENVELOPE, Procedure, StepSequence, TestCase, TestRow
from pvlvrt_compliance.profile.sequences import Step
from pvlvrt_compliance.scenario.events import LONGEST_S, FurtherSag, VoltageProfile
from pvlvrt_compliance.scenario.sag import PhaseNames, Sag
from pvlvrt_compliance.scenario.scenario import Scenario

_RESOLUTION_DIGITS = 9  # of V+ in pu: a sag to exactly the last level must not fall below it by rounding
_ONE_RUN_AT_MAXIMUM = (0.0,)


def sag_duration_s(sag: Sag, envelope: Envelope | None, procedure: Procedure) -> float:
    """How long the envelope asks a sag to be ridden through (s), or the default where it sets no time."""
    v_positive = round(abs(sag.sequences_pu().positive), _RESOLUTION_DIGITS)
    return (envelope and envelope.time_of(v_positive)) or procedure.default_duration_s.value


def make_scenario(procedure: Procedure, **fields: Any) -> Scenario:
    """Scenario with the procedure's frequency and times before and after the sag.

    Raises
    ------
    UsageError
        When a field is unknown or out of its range; names all of them.
    """
    shared = {"before_s": procedure.before_s.value, "after_s": procedure.after_s.value}
    if procedure.frequency_hz is not None:
        shared["frequency_hz"] = procedure.frequency_hz.value
    return made(Scenario, shared | fields)


def expand(
    row: TestRow, procedure: Procedure, envelope: Envelope | None, overrides: dict[str, Any]
) -> Iterator[TestCase]:
    """Every run of a row: each power level at each point on wave.

    Raises
    ------
    UsageError
        When the row names a power level or steps that the procedure lacks, or a scenario field is out of its range.
    """
    angles = _angles_deg(row, procedure)
    fixed = _scenario_fields(row, procedure, envelope)
    for power in row.powers:
        irradiance = {"irradiance_w_m2": _irradiance_w_m2(power, procedure)}
        for run, angle in enumerate(angles, start=1):
            fields = fixed | irradiance | {"point_on_wave_deg": angle} | overrides
            if fixed["events"] and "events" in overrides:
                fields["events"] = (*fixed["events"], *overrides["events"])
            yield TestCase(
                id=_case_id(row, power, run, len(angles)),
                title=f"{row.title or row.sag.describe()}, {power} power, {angle:g} deg",
                scenario=make_scenario(procedure, **fields),
                clause=row.clause,
                confidence=_confidence(row, procedure, envelope),
                row="-".join(part for part in (row.id, power if len(row.powers) > 1 else "") if part),
                k_factor=row.k_factor,
                checks=row.checks,
                long=row.long,
                expect=row.expect,
                by_s=row.by_s,
            )


def count_of(row: TestRow, procedure: Procedure) -> int:
    """How many runs a row stands for."""
    return len(row.powers) * len(_angles_deg(row, procedure))


def _scenario_fields(row: TestRow, procedure: Procedure, envelope: Envelope | None) -> dict[str, Any]:
    """What all runs of a row have in common; what the row leaves open is not among it."""
    duration_s, steps = _duration_s(row, envelope, procedure)
    fields: dict[str, Any] = {"sag": row.sag, "duration_s": duration_s, "events": (*steps, *row.events)}
    fields["reactive_power_pu"] = row.reactive_power_pu
    if row.grid is not None:
        fields |= {"scr": row.grid.scr, "xr": row.grid.xr}
    names = ("frequency_hz", "vector_group", "before_s", "after_s")
    given = {name: getattr(row, name) for name in names}
    return fields | {name: value for name, value in given.items() if value is not None}


def _case_id(row: TestRow, power: str, run: int, runs: int) -> str:
    parts = [row.id, power if len(row.powers) > 1 else "", str(run) if runs > 1 else ""]
    return "-".join(part for part in parts if part)


def _angles_deg(row: TestRow, procedure: Procedure) -> tuple[float, ...]:
    if row.points_on_wave_deg:
        return row.points_on_wave_deg
    return procedure.points_on_wave_deg.values if procedure.points_on_wave_deg else _ONE_RUN_AT_MAXIMUM


def _duration_s(
    row: TestRow, envelope: Envelope | None, procedure: Procedure
) -> tuple[float, tuple[VoltageProfile | FurtherSag, ...]]:
    """How long the disturbance lasts (s), and the events that its steps make."""
    if row.steps is not None:
        return _steps(row.steps, procedure)
    if row.duration_s is not None and row.duration_s != BY_ENVELOPE:
        return float(row.duration_s), ()
    if envelope is None:
        raise UsageError('duration_s: "envelope" needs requirements.ride_through.envelope')
    return sag_duration_s(row.sag, envelope, procedure), ()


def _steps(sequence: StepSequence, procedure: Procedure) -> tuple[float, tuple[VoltageProfile | FurtherSag, ...]]:
    if sequence.table not in procedure.steps:
        known = ", ".join(procedure.steps) or "none"
        raise UsageError(f"steps.table: {sequence.table!r} is not in procedure.steps; it has: {known}")
    try:
        steps = procedure.steps[sequence.table].in_order(sequence.order)
    except ValueError as error:
        raise UsageError(f"steps.{error}") from None
    ends = list(accumulate(step.duration_s for step in steps))
    if ends[-1] > LONGEST_S:
        raise UsageError(f"steps.order: the steps last {ends[-1]:g} s; {LONGEST_S:g} s are allowed")
    begins = [0.0, *ends[:-1]]
    if sequence.phases != "abc":
        return ends[-1], tuple(_step_of(sequence.phases, *each) for each in zip(begins, steps, strict=True))
    levels = [(t, step.voltage_pu) for step, *span in zip(steps, begins, ends, strict=True) for t in span]
    return ends[-1], (made(VoltageProfile, {"points": ((0.0, 1.0), *levels, (ends[-1], 1.0))}),)


def _step_of(phases: PhaseNames, t_s: float, step: Step) -> FurtherSag:
    """A step of some phases: a sag, since a voltage profile is of all phases."""
    if step.voltage_pu > 1:
        raise UsageError(f"steps.phases: a step to {step.voltage_pu:g} pu must be of all phases")
    return FurtherSag(t_s=t_s, duration_s=step.duration_s, sag=Sag(depth=round(1 - step.voltage_pu, 9), phases=phases))


def _irradiance_w_m2(power: str, procedure: Procedure) -> float:
    if power not in procedure.irradiance_w_m2:
        known = ", ".join(procedure.irradiance_w_m2) or "none"
        raise UsageError(f"powers: {power!r} is not in procedure.irradiance_w_m2; it has: {known}")
    return procedure.irradiance_w_m2[power].value


def _confidence(row: TestRow, procedure: Procedure, envelope: Envelope | None) -> str:
    marks = [row.confidence]
    if envelope is not None and row.duration_s == BY_ENVELOPE:
        marks.append(envelope.confidence)
    if row.steps is not None:
        marks.append(procedure.steps[row.steps.table].confidence)
    return weakest(marks)
