"""What a limit of the voltage demands of the connection, and the limits that are envelopes."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.checks.connection.demand import Demand
from pvlvrt_compliance.evidence.evidence import Evidence, require_finite
from pvlvrt_compliance.evidence.no_load import has_source
from pvlvrt_compliance.evidence.series import Mask
from pvlvrt_compliance.evidence.stretches import after_each_step, settled_pu, settling_s
from pvlvrt_compliance.evidence.voltages import NAMES, voltage_quantity_pu
from pvlvrt_compliance.measure.durations import median_over_time
from pvlvrt_compliance.profile.curves import Envelope, Side
from pvlvrt_compliance.profile.requirements import RideThrough
from pvlvrt_compliance.results import Band
from pvlvrt_compliance.results.band import voltage_band
from pvlvrt_compliance.waveforms.container import Samples

_ROUNDING_PU = 1e-6
_AN_INSTANT_S = 1e-6


class Limit(NamedTuple):
    """One limit of the voltage, as it applies to a record."""

    release: Demand | None  # what it demanded until it first let the inverter go, None when it never does
    demand_at: Callable[[float], Demand | None]  # what it demands of the voltage at an instant, had that gone on


def envelope_limits(requirement: RideThrough, evidence: Evidence) -> list[Limit]:
    """What the envelopes that apply to a record demand: of the voltage without the inverter's current.

    An inverter that drags its own voltage down is not let go by that.

    Raises
    ------
    MeasurementError
        When a voltage is missing or not finite.
    """
    tolerance_pu = requirement.envelope_tolerance_pu.value
    return [_limit(*applied, tolerance_pu, evidence) for applied in _applied(requirement, evidence)]


def envelope_bands(kind: str, requirement: RideThrough, evidence: Evidence) -> list[Band]:
    """The same envelopes as a figure draws them: anew from each instant that they count from."""
    tolerance_pu = requirement.envelope_tolerance_pu.value
    bands = [_band(kind, *applied, tolerance_pu, evidence) for applied in _applied(requirement, evidence)]
    return [*bands, *(_widened(band, tolerance_pu) for band in bands if tolerance_pu > 0)]


def _widened(band: Band, by_pu: float) -> Band:
    """The same with the tolerance, which a voltage that is let go must be beyond."""
    edges = {
        "lower": band.lower and tuple(max(level - by_pu, 0.0) for level in band.lower),
        "upper": band.upper and tuple(level + by_pu for level in band.upper),
    }
    return band.model_copy(update={**edges, "widened": True})


def _band(kind: str, envelope: Envelope, side: Side, by: str, tolerance_pu: float, evidence: Evidence) -> Band:
    voltage_pu = voltage_quantity_pu(evidence, envelope.voltage_quantity, "no_load")
    starts_s = _starts_s(envelope, side, tolerance_pu, voltage_pu, evidence)
    ends_s = (*starts_s[1:], evidence.waveforms.end_s)
    points = [
        (begin_s + t, level)
        for begin_s, end_s in zip(starts_s, ends_s, strict=True)
        for t, level in envelope.held(0.0, end_s - begin_s)
    ]
    t_s, level = zip(*points, strict=True)
    return Band(
        check=kind,
        quantity=voltage_band(envelope.voltage_quantity),
        name="ride-through envelope" if side is Side.LOW else by.removeprefix("the "),
        t_s=t_s,
        lower=level if side is Side.LOW else None,
        upper=level if side is Side.HIGH else None,
    )


def _applied(requirement: RideThrough, evidence: Evidence) -> Iterator[tuple[Envelope, Side, str]]:
    """The envelopes that apply to a record, for sags and for swells, with what a message calls them."""
    low, name = requirement.envelope, "the envelope"
    if requirement.envelope_two_phase is not None and is_two_phase(evidence):
        low, name = requirement.envelope_two_phase, "the envelope of two-phase faults"
    if low is not None:
        yield low, Side.LOW, name
    if (high := requirement.envelope_over_voltage) is not None:
        yield high, Side.HIGH, "the over-voltage envelope"


def deciding_envelope(requirement: RideThrough, evidence: Evidence) -> Envelope | None:
    """The envelope that a record as a whole is held against: the over-voltage one where the voltage only rises."""
    kinds = {stretch.kind for stretch in evidence.disturbance.stretches}
    applied = {side: envelope for envelope, side, _ in _applied(requirement, evidence)}
    only_rises = "swell" in kinds and "sag" not in kinds
    return applied.get(Side.HIGH if only_rises else Side.LOW, requirement.envelope)


def is_two_phase(evidence: Evidence) -> bool:
    """Whether the sag is that of an isolated two-phase fault; see `_is_two_phase`."""
    return evidence.once("two-phase fault", lambda: _is_two_phase(evidence))


def _is_two_phase(evidence: Evidence) -> bool:
    """Whether the sag is that of an isolated two-phase fault, by the voltages without the inverter's current.

    Measured where the record has them, else those asked for. A two-phase fault leaves V+ + V- = 1 pu and V0 = 0; a
    fault of two phases to earth lacks V- of that sum, a fault of one phase has V0 = V-. The sag is taken to be
    what it lies nearest to. (A fault of one phase beyond a transformer that blocks the zero sequence reads the same.)
    """
    positive, negative, zero = _no_load_sequences_pu(evidence)
    return abs(1 - positive - negative) < negative / 2 and zero < negative / 2


def _no_load_sequences_pu(evidence: Evidence) -> tuple[float, float, float]:
    grid = evidence.disturbance
    inside = evidence.samples(grid.start_s + 1 / evidence.frequency_hz, grid.clear_s)
    if not has_source(evidence) or inside.start == inside.stop:
        asked = grid.no_load(grid.start_s)
        return asked.positive_pu, asked.negative_pu, asked.zero_pu
    amplitudes = [evidence.sequence_pu("u0", index)[inside] for index in range(3)]
    require_finite(np.stack(amplitudes), "u0", evidence.t_s[inside])
    positive, negative, zero = (median_over_time(x, evidence.step_s[inside]) for x in amplitudes)
    return positive, negative, zero


def _limit(envelope: Envelope, side: Side, by: str, tolerance_pu: float, evidence: Evidence) -> Limit:
    after_start = evidence.samples(evidence.disturbance.start_s, evidence.waveforms.end_s)
    voltage_pu = voltage_quantity_pu(evidence, envelope.voltage_quantity, "no_load")
    require_finite(voltage_pu[after_start], NAMES[envelope.voltage_quantity], evidence.t_s[after_start])
    starts_s = _starts_s(envelope, side, tolerance_pu, voltage_pu, evidence)
    unsettled = after_each_step(evidence, settling_s(evidence), evidence.disturbance.voltage_steps_s)

    def demand(since_s: float, stay_s: float) -> Demand:
        mark, uncertain_s = envelope.mark_at(stay_s), _uncertain_s(envelope, stay_s, evidence)
        return Demand(since_s, stay_s, by, envelope.clause, mark, uncertain_s)

    def demand_at(at_s: float) -> Demand | None:
        settled = settled_pu(evidence, voltage_pu, at_s)
        stay_s = None if settled is None else envelope.time_of(settled, side)
        return None if stay_s is None else demand(max((t for t in starts_s if t <= at_s), default=starts_s[0]), stay_s)

    for begin_s, end_s in zip(starts_s, (*starts_s[1:], evidence.waveforms.end_s), strict=True):
        here = _up_to_the_worst(envelope, side, voltage_pu, tolerance_pu, evidence.samples(begin_s, end_s))
        t_s = evidence.t_s[here] - begin_s
        beyond_pu = (envelope.voltage_at(t_s) - voltage_pu[here]) * (1 if side is Side.LOW else -1)
        deep = (beyond_pu > tolerance_pu) & ~unsettled[here]
        left_s = _first_excursion_s(t_s, beyond_pu, deep, envelope, tolerance_pu)
        if left_s is not None:
            left_s = _at_its_step(left_s, begin_s, envelope, side, voltage_pu, tolerance_pu, evidence)
            return Limit(demand(begin_s, left_s), demand_at)
    return Limit(None, demand_at)


def _starts_s(
    envelope: Envelope, side: Side, tolerance_pu: float, voltage_pu: Samples, evidence: Evidence
) -> list[float]:
    """Instants that the envelope counts from: the start of the test, and each step of a voltage that had come back."""
    sign = 1 if side is Side.LOW else -1
    back_pu = sign * envelope.points[-1][1] - tolerance_pu
    starts_s = [evidence.disturbance.start_s]
    for step_s in evidence.disturbance.voltage_steps_s:
        at_step = min(int(np.searchsorted(evidence.t_s, step_s)), len(evidence.t_s) - 1)
        if step_s > starts_s[0] and sign * voltage_pu[at_step] >= back_pu:
            starts_s.append(step_s)
    return starts_s


def _at_its_step(
    left_s: float,
    begin_s: float,
    envelope: Envelope,
    side: Side,
    voltage_pu: Samples,
    tolerance_pu: float,
    evidence: Evidence,
) -> float:
    """When the envelope is left (s, from ``begin_s``): a one-cycle voltage shows a step that leads beyond it late."""
    at_s = begin_s + left_s
    steps_s = [begin_s, *evidence.disturbance.voltage_steps_s]
    step_s = max((t for t in steps_s if at_s - settling_s(evidence) <= t <= at_s), default=None)
    settled = None if step_s is None else settled_pu(evidence, voltage_pu, step_s)
    if step_s is None or settled is None or step_s < begin_s:
        return left_s
    beyond_pu = (float(envelope.voltage_at(step_s - begin_s)) - settled) * (1 if side is Side.LOW else -1)
    return step_s - begin_s if beyond_pu > tolerance_pu else left_s


def _uncertain_s(envelope: Envelope, stay_s: float, evidence: Evidence) -> float:
    """What is open about a time demanded (s): that of the breaker, and where an envelope meets a voltage."""
    thresholds = evidence.thresholds
    instant_s, rise_pu = thresholds.uncertainty_instant_s.value, 0.0
    if envelope.interpolation == "linear":
        around_s = np.array([stay_s - instant_s, stay_s + instant_s])
        rise_pu = abs(float(np.diff(envelope.voltage_at(around_s))[0])) / (2 * instant_s)
    return instant_s + (thresholds.voltage_tolerance_pu.value / rise_pu if rise_pu > 0 else 0.0)


def _holds(envelope: Envelope, t_s: Samples) -> Mask:
    """Where a level of the envelope holds, rather than rising or falling along a line, shape of ``t_s`` (s)."""
    if envelope.interpolation == "step":
        return np.ones(len(t_s), dtype=np.bool_)
    holds: Mask = envelope.voltage_at(t_s) == envelope.voltage_at(t_s + _AN_INSTANT_S)
    return holds


def _up_to_the_worst(envelope: Envelope, side: Side, voltage_pu: Samples, tolerance_pu: float, here: slice) -> slice:
    """Samples up to the last that may lie beyond an envelope, as one beyond its outermost level may."""
    levels, room_pu = [level for _, level in envelope.points], tolerance_pu - _ROUNDING_PU
    seen = voltage_pu[here]
    may_be = seen < max(levels) - room_pu if side is Side.LOW else seen > min(levels) + room_pu
    if not may_be.any():
        return slice(here.start, here.start)
    return slice(here.start, here.stop - int(may_be[::-1].argmax()))


def _first_excursion_s(
    t_s: Samples, beyond_pu: Samples, deep: Mask, envelope: Envelope, tolerance_pu: float
) -> float | None:
    """When the voltage first leaves the envelope (s, as ``t_s``), None when it never does.

    An excursion counts when it goes deeper than the tolerance (``deep``), so that a sag that is cleared exactly on the
    envelope is within it, and not while a one-cycle voltage swings to where a step leads. It then counts from its
    beginning: where a line is crossed, or where a level that holds is left by more than the tolerance.
    """
    if not deep.any():
        return None
    first = int(deep.argmax())
    on_it_pu = np.where(_holds(envelope, t_s[:first]), tolerance_pu, min(tolerance_pu, _ROUNDING_PU))
    on_or_within = np.flatnonzero(beyond_pu[:first] <= on_it_pu)
    return float(t_s[on_or_within[-1] + 1 if len(on_or_within) else 0])
