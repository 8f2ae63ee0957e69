"""Plain sentences on a waveform: numpy alone, nothing of the package.

They say less than the profiles do, and only what is clearly broken: between a sentence's number and the profile's limit
lies a gap, so that no measurement is argued about. The grid is stiff and was asked for by whoever calls, so the voltage
of a level is known and needs no measuring.
"""

from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np

from seen import S_KVA, Level, Record, longest_run, power_before, settled_mean

Sentence = Callable[[Record, list[Level]], Iterator[str]]
"""Gives what is broken, in words; nothing where nothing is."""


def stays_connected(record: Record, _: list[Level]) -> Iterator[str]:
    """The breaker stays closed: no level is one that lets the inverter go."""
    if not record.closed.all():
        yield f"breaker open from {record.t_s[~record.closed][0]:.3f} s on"


def feeds_from(lowest_pu: float, least_room_pu: float = 0.15, after_a_pause_s: float = 0.0) -> Sentence:
    """Some current flows where the lowest phase is above a level; below it feeding may pause, and a while longer."""

    def feeds(record: Record, levels: list[Level]) -> Iterator[str]:
        none = (np.abs(record.current_pu) < 0.005).all(axis=0) & record.closed
        for before, level in zip([None, *levels], levels, strict=False):
            if level.v_lowest < lowest_pu or level.v_positive - level.v_negative < least_room_pu:
                continue
            paused = before is not None and before.v_lowest < lowest_pu
            inside = record.between(level.begin_s + (after_a_pause_s if paused else 0.0), level.end_s)
            gap_s = longest_run(none & inside, record.t_s)
            if gap_s > 2 * record.cycle_s:
                yield f"no current for {gap_s:.3f} s between {level.begin_s:.3f} s and {level.end_s:.3f} s"

    return feeds


def does_not_swing(record: Record, levels: list[Level]) -> Iterator[str]:
    """P and Q do not go to and fro by 0.09 S (the profiles: 0.05) while the grid stands still."""
    for level in levels:
        inside = record.between(level.begin_s + 0.12, level.end_s - 1e-3)
        if level.end_s - level.begin_s - 0.12 < 3 * record.cycle_s:
            continue
        t_s = record.t_s[inside]
        for name, x in (("P", record.p_half[inside]), ("Q", record.q_half[inside])):
            flat = x - np.polyval(np.polyfit(t_s, x, 1), t_s)
            rise = (flat - np.minimum.accumulate(flat)).max()
            fall = (np.maximum.accumulate(flat) - flat).max()
            rise_x = (x - np.minimum.accumulate(x)).max()
            fall_x = (np.maximum.accumulate(x) - x).max()
            if min(rise, fall, rise_x, fall_x) > 0.09 * S_KVA:
                yield f"{name} goes to and fro by {min(rise_x, fall_x):.0f} after {level.begin_s:.3f} s"


def comes_back(fraction: float, time_s: Callable[[Level], float]) -> Sentence:
    """P is back after each return to normal, in time, and stays: 0.05 of what was before less, 0.05 s later."""

    def back(record: Record, levels: list[Level]) -> Iterator[str]:
        before, _ = power_before(record, levels)
        for sag, level in pairwise(levels):
            if sag.normal or not level.normal:
                continue
            end_s = level.end_s - 1e-3
            late = record.between(level.begin_s + time_s(sag) + 0.05, end_s)
            if late.any() and (low := record.p_cycle[late].min()) < (fraction - 0.05) * before:
                yield f"P is {low:.0f} kW of {before:.0f} kW {time_s(sag):g} s and more after {level.begin_s:.3f} s"

    return back


def ends_as_before(p_fraction: float | None, q_fraction: float | None) -> Sentence:
    """P and Q of the last 0.2 s are those before, within fractions of S."""

    def same(record: Record, levels: list[Level]) -> Iterator[str]:
        last = record.between(record.t_s[-1] - 0.2, record.t_s[-1])
        for name, x, before, fraction in zip(
            "PQ", (record.p_kw, record.q_kvar), power_before(record, levels), (p_fraction, q_fraction), strict=True
        ):
            if fraction is not None and abs(x[last].mean() - before) > fraction * S_KVA:
                yield f"{name} ends at {x[last].mean():.0f} and was {before:.0f}"

    return same


def limits_current(settled_pu: float, on_the_way_pu: float, peak_pu: float) -> Sentence:
    """No phase carries more: 80 ms after a step, from 1.5 cycles to 60 ms after it, ever."""

    def limited(record: Record, levels: list[Level]) -> Iterator[str]:
        if (peak := np.abs(record.current_pu).max()) > peak_pu:
            yield f"peak of {peak:.2f} pu"
        for level in levels:
            stage = record.between(level.begin_s + 1.5 * record.cycle_s, min(level.begin_s + 0.06, level.end_s))
            settled = record.between(level.begin_s + 0.08, level.end_s - 1e-3)
            for inside, limit in ((stage, on_the_way_pu), (settled, settled_pu)):
                if inside.any() and (most := record.phases_pu[:, inside].max()) > limit:
                    yield f"fundamental of {most:.3f} pu after {level.begin_s:.3f} s"

    return limited


def supports(record: Record, levels: list[Level]) -> Iterator[str]:
    """Mean Q of a sag is on the paper's curve, within 0.05 V+ S (the profile: 0.025)."""
    for level in levels:
        mean = settled_mean(record, level, record.q_kvar)
        if mean is None or level.v_positive > 0.845:
            continue
        due = S_KVA * paper_q(level)
        if mean < due - 0.05 * level.v_positive * S_KVA:
            yield f"Q of {mean:.0f} kvar where {due:.0f} are due after {level.begin_s:.3f} s"


def no_support_while_normal(record: Record, levels: list[Level]) -> Iterator[str]:
    """Between two sags no Q flows: at most 0.06 S (the profile: 0.025)."""
    for level in levels[:-1]:
        mean = settled_mean(record, level, record.q_kvar)
        if mean is not None and level.v_positive > 0.86 and level.v_negative < 0.05 and abs(mean) > 0.06 * S_KVA:
            yield f"Q of {mean:.0f} kvar at normal voltage after {level.begin_s:.3f} s"


def paper_q(level: Level) -> float:
    """Eq (9), at most eq (8) (pu)."""
    curve = np.interp(level.v_positive, [0.5, 0.85], [0.75, 0.0])
    return float(min(curve, max(level.v_positive - level.v_negative, 0.0)))


def feeds_power_in_sags(record: Record, levels: list[Level]) -> Iterator[str]:
    """P of a cycle is what eq (10) leaves, or what was before, within 0.04 S (the profile: 0.02)."""
    before, _ = power_before(record, levels)
    for level in levels:
        inside = record.between(level.begin_s + 0.12, level.end_s - 1e-3)
        if level.normal or not inside.any():
            continue
        room = level.v_positive - level.v_negative
        # Eq (10) is steep where Q takes all of S_fault: the voltage may be off by 0.01 pu.
        least = min(
            np.sqrt(max((room + x) ** 2 - paper_q(level._replace(v_positive=level.v_positive + x)) ** 2, 0))
            for x in (-0.01, 0.0, 0.01)
        )
        due = min(before, S_KVA * (least if level.v_positive < 0.84 else room - 0.01))
        if (low := record.p_cycle[inside].min()) < due - 0.04 * S_KVA:
            yield f"P of {low:.0f} kW where {due:.0f} are due after {level.begin_s:.3f} s"


def goes_on_feeding(fraction: float, lowest_pu: float, *, apparent: bool, from_s: float) -> Sentence:
    """In mandatory operation a share of the current before flows, from so long after a step on, less 0.08."""

    def fed(record: Record, levels: list[Level]) -> Iterator[str]:
        now = np.sqrt((record.phases_pu**2).mean(axis=0)) if apparent else record.phases_pu.max(axis=0)
        end_s = levels[0].begin_s - record.cycle_s
        before = now[record.between(end_s - 0.1, end_s)].mean()
        for level in levels:
            inside = record.between(level.begin_s + from_s, level.end_s - 1e-3)
            if level.normal or level.v_lowest < lowest_pu or not inside.any():
                continue
            if (least := now[inside].min()) < (fraction - 0.08) * before:
                yield f"current of {least:.2f} pu of {before:.2f} pu before, after {level.begin_s:.3f} s"

    return fed


def shares(record: Record, levels: list[Level]) -> Iterator[str]:
    """From 170 ms after a step on the current is reactive by a share (less 0.1), and not below 0.22 pu."""
    for level in levels:
        inside = record.between(level.begin_s + 0.17, level.end_s - 1e-3)
        if level.v_positive > 0.83 or not inside.any():
            continue
        total = np.hypot(record.i_active[inside], record.i_reactive[inside])
        due = np.interp(level.v_positive, [0.5, 0.85], [0.9, 0.0]) - 0.1
        if total.min() < 0.22:
            yield f"current of {total.min():.2f} pu after {level.begin_s:.3f} s"
        elif (share := (record.i_reactive[inside] / total).min()) < due:
            yield f"share of {share:.2f} where {due:.2f} is due after {level.begin_s:.3f} s"


def takes_nothing(record: Record, levels: list[Level]) -> Iterator[str]:
    """In a balanced sag no more than 0.13 S of active and 0.08 S of reactive power is taken (P.O. 12.3: 0.10, 0.05)."""
    for level in levels:
        inside = record.between(level.begin_s + 0.18, level.end_s - 1e-3)
        if level.normal or level.v_negative > 0.03 or level.v_positive > 1 or not inside.any():
            continue
        for name, x, limit in (("P", record.p_cycle, 0.13), ("Q", record.q_cycle, 0.08)):
            if -x[inside].min() > limit * S_KVA:
                yield f"{name} of {-x[inside].min():.0f} taken after {level.begin_s:.3f} s"


def adds_reactive_current(k: float, tolerance_pu: float) -> Sentence:
    """In a balanced sag at least K times the fall of the voltage is added, at most nominal, less a tolerance."""

    def added(record: Record, levels: list[Level]) -> Iterator[str]:
        for level in levels:
            mean = settled_mean(record, level, record.i_reactive)
            if mean is None or level.v_negative > 0.03 or not 0.25 < level.v_positive < 0.83:
                continue
            due = min(k * (1 - level.v_positive), 1.0) - tolerance_pu
            if mean < due:
                yield f"reactive current of {mean:.2f} pu where {due:.2f} is due after {level.begin_s:.3f} s"

    return added


def comes_soon(k: float, within_s: float) -> Sentence:
    """Three quarters of the reactive current that is due in a balanced sag has come within a time of the step."""

    def soon(record: Record, levels: list[Level]) -> Iterator[str]:
        for level in levels:
            if level.v_negative > 0.03 or not 0.25 < level.v_positive < 0.75 or level.lasts_s < 0.16:
                continue
            due = min(k * (1 - level.v_positive), 1.0)
            inside = record.between(level.begin_s, level.begin_s + within_s)
            if record.i_reactive[inside].max() < 0.75 * due - 0.1:
                yield f"reactive current not there {within_s:g} s after {level.begin_s:.3f} s"

    return soon


def steady_harmonics(limit_pu: float) -> Sentence:
    """Before the disturbance and at the end of the record no harmonic up to 10 is larger (of nominal current)."""

    def clean(record: Record, levels: list[Level]) -> Iterator[str]:
        for end_s in (levels[0].begin_s - record.cycle_s, record.t_s[-1]):
            inside = record.between(end_s - 10 * record.cycle_s, end_s)
            t_s, i = record.t_s[inside], record.current_pu[:, inside]
            for order in range(2, 11):
                found = 2 * np.abs((i * np.exp(-2j * np.pi * order * t_s / record.cycle_s)).mean(axis=1)).max()
                if found > limit_pu:
                    yield f"harmonic {order} of {found:.3f} pu up to {end_s:.3f} s"

    return clean


def no_direct_current(limit_pu: float) -> Sentence:
    """Before the disturbance no phase carries direct current beyond a fraction of the rated current's rms."""

    def none(record: Record, levels: list[Level]) -> Iterator[str]:
        end_s = levels[0].begin_s - record.cycle_s
        inside = record.between(end_s - 10 * record.cycle_s, end_s)
        found = np.abs(record.current_pu[:, inside].mean(axis=1)).max() * np.sqrt(2)
        if found > limit_pu:
            yield f"direct current of {found:.4f} of the rated current"

    return none


def quiet_link(limit_percent: float) -> Sentence:
    """The amplitude of v_DC at 2f in a settled sag, its drift taken off, is less than a percentage of its mean."""

    def quiet(record: Record, levels: list[Level]) -> Iterator[str]:
        for level in levels:
            inside = record.between(level.begin_s + 0.12, level.end_s - 0.02)
            if level.normal or level.lasts_s < 0.14 + 3 * record.cycle_s:
                continue
            t_s, v = record.t_s[inside], record.v_dc[inside]
            flat = v - np.polyval(np.polyfit(t_s, v, 3), t_s)
            found = 200 * np.abs((flat * np.exp(-4j * np.pi * t_s / record.cycle_s)).mean()) / v.mean()
            if found > limit_percent:
                yield f"v_DC swings by {found:.2f} % at 2f after {level.begin_s:.3f} s"

    return quiet
