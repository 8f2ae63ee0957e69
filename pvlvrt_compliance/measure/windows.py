"""Where a record is measured: windows of whole cycles before, during and after a sag."""

import math
from typing import NamedTuple

# Of a cycle: a frequency that is measured a hair below nominal must not cost a window its last cycle.
_CYCLE_SLACK = 1e-3
# Of a record's length (s): its last sample comes up to a step, or two, before its nominal end.
_RECORD_SLACK_S = 1e-3


class Span(NamedTuple):
    """A stretch of time, ``start_s <= t < end_s``."""

    start_s: float
    end_s: float


class Windows(NamedTuple):
    """Measurement windows; None where the record has no room for one."""

    before: Span | None
    during: Span | None
    after: Span | None


class WindowRules(NamedTuple):
    """Where the windows lie (s); a profile may state others."""

    before_start_s: float = 0.22
    """`before` begins this long before the sag ..."""
    before_end_s: float = 0.02
    """... and ends this long before it."""
    during_start_s: float = 0.10
    """`during` begins this long after the start ..."""
    during_end_s: float = 0.02
    """... and ends this long before clearing."""
    after_length_s: float = 0.2
    """`after` is the last stretch of the record, this long ..."""
    after_clearing_s: float = 1.1
    """... of a record that runs at least this long past clearing."""


STANDARD_RULES = WindowRules()


def standard_windows(
    start_s: float,
    clear_s: float,
    record_end_s: float,
    frequency_hz: float,
    rules: WindowRules = STANDARD_RULES,
    *,
    record_start_s: float = 0.0,
) -> Windows:
    """Windows of one sag, each shortened to whole cycles with its end kept: what settles late counts.

    Parameters
    ----------
    start_s, clear_s : float
        Start and clearing of the sag (s).
    record_start_s, record_end_s : float
        First instant of the record and the last (s).
    frequency_hz : float
        Frequency that the cycles are counted of (Hz).
    rules : WindowRules
        Where the windows lie.

    Returns
    -------
    Windows
        A window under one cycle, or one that the record does not hold, is None.
    """
    before = Span(start_s - rules.before_start_s, start_s - rules.before_end_s)
    during = Span(start_s + rules.during_start_s, min(clear_s - rules.during_end_s, record_end_s))
    after = Span(record_end_s - rules.after_length_s, record_end_s)
    return Windows(
        before=_shorten(before, frequency_hz) if before.start_s >= record_start_s - _RECORD_SLACK_S else None,
        during=_shorten(during, frequency_hz),
        after=_shorten(after, frequency_hz)
        if record_end_s - clear_s >= rules.after_clearing_s - _RECORD_SLACK_S
        else None,
    )


def stretch_window(
    begin_s: float, end_s: float, frequency_hz: float, settled_cycles: float, rules: WindowRules = STANDARD_RULES
) -> Span | None:
    """Window of a stretch between two steps, in whole cycles, its end kept.

    As `during` lies in a sag; in a stretch too short for that, all that is settled.

    Parameters
    ----------
    begin_s, end_s : float
        The steps (s).
    frequency_hz : float
        Frequency that the cycles are counted of (Hz).
    settled_cycles : float
        Cycles after a step in which no one-cycle quantity is settled.
    rules : WindowRules
        Where `during` lies.

    Returns
    -------
    Span or None
        None where not one settled cycle fits.
    """
    usual = Span(begin_s + rules.during_start_s, end_s - rules.during_end_s)
    short = Span(begin_s + (settled_cycles - 1) / frequency_hz, end_s)
    return _shorten(usual, frequency_hz) or _shorten(short, frequency_hz)


def settled_window(
    begin_s: float, end_s: float, frequency_hz: float, rules: WindowRules = STANDARD_RULES
) -> Span | None:
    """Window of a stretch once it is settled, in whole cycles, its end kept; parameters as `stretch_window`.

    As `during` lies in a sag, or, where that leaves no whole cycle, up to the end of the stretch. None where not even
    that leaves one.
    """
    from_s = begin_s + rules.during_start_s
    usual = _shorten(Span(from_s, end_s - rules.during_end_s), frequency_hz)
    return usual or _shorten(Span(from_s, end_s), frequency_hz)


def last_window(begin_s: float, end_s: float, frequency_hz: float, rules: WindowRules = STANDARD_RULES) -> Span | None:
    """The part of a settled window that tells what a stretch comes to, as long as `after`; parameters as there.

    Whole cycles with the end of `settled_window`; where that is shorter than `after`, itself.
    """
    settled = settled_window(begin_s, end_s, frequency_hz, rules)
    if settled is None:
        return None
    return _shorten(Span(max(settled.start_s, settled.end_s - rules.after_length_s), settled.end_s), frequency_hz)


def _shorten(span: Span, frequency_hz: float) -> Span | None:
    cycles = math.floor((span.end_s - span.start_s) * frequency_hz + _CYCLE_SLACK)
    return Span(span.end_s - cycles / frequency_hz, span.end_s) if cycles >= 1 else None
