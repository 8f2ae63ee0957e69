"""How numbers and verdicts are spelled for people, the same in the terminal, in HTML and on paper.

Every function takes the texts of a language; without them it speaks English, as terminal and JUnit do.
"""

from collections.abc import Iterable
from functools import cache
from typing import NamedTuple, Protocol

from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results import JUDGED, Status, Verdict
from pvlvrt_compliance.results.digits import decimals as decimals_of
from pvlvrt_compliance.results.digits import digits_of

STATUS_WORD = {
    Status.ERROR: "error",
    Status.NOT_EVALUATED: "not evaluated",
    Status.FAIL: "fail",
    Status.PASS: "pass",
    Status.NOT_APPLICABLE: "not applicable",
}

STATUS_SYMBOL = {
    Status.ERROR: "!",
    Status.NOT_EVALUATED: "?",
    Status.FAIL: "✗",
    Status.PASS: "✓",
    Status.NOT_APPLICABLE: "–",
}
"""A verdict without colour; the words stand beside it everywhere."""

MARK_SYMBOL = {"known": "=", "worse": "↓", "marginal": "≈"}
"""What is to be said of a verdict besides its status, and its sign where there is no room for words."""

CONFIDENCE_MEANING = {
    "confirmed": "read in the official text",
    "code": "read in source code that implements the standard",
    "secondary": "read in a text about the standard",
    "memory": "well known, not checked against the document",
    "memory-low": "a hint only, not checked against the document",
    "derived": "computed from other numbers",
    "inferred": "a reading of a figure",
    "chosen": "a number of this project",
}


_BOUND_SIGNS = {None: ("", "+-"), "at_least": (">=", "-"), "at_most": ("<=", "+"), "band": ("+-", "+")}


class AgainstBaseline(Protocol):
    """A verdict, or several that share what their baseline says."""

    @property
    def is_known(self) -> bool:
        """Whether it is a failure that the baseline knows."""

    @property
    def known_reason(self) -> str:
        """Why that is lived with."""

    @property
    def worse(self) -> str:
        """What is worse, in words."""


class Row(NamedTuple):
    """The numbers of a verdict as text, empty where there is none; a tolerance of zero is none."""

    measured: str
    limit: str
    margin: str
    tolerance: str = ""
    uncertainty: str = ""


def number(
    value: float | None,
    unit: str = "",
    decimals: int | None = None,
    sign: bool = False,
    texts: Texts | None = None,
) -> str:
    """Write a value with its unit, ``50.0 kvar``; an empty string for None.

    Parameters
    ----------
    value : float or None
        Value in ``unit``.
    unit : str
        Decides the number of decimals; an unknown unit gets four significant digits.
    decimals : int, optional
        Instead of the unit's own.
    sign : bool
        Write ``+`` too.
    texts : Texts, optional
        For units that are words (``runs``).
    """
    if value is None:
        return ""
    places = decimals_of(value, unit) if decimals is None else decimals
    text = f"{value:{'+' if sign else ''}.{places}f}"
    if float(text) == 0:
        text = text.replace("-", "")
    return f"{text} {_unit(value, unit, texts)}".rstrip()


def row(check: Verdict, texts: Texts | None = None) -> Row:
    """The numbers of a verdict, with decimals enough that its margin recomputes (`digits.digits_of`)."""
    places, margin = digits_of(check)
    finest = places if check.uncertainty is None else max(places, decimals_of(check.uncertainty, check.unit))
    return Row(
        measured=number(check.measured, check.unit, places, texts=texts),
        limit=number(check.limit, check.unit, places, texts=texts),
        margin=number(margin, check.unit, places, sign=True, texts=texts),
        tolerance=number(check.tolerance or None, check.unit, places, texts=texts),
        uncertainty=number(check.uncertainty, check.unit, finest, texts=texts),
    )


def limit_in_words(check: Verdict, texts: Texts | None = None) -> str:
    """The limit with its kind and its tolerance: ``at least 160.7 kvar, tolerance 8.8``."""
    numbers = row(check, texts)
    if not numbers.limit:
        return _without_limit(check, texts)
    kind = check.bound or "plain"
    if not numbers.tolerance:
        return _texts(texts)(f"limit.{kind}", limit=numbers.limit)
    tolerance = bare(numbers.tolerance)
    return _texts(texts)(f"limit.{kind}_with_tolerance", limit=numbers.limit, tolerance=tolerance)


def limit_in_signs(check: Verdict) -> str:
    """The same where there is no room: ``>=160.7-8.8`` is what the measured value must reach. No unit, plain ASCII."""
    numbers = row(check)
    if not numbers.limit:
        return _without_limit(check, None)
    sign, widened = _BOUND_SIGNS[check.bound]
    tolerance = f"{widened}{bare(numbers.tolerance)}" if numbers.tolerance else ""
    if check.bound == "band" and tolerance and not check.limit:
        return f"{sign}{bare(numbers.tolerance)}"
    return f"{sign}{bare(numbers.limit)}{tolerance}"


def bare(text: str) -> str:
    """A number of a verdict without its unit."""
    return text.partition(" ")[0]


def verdict_in_words(check: Verdict, texts: Texts | None = None) -> str:
    """The status, and in parentheses whether it is known, worse than in the baseline, or marginal."""
    return marked(STATUS_WORD[check.status] if texts is None else texts.named("status", check.status), check, texts)


def marked(word: str, check: Verdict, texts: Texts | None = None, without: str = "") -> str:
    """The word for a verdict with its marks behind it, but for one that is told otherwise."""
    marks = marks_in_words((mark for mark in marks_of(check) if mark != without), texts)
    return _texts(texts)("limit.marked_verdict", verdict=word, marks=marks) if marks else word


def marks_of(check: Verdict) -> tuple[str, ...]:
    """Marks of a verdict, in the order of `MARK_SYMBOL`."""
    has = {"known": check.is_known, "worse": bool(check.worse), "marginal": check.is_marginal}
    return tuple(mark for mark in MARK_SYMBOL if has[mark])


def marks_in_words(marks: Iterable[str], texts: Texts | None = None) -> str:
    """Marks in a row: ``known, marginal``."""
    return ", ".join(_texts(texts).named("status", mark) for mark in marks)


def baseline_in_words(of: AgainstBaseline, texts: Texts | None = None) -> str:
    """What the baseline makes of a verdict: ``known failure: ticket 42``; nothing where it says nothing."""
    say = _texts(texts)
    if of.worse:
        return say("limit.worse", words=of.worse)
    if of.is_known:
        return say("limit.known", reason=of.known_reason) if of.known_reason else say("limit.known_without")
    return ""


def state_in_words(check: Verdict, texts: Texts | None = None) -> str:
    """The status; of what is not judged for a trip that came first, that and when."""
    if check.status is Status.NOT_APPLICABLE and (at_s := check.after_trip_s) is not None:
        return _texts(texts)("limit.after_trip", at_s=number(at_s, "s"))
    return _texts(texts).named("status", check.status)


def marginal_in_words(check: Verdict, texts: Texts | None = None) -> str:
    """Why a verdict is marginal: ``margin -0.003 pu, uncertainty 0.005 pu``."""
    numbers = row(check, texts)
    return _texts(texts)("limit.marginal", margin=numbers.margin, uncertainty=numbers.uncertainty)


def stretch_unless_told(check: Verdict) -> str:
    """The stretch that a verdict speaks of; nothing where its message names it."""
    return "" if check.stretch in check.message else check.stretch


def demand_in_words(expect: str | None, texts: Texts | None = None) -> str:
    """What a row of a test table demands, ``may trip``; nothing of a sag of the user's own."""
    return _texts(texts).named("section.expect", expect) if expect else ""


def _without_limit(check: Verdict, texts: Texts | None) -> str:
    """A least time without a limit is demanded for as long as the record lasts."""
    demanded = check.status in JUDGED and check.bound == "at_least"
    return _texts(texts)("limit.throughout") if demanded else ""


def _unit(value: float, unit: str, texts: Texts | None) -> str:
    key = f"unit_word.{unit}"
    return _texts(texts)(key, count=value) if unit and key in _texts(texts) else unit


def _texts(texts: Texts | None) -> Texts:
    return _english() if texts is None else texts


@cache
def _english() -> Texts:
    return Texts()
