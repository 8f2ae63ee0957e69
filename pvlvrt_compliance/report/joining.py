"""Verdicts joined where they share a reason: one crash is one thing to read, however many verdicts it has cost."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.report.gate import Told
from pvlvrt_compliance.results import TestResult

_NAMED = 3


class Joined(NamedTuple):
    """Verdicts that are the same but for their tests and checks: of each of these tests each of these checks."""

    members: tuple[Told, ...]

    @property
    def first(self) -> Told:
        """The one that stands for all of them."""
        return self.members[0]

    @property
    def tests(self) -> tuple[TestResult, ...]:
        """Their tests, each once."""
        return tuple({each.test.key: each.test for each in self.members}.values())

    @property
    def names(self) -> tuple[str, ...]:
        """Names of their checks, each once."""
        return tuple(dict.fromkeys(each.name for each in self.members))


def joined(found: Iterable[Told]) -> list[Joined]:
    """Join checks of one test, then tests with the same checks, that share reason and numbers; the order stays.

    So does `verdicts.findings`, for readers with room for numbers elsewhere.
    """
    of_a_test: dict[tuple[str, tuple[object, ...]], list[Told]] = {}
    for each in found:
        of_a_test.setdefault((each.test.key, _shared(each)), []).append(each)
    groups: dict[tuple[tuple[str, ...], tuple[object, ...]], list[Told]] = {}
    for (_, shared), members in of_a_test.items():
        groups.setdefault((tuple(sorted(each.name for each in members)), shared), []).extend(members)
    return [Joined(tuple(members)) for members in groups.values()]


def count(groups: Iterable[Joined]) -> int:
    """How many verdicts there are in groups."""
    return sum(len(group.members) for group in groups)


def few(names: Sequence[str], most: int = _NAMED) -> str:
    """The first of some names, and how many more there are."""
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")


def _shared(each: Told) -> tuple[object, ...]:
    numbers = spell.row(each.verdict)
    limit = spell.limit_in_words(each.verdict)
    return each.outcome, each.verdict.status, each.reason, numbers.measured, limit, numbers.margin
