"""What is said of a comparison, the same in every format; English unless texts of another language are given."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.language import Texts
from pvlvrt_compliance.results.changes import Change
from pvlvrt_compliance.results.comparison import Changed, Comparison, comparison_status
from pvlvrt_compliance.results.differences import Difference, ProfileDifference
from pvlvrt_compliance.results.verdict import Status, worst

MOST = 10
"""Margins of one kind that are shown where there is little room, the largest first."""


_KINDS = ("worse", "gone", "added", "lost", "gained", "better")
"""Kinds of changes, what is worse first."""

_OF_BOTH = {
    ("verdict", Change.WORSE): "worse",
    ("verdict", Change.BETTER): "better",
    ("margin", Change.WORSE): "lost",
    ("margin", Change.BETTER): "gained",
}
"""Those of what is in both runs, by what has changed and how."""


class WholeTest(NamedTuple):
    """A test that only one of the runs has."""

    name: str
    changes: tuple[Changed, ...]

    @property
    def is_regression(self) -> bool:
        """Whether any of its verdicts is."""
        return any(one.regression for one in self.changes)

    @property
    def statuses(self) -> tuple[Status | None, Status | None]:
        """The worst of its verdicts in the old run and in the new one; None where it is not there."""
        both = zip(*((one.old, one.new) for one in self.changes), strict=True)
        old, new = (worst(one.status for one in run if one) if any(run) else None for run in both)
        return old, new


class Part(NamedTuple):
    """Changes of one kind.

    ``key`` names its heading (table ``comparison.part`` of the catalogues), and of so many ``verdicts`` it is. Tests
    that only one run has are told as ``tests``, with those of their verdicts among the ``changes`` that are new and not
    settled.
    """

    key: str
    verdicts: int
    tests: tuple[WholeTest, ...]
    changes: tuple[Changed, ...]


class Cells(NamedTuple):
    """The numbers of a change as text, empty where there is none."""

    old_margin: str
    new_margin: str
    lost: str


def parts_of(comparison: Comparison) -> tuple[Part, ...]:
    """All changes by kind, what is worse first; kinds that do not occur are left out."""
    found = {key: tuple(one for one in comparison.changes if kind_of(one) == key) for key in _KINDS}
    whole = {*comparison.tests_gone, *comparison.tests_added}
    return tuple(_part(key, changes, whole) for key, changes in found.items() if changes)


def kind_of(change: Changed) -> str:
    """The kind of a change, as it is headed (`Part.key`)."""
    return _OF_BOTH.get((change.what, change.change), change.what)


def _part(key: str, changes: tuple[Changed, ...], whole: set[str]) -> Part:
    names = dict.fromkeys(one.test for one in changes if one.test in whole)
    tests = (WholeTest(name, tuple(one for one in changes if one.test == name)) for name in names)
    told = (one for one in changes if one.test not in whole or (one.what == "added" and one.regression))
    return Part(key, len(changes), tuple(tests), tuple(told))


def cells_of(change: Changed, texts: Texts | None = None) -> Cells:
    """Both margins with their unit, and what the new one has gained (``+``) or lost (``-``), a share of the limit."""
    old, new = ("" if one is None else spell.row(one, texts).margin for one in (change.old, change.new))
    return Cells(old, new, share(change.margin_lost))


def share(lost: float | None) -> str:
    """What a margin has gained or lost, in three digits that count, and no finer than 0.01 %: ``-2.5 %``."""
    if lost is None:
        return ""
    percent = 0.0 - 100 * lost
    places = 2 - math.floor(math.log10(abs(percent))) if percent else 2
    return f"{round(percent, min(places, 2)):+.{min(max(places, 0), 2)}f} %"


def outcome(comparison: Comparison) -> str:
    """Key of what has come of it (table ``comparison.outcome`` of the catalogues)."""
    if not comparison.in_both:
        return "nothing"
    return {0: "none", 1: "regression", 3: "unjudged"}[comparison_status(comparison)]


def summary(comparison: Comparison, texts: Texts) -> str:
    """One line: what has come of it, by what was asked for, and how much has changed."""
    return texts(
        "comparison.summary",
        outcome=texts(f"comparison.outcome.{outcome(comparison)}"),
        fail_on=comparison.fail_on,
        counted=counted(comparison, texts),
    )


def counted(comparison: Comparison, texts: Texts) -> str:
    """How much has changed, kind by kind."""
    of = comparison.of
    said = texts(
        "comparison.counted",
        regressions=texts("comparison.regressions", count=len(comparison.regressions)),
        worse=len(of("verdict", Change.WORSE)),
        better=len(of("verdict", Change.BETTER)),
        lost=len(of("margin", Change.WORSE)),
        gained=len(of("margin", Change.BETTER)),
        gone=len(of("gone")),
        added=len(of("added")),
        unchanged=comparison.unchanged_count,
    )
    if not comparison.not_selected:
        return said
    count = sum(map(len, comparison.not_selected.values()))
    aside = texts("comparison.not_selected", count=count, tests=len(comparison.not_selected))
    return f"{said}; {aside}"


def differences_in_words(differences: Sequence[Difference], texts: Texts) -> list[str]:
    """A line for each thing that the runs were not made alike with."""
    return [_difference(one, texts) for one in differences]


def _difference(one: Difference, texts: Texts) -> str:
    said = texts(
        "comparison.difference",
        path=one.path,
        old=value(one.old) if one.there != "new" else texts("comparison.absent"),
        new=value(one.new) if one.there != "old" else texts("comparison.absent"),
    )
    if not one.tests:
        return said
    return texts("comparison.in_tests", said=said, tests=", ".join(one.tests[:MOST]), count=len(one.tests))


def profiles_in_words(profiles: Sequence[ProfileDifference], texts: Texts) -> list[str]:
    """A line for each profile that is not the same in both runs."""
    return [
        texts(f"comparison.profile_{one.there}", id=one.id, old=one.old_digest[:12], new=one.new_digest[:12])
        for one in profiles
    ]


def value(found: Any) -> str:
    """A value of a parameter, or a text, as it is read."""
    if found is None:
        return "none"
    if isinstance(found, float):
        return f"{found:.10g}"
    if isinstance(found, list | tuple):
        return f"({', '.join(map(value, found))})"
    return str(found)
