"""What a baseline says of verdicts, in memory."""

import math
from collections.abc import Mapping
from decimal import Decimal
from typing import NamedTuple

from pvlvrt_compliance.results import Status, Verdict
from pvlvrt_compliance.results.changes import Earlier, Key, scale_of
from pvlvrt_compliance.results.digits import digits_of
from pvlvrt_compliance.texts import one_line

KEPT = (Status.FAIL, Status.PASS)
"""Verdicts that an entry may have. An error and what could not be judged have none: they are never known."""

ROUNDING_SHARE = 5e-4
"""Half a unit of the last decimal of a margin is no more than this share of what margins are measured by."""

_MOST_DECIMALS = 12
_MIDDLE = 1.001
"""Of half a unit, so that a margin which lay in the middle is not lost to the last bit."""
_LIMIT_MOVED = 1.01
"""Of what a margin is measured by, which may be another one than when the margin was written: a chosen slack."""


class Entry(NamedTuple):
    """A line of a baseline.

    Parameters
    ----------
    key : Key
        Test and check.
    status : Status
        One of `KEPT`.
    margin : Decimal, optional
        As it is written; None where there is none, or nothing to measure its change by.
    unit : str
        Of the margin.
    reason : str
        Why somebody lives with it.
    above : tuple of str
        Lines of comment that stand above it.
    """

    key: Key
    status: Status
    margin: Decimal | None = None
    unit: str = ""
    reason: str = ""
    above: tuple[str, ...] = ()

    def before(self, verdict: Verdict) -> Earlier:
        """The same for the rule of what is worse, beside the verdict of now."""
        if self.margin is None:
            return Earlier(self.status)
        return Earlier(self.status, float(self.margin), self.unit, rounding=rounded_off(self.margin, verdict))

    @property
    def in_words(self) -> str:
        """Verdict and margin: ``fail, -0.086 pu``."""
        return said(self.status, margin_text(self))


class Baseline(NamedTuple):
    """Entries by their key, and the lines of comment below the last of them."""

    entries: Mapping[Key, Entry]
    below: tuple[str, ...] = ()

    @property
    def has_passes(self) -> bool:
        """Whether it knows the margins of what passed, too."""
        return any(entry.status is Status.PASS for entry in self.entries.values())


def entry_of(key: Key, verdict: Verdict) -> Entry:
    """The entry that says of a verdict what it is now."""
    return Entry(key, verdict.status, rounded_margin(verdict), verdict.unit if verdict.margin is not None else "")


def rounded_margin(verdict: Verdict) -> Decimal | None:
    """The margin as a baseline has it; None where a change of it could not be measured.

    With the decimals that a report shows it with, and more of them where those are coarse beside the limit.
    """
    scale = scale_of(verdict)
    if verdict.margin is None or not 0 < scale < math.inf:
        return None
    finest = math.ceil(-math.log10(scale) - math.log10(2 * ROUNDING_SHARE))
    places = min(max(digits_of(verdict).places, finest, 0), _MOST_DECIMALS)
    return Decimal(f"{verdict.margin:.{places}f}") + 0  # no minus before a zero


def rounded_off(margin: Decimal, verdict: Verdict) -> float:
    """What a margin of a file may have lost by being rounded, in the unit of the verdict of now.

    Half a unit of its last decimal, but never more than `rounded_margin` rounds off: one that somebody wrote with fewer
    digits must not let more pass.
    """
    finest = 0.5 * 10.0**-_MOST_DECIMALS
    return min(half_a_unit(margin), _MIDDLE * max(_LIMIT_MOVED * ROUNDING_SHARE * scale_of(verdict), finest))


def half_a_unit(margin: Decimal) -> float:
    """Half a unit of the last decimal of a margin; a little more, for one that lay in the middle."""
    exponent = margin.as_tuple().exponent
    assert isinstance(exponent, int)
    return _MIDDLE * 0.5 * 10.0**exponent


def margin_text(entry: Entry) -> str:
    """The margin with its sign and unit: ``-0.086 pu``; an empty text where there is none."""
    return "" if entry.margin is None else f"{entry.margin:+f} {entry.unit}".rstrip()


def now_in_words(verdict: Verdict) -> str:
    """A verdict as an entry would say it: ``fail, -0.091 pu``."""
    return said(verdict.status, margin_text(entry_of(Key("", verdict.check), verdict)))


def said(status: Status, margin: str) -> str:
    """A verdict with its margin, if it has one."""
    return ", ".join(filter(None, [status.value.replace("_", " "), one_line(margin)]))
