"""The disturbance that a record shows: of a measured one, for which nobody says what the grid was asked to do."""

from bisect import bisect_left
from collections.abc import Callable, Iterator
from itertools import count, pairwise
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.disturbance.departures import departure_s
from pvlvrt_compliance.disturbance.model import (
    Disturbance,
    Fact,
    Jump,
    NormalVoltage,
    Step,
    Stretch,
    Voltage,
    kind_of,
)
from pvlvrt_compliance.disturbance.words import state_in_words
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.events import EventThresholds, VoltageEvent, detect_events
from pvlvrt_compliance.measure.fourier import ComplexSamples
from pvlvrt_compliance.measure.sequences import sequence_phasors
from pvlvrt_compliance.measure.silence import SILENT
from pvlvrt_compliance.measure.tracking import tracked_frequency
from pvlvrt_compliance.space_vectors import phases
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Samples, Segment, Waveforms
from pvlvrt_compliance.waveforms.joining import one_cycle_series


class Thresholds(NamedTuple):
    """What counts as a change."""

    normal: NormalVoltage
    step_pu: float = 0.02  # by which a sequence voltage moves in a cycle: chosen, four times what noise of 0.5 % does
    jump_deg: float = 5.0  # of the angle: chosen, a quarter of the smallest jump that a code names
    frequency_hz: float = 0.2  # from where it was: chosen, as the frequency of normal operation
    settled_cycles: float = 1.1  # a one-cycle voltage shows a step within a cycle, and a sample or two
    frequency_settled_cycles: float = 4.1  # what a tracked frequency rests on and settles in
    voltage_floor_pu: float = 0.003  # below it a voltage has no angle to speak of


class _Seen(NamedTuple):
    """Series of a record, shape (n,) and (3, n)."""

    t_s: Samples
    sequences_pu: Samples  # amplitudes of positive, negative and zero sequence
    phases_pu: Samples
    positive: ComplexSamples  # phasor of the positive sequence, which stands still at nominal frequency
    frequency_hz: Samples
    cycle_s: float

    @property
    def usual_hz(self) -> float:
        """The first frequency that is known."""
        return float(self.frequency_hz[np.isfinite(self.frequency_hz).argmax()])

    def median(self, x: Samples, begin_s: float, end_s: float) -> float:
        """Median of what is known of a series between two instants; where nothing is, its last value before the end."""
        begin, end = (int(k) for k in np.searchsorted(self.t_s, (begin_s, end_s)))
        inside = x[begin:end]
        known = inside[np.isfinite(inside)]
        if len(known):
            return float(np.median(known))
        last = _last_known(x, end)
        return float(x[np.isfinite(x).argmax() if last is None else last])


def _last_known(x: Samples, end: int) -> int | None:
    """Index of the last number before another index, looked for from there on backwards; None where there is none."""
    for begin in (max(end - (64 << k), 0) for k in count()):
        known = np.flatnonzero(np.isfinite(x[begin:end]))
        if len(known):
            return begin + int(known[-1])
        if begin == 0:
            return None
    raise AssertionError


@SILENT
def disturbance_found(waveforms: Waveforms, nominal: Nominal, thresholds: Thresholds) -> Disturbance:
    """Find what the grid did from the voltages of a record, without the inverter's current where it has them.

    Voltages are those of the cycle that ends at each sample, which show a step up to a cycle late; its instant is that
    at which a phase leaves what it was a cycle before (`departure_s`). Slow ramps (under ``step_pu`` a cycle) are
    levels. Sags and swells are those of `measure.events`.

    Parameters
    ----------
    waveforms : Waveforms
        With ``u0_*`` or ``u_*`` (V).
    nominal : Nominal
        Base of the per-unit values.
    thresholds : Thresholds

    Raises
    ------
    MeasurementError
        When voltages are missing, or nothing happens in the record.
    """
    seen = _series(waveforms, nominal, thresholds)
    events = _events(seen, thresholds)
    found, jumps = _steps(seen, events, thresholds, _departures(waveforms, nominal))
    if not found:
        raise MeasurementError(
            "the record holds no disturbance: no step of the voltage, of its angle or of the frequency"
        )
    bounds = [waveforms.t0_s, *(step.at_s for step in found), waveforms.end_s]
    usual_hz = seen.usual_hz
    stretches = tuple(_stretch(seen, begin_s, end_s, usual_hz, thresholds) for begin_s, end_s in pairwise(bounds))
    voltage_steps_s = [step.at_s for step in found if "voltage" in step.moved]
    clear_s = _cleared_s(stretches, voltage_steps_s) or found[-1].at_s
    facts = tuple(_facts(stretches, found, jumps))
    return Disturbance(
        start_s=found[0].at_s,
        clear_s=clear_s,
        end_s=max([clear_s, *voltage_steps_s]),
        origin="found",
        normal=thresholds.normal,
        steps=found,
        jumps=jumps,
        stretches=stretches,
        frequency_moves=any("frequency" in step.moved for step in found),
        in_words="; ".join(f"{fact.name} {fact.text}" for fact in facts),
        facts=facts,
    )


def _cleared_s(stretches: tuple[Stretch, ...], voltage_steps_s: list[float]) -> float | None:
    """End of the first sag or swell (s): the next step of the voltage, whatever else moves in between; None: no sag."""
    begin_s = next((part.begin_s for part in stretches if part.kind != "normal"), None)
    if begin_s is None:
        return None
    return next((t for t in voltage_steps_s if t > begin_s), stretches[-1].end_s)


def _facts(stretches: tuple[Stretch, ...], steps: tuple[Step, ...], jumps: tuple[Jump, ...]) -> Iterator[Fact]:
    """Each sag and swell, each jump of the angle and each departure of the frequency, as a report names them."""
    for part in stretches:
        if part.kind != "normal":
            text = f"V+ {part.voltage.positive_pu:.3f} pu, V- {part.voltage.negative_pu:.3f} pu"
            yield Fact(name=part.kind, text=f"{text}, from {part.begin_s:.3f} s to {part.end_s:.3f} s")
    for jump in jumps:
        yield Fact(name="phase jump", text=f"all phases by {jump.positive_deg:+.1f} °, at {jump.at_s:.3f} s")
    for step in steps:
        if "frequency" in step.moved:
            yield Fact(name="frequency", text=f"moves from {step.at_s:.3f} s on")
        elif step.moved == ("voltage",) and not _beyond(stretches, step.at_s):
            yield Fact(name="voltage", text=f"steps within what is normal, at {step.at_s:.3f} s")


def _beyond(stretches: tuple[Stretch, ...], at_s: float) -> bool:
    """Whether a sag or a swell begins or ends at an instant."""
    return any(part.kind != "normal" and at_s in (part.begin_s, part.end_s) for part in stretches)


def _series(waveforms: Waveforms, nominal: Nominal, thresholds: Thresholds) -> _Seen:
    floor_v = thresholds.voltage_floor_pu * nominal.phase_voltage_peak_v
    kind = _kind(waveforms)

    def phasors(segment: Segment) -> Samples:
        found: Samples = np.stack(sequence_phasors(segment, kind, nominal.frequency_hz))
        return found

    def frequency(segment: Segment) -> Samples:
        return tracked_frequency(segment, nominal.frequency_hz, kind, floor_v)

    found = np.concatenate(one_cycle_series(waveforms, phasors, nominal.frequency_hz), axis=-1)
    frequency_hz = np.concatenate(one_cycle_series(waveforms, frequency, nominal.frequency_hz, 4), axis=-1)
    frequency_hz[np.abs(found[0]) < floor_v] = np.nan  # what is followed there is the edge of the sag, held
    return _Seen(
        t_s=np.concatenate([segment.t_s for segment in waveforms]),
        sequences_pu=np.abs(found) / nominal.phase_voltage_peak_v,
        phases_pu=np.abs(np.stack(phases(*found))) / nominal.phase_voltage_peak_v,
        positive=found[0],
        frequency_hz=frequency_hz,
        cycle_s=1 / nominal.frequency_hz,
    )


def _kind(waveforms: Waveforms) -> str:
    """The voltages without the inverter's current, where the record has them."""
    return "u0" if "u0_a_v" in waveforms.names else "u"


def _departures(waveforms: Waveforms, nominal: Nominal) -> Callable[[float], float]:
    cycle_s, peak_v = 1 / nominal.frequency_hz, nominal.phase_voltage_peak_v
    return lambda seen_s: departure_s(waveforms, _kind(waveforms), seen_s, cycle_s, peak_v)


def _events(seen: _Seen, thresholds: Thresholds) -> tuple[VoltageEvent, ...]:
    """Sags and swells of the phases (IEC 61000-4-30: any phase begins one, all end it)."""
    normal = thresholds.normal
    limits = EventThresholds(enter_below=normal.low_pu, enter_above=normal.high_pu)
    return detect_events(seen.t_s, seen.phases_pu.min(axis=0), seen.phases_pu.max(axis=0), limits)


def _steps(
    seen: _Seen, events: tuple[VoltageEvent, ...], thresholds: Thresholds, departed_s: Callable[[float], float]
) -> tuple[tuple[Step, ...], tuple[Jump, ...]]:
    """What moved when, and the jumps of the angle among it."""
    candidates = _apart(_moves_s(seen, thresholds), 2 * thresholds.settled_cycles * seen.cycle_s)
    for event in events:
        for at_s in (event.start_s, event.end_s):
            if at_s is None:
                continue
            k = bisect_left(candidates, at_s)
            if all(
                abs(at_s - t) >= thresholds.settled_cycles * seen.cycle_s for t in candidates[max(k - 1, 0) : k + 1]
            ):
                candidates.insert(k, at_s)
    candidates = sorted({departed_s(at_s) for at_s in candidates})
    steps, jumps = [], []
    for before_s, at_s, after_s in zip(
        [seen.t_s[0], *candidates], candidates, [*candidates[1:], seen.t_s[-1]], strict=False
    ):
        jump_deg = _jump_deg(seen, at_s)
        if _differ(seen, before_s, at_s, after_s, thresholds):
            steps.append(Step(at_s=at_s, moved=("voltage",)))
        elif abs(jump_deg) >= thresholds.jump_deg:
            steps.append(Step(at_s=at_s, moved=("angle",)))
            jumps.append(Jump(at_s=at_s, positive_deg=jump_deg, phase_deg=jump_deg))
    steps += [Step(at_s=at_s, moved=("frequency",)) for at_s in _frequency_moves_s(seen, candidates, thresholds)]
    return tuple(sorted(steps, key=lambda step: step.at_s)), tuple(jumps)


def _moves_s(seen: _Seen, thresholds: Thresholds) -> list[float]:
    """Instants from which an amplitude differs from that of a cycle before."""
    before = np.stack([np.interp(seen.t_s - seen.cycle_s, seen.t_s, x, left=np.nan) for x in seen.sequences_pu])
    moved = np.abs(seen.sequences_pu - before).max(axis=0)
    moves = detect_events(seen.t_s, moved, moved, EventThresholds(enter_above=thresholds.step_pu))
    return [move.start_s for move in moves]


def _apart(instants_s: list[float], least_s: float) -> list[float]:
    kept: list[float] = []
    for at_s in instants_s:
        if not kept or at_s - kept[-1] > least_s:
            kept.append(at_s)
    return kept


def _differ(seen: _Seen, before_s: float, at_s: float, after_s: float, thresholds: Thresholds) -> bool:
    """Whether the voltage settles elsewhere than it was."""
    settling_s = thresholds.settled_cycles * seen.cycle_s
    return any(
        abs(seen.median(x, at_s + settling_s, after_s) - seen.median(x, before_s + settling_s, at_s))
        > thresholds.step_pu
        for x in seen.sequences_pu
    )


def _jump_deg(seen: _Seen, at_s: float) -> float:
    """Angle of the positive sequence after an instant less that before it, without what the frequency turns it by."""
    around_s = np.array([at_s - 3 * seen.cycle_s, at_s - seen.cycle_s, at_s + 2 * seen.cycle_s])
    earlier, before, after = np.searchsorted(seen.t_s, np.clip(around_s, seen.t_s[0], seen.t_s[-1]))
    turned = np.angle(seen.positive[[before, after]] * np.conj(seen.positive[[earlier, before]]))
    cycles = np.diff(seen.t_s[[earlier, before, after]])
    if not (np.isfinite(turned).all() and cycles.all()):
        return 0.0
    return float(np.degrees(np.angle(np.exp(1j * (turned[1] - turned[0] * cycles[1] / cycles[0])))))


def _frequency_moves_s(seen: _Seen, steps_s: list[float], thresholds: Thresholds) -> list[float]:
    """When the frequency leaves where it was, steps of the voltage left out."""
    known = np.isfinite(seen.frequency_hz)
    for at_s in steps_s:
        end_s = at_s + thresholds.frequency_settled_cycles * seen.cycle_s
        known[np.searchsorted(seen.t_s, at_s - seen.cycle_s) : np.searchsorted(seen.t_s, end_s, "right")] = False
    if not known.any():
        return []
    off = np.where(known, np.abs(seen.frequency_hz - seen.frequency_hz[known.argmax()]), np.nan)
    return [
        move.start_s for move in detect_events(seen.t_s, off, off, EventThresholds(enter_above=thresholds.frequency_hz))
    ]


def _stretch(seen: _Seen, begin_s: float, end_s: float, usual_hz: float, thresholds: Thresholds) -> Stretch:
    settling_s = thresholds.settled_cycles * seen.cycle_s
    positive, negative, zero = (seen.median(x, begin_s + settling_s, end_s) for x in seen.sequences_pu)
    voltage = Voltage(positive_pu=positive, negative_pu=negative, zero_pu=zero)
    kind = kind_of(thresholds.normal, voltage)
    frequency_hz = seen.median(seen.frequency_hz, begin_s + thresholds.frequency_settled_cycles * seen.cycle_s, end_s)
    is_other = abs(frequency_hz - usual_hz) > thresholds.frequency_hz
    return Stretch(
        begin_s=begin_s,
        end_s=end_s,
        kind=kind,
        voltage=voltage,
        frequency_hz=frequency_hz if np.isfinite(frequency_hz) else None,
        in_words=state_in_words(kind, voltage, other_hz=round(frequency_hz, 2) if is_other else None),
    )
