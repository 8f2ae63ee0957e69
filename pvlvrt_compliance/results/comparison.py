"""Two runs beside each other: what has changed between them, and whether that is a regression."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Literal, NamedTuple

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, computed_field

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.results.changes import (
    Change,
    Earlier,
    Key,
    by_key,
    change_by_appearing,
    change_by_leaving,
    change_of,
    margin_lost,
    not_selected,
)
from pvlvrt_compliance.results.differences import (
    Difference,
    ProfileDifference,
    differences_between,
    profile_differences,
)
from pvlvrt_compliance.results.results import Results
from pvlvrt_compliance.results.verdict import JUDGED, Status, Verdict
from pvlvrt_compliance.texts import Name
from pvlvrt_compliance.units import parse_fraction

COMPARISON_VERSION = 1

LEAST_SHARE = 1e-4
"""By how much of its limit a margin must differ to be told: less is not seen in the digits of a verdict (chosen)."""

LEAST_MOVED = 1e-3
"""By how much of itself a limit must differ to be another one: some follow a voltage, which is measured (chosen)."""

What = Literal["verdict", "margin", "gone", "added"]
"""What of a verdict has changed: itself, only its margin, or that one of the runs has none."""

VERDICT, _MARGIN = "verdict", "margin:"
_UNJUDGED = frozenset({Status.ERROR, Status.NOT_EVALUATED})


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore")


class FailOn(NamedTuple):
    """What makes a change a regression: a worse verdict always, and beyond ``margin`` (a share) a lost margin."""

    margin: float | None = None

    @property
    def tolerance(self) -> float | None:
        """As of `change_of`; what nobody sees of a margin is no regression, whatever was asked for."""
        return None if self.margin is None else max(self.margin, LEAST_SHARE)


class Changed(_Frozen):
    """One verdict that is not in both runs what it was."""

    test: Name = Field(description="with its profile: profile.test")
    check: Name = Field(description="the second of one name in a test is `check (2)`, as in junit.xml")
    what: What
    change: Change = Field(description="of a margin, whatever the share that it has lost or gained")
    regression: bool = Field(description="whether it counts, by what was asked for")
    margin_lost: FiniteFloat | None = Field(
        default=None, description="as a share of |limit| + tolerance of the new run; negative: gained"
    )
    old: Verdict | None = None
    new: Verdict | None = None

    @property
    def key(self) -> Key:
        """Test and check."""
        return Key(self.test, self.check)

    @property
    def is_newly_unjudged(self) -> bool:
        """Whether something can no longer be judged, or a new test cannot be."""
        return self.new is not None and self.change is Change.WORSE and self.new.status in _UNJUDGED

    @property
    def limit_moved(self) -> bool:
        """Whether the two were held against different limits, by more than what a limit follows is measured by."""
        if self.old is None or self.new is None:
            return False
        old, new = (_numbers_of_limit(one) for one in (self.old, self.new))
        if None in (old[0], new[0]) or self.old.bound != self.new.bound:
            return old != new
        moved = sum(abs((now or 0.0) - (was or 0.0)) for was, now in zip(old, new, strict=True))
        return moved > LEAST_MOVED * sum(abs(part or 0.0) for part in new)


class Compared(_Frozen):
    """One of the two runs."""

    name: Name = Field(description="as whoever compares has named it: a file, a folder, a controller")
    run_id: Name = ""
    status: Status
    tests: int
    counts: dict[Status, int] = Field(description="verdicts by status, worst first")
    controller: Name = ""
    created: Name = ""


class Comparison(_Frozen):
    """What has changed from an old run to a new one."""

    comparison_version: int = COMPARISON_VERSION
    old: Compared
    new: Compared
    fail_on: Name = Field(default=VERDICT, description="`verdict`, or `margin:` and a share of the limit")
    in_both: int = Field(description="verdicts that both runs have")
    unchanged: dict[Name, tuple[Name, ...]] = Field(
        default_factory=dict, description="checks by test whose verdicts are the same, and their margins but for noise"
    )
    changes: tuple[Changed, ...] = Field(
        default=(), description="regressions first, then what is worse, then what is better; the largest margin first"
    )
    not_selected: dict[Name, tuple[Name, ...]] = Field(
        default_factory=dict, description="checks by test of the old run that the new one was not asked for: no change"
    )
    profiles: tuple[ProfileDifference, ...] = Field(default=(), description="profiles that are not the same in both")
    differences: tuple[Difference, ...] = Field(
        default=(), description="parameters, versions and whatever else the runs were made with"
    )

    @property
    def regressions(self) -> tuple[Changed, ...]:
        """What makes the comparison fail."""
        return tuple(one for one in self.changes if one.regression)

    @property
    def newly_unjudged(self) -> tuple[Changed, ...]:
        """What can no longer be judged."""
        return tuple(one for one in self.changes if one.is_newly_unjudged)

    @property
    def unchanged_count(self) -> int:
        """How many verdicts have not changed."""
        return sum(map(len, self.unchanged.values()))

    @property
    def tests_gone(self) -> tuple[str, ...]:
        """Tests of the old run that the new one has nothing of."""
        return self._whole("gone")

    @property
    def tests_added(self) -> tuple[str, ...]:
        """Tests of the new run that the old one has nothing of."""
        return self._whole("added")

    def _whole(self, what: What) -> tuple[str, ...]:
        """Tests of which every verdict is of one kind, in their order."""
        others = {one.test for one in self.changes if one.what != what} | self.unchanged.keys()
        return tuple(dict.fromkeys(one.test for one in self.of(what) if one.test not in others))

    def of(self, what: What, change: Change | None = None) -> tuple[Changed, ...]:
        """Changes of one kind; with ``change``, those to the worse or to the better."""
        return tuple(one for one in self.changes if one.what == what and change in (None, one.change))

    @computed_field(description="whether anything is a regression, can no longer be judged, or nothing was in both")
    def regression(self) -> bool:
        """Whether the new run must not take the place of the old one."""
        return bool(self.regressions) or not self.in_both


def compare(
    old: Results, new: Results, fail_on: str | FailOn = VERDICT, *, names: tuple[str, str] = ("old", "new")
) -> Comparison:
    """Compare two runs.

    A failure that a baseline knows is a failure here: what is compared is what the runs have found.

    Parameters
    ----------
    old, new : Results
    fail_on : str or FailOn
        ``"verdict"``: a worse verdict, one that is gone, and a new one that is not settled are regressions.
        ``"margin:5%"``: also a margin that has lost more than this share of its limit and tolerance.
    names : tuple of str
        What the two are called in tables and reports.

    Raises
    ------
    UsageError
        When ``fail_on`` is neither.
    """
    asked = parse_fail_on(fail_on) if isinstance(fail_on, str) else fail_on
    before, after = by_key(old), by_key(new)
    aside = [key for key in not_selected(old, new) if key not in after]
    before = {key: verdict for key, verdict in before.items() if key not in aside}
    found = [change for key in _in_order(before, after) if (change := _changed(key, before, after, asked))]
    changed = {one.key for one in found}
    return Comparison(
        old=_compared(old, names[0]),
        new=_compared(new, names[1]),
        fail_on=VERDICT if asked.margin is None else f"{_MARGIN}{100 * asked.margin:g}%",
        in_both=len(before.keys() & after.keys()),
        unchanged=_by_test(key for key in after if key not in changed),
        changes=tuple(sorted(found, key=_rank)),
        not_selected=_by_test(aside),
        profiles=profile_differences(old, new),
        differences=differences_between(old, new),
    )


def comparison_status(comparison: Comparison) -> int:
    """Exit status: 3 where something can no longer be judged or nothing was in both, 1 of a regression, else 0."""
    if comparison.newly_unjudged or not comparison.in_both:
        return 3
    return 1 if comparison.regressions else 0


def parse_fail_on(text: str, spelled: str = "fail_on") -> FailOn:
    """Read ``verdict`` or ``margin:5%``.

    Raises
    ------
    UsageError
        When it is neither, or the share is not between 0 and 100 %.
    """
    if text == VERDICT:
        return FailOn()
    if text.startswith(_MARGIN):
        return FailOn(parse_fraction(text.removeprefix(_MARGIN), f"{spelled} margin"))
    raise UsageError(f"{spelled} {text}: allowed are verdict and margin:SHARE, for instance margin:5%")


def _numbers_of_limit(verdict: Verdict) -> tuple[float | None, float]:
    return verdict.limit, verdict.tolerance


def _in_order(before: Mapping[Key, Verdict], after: Mapping[Key, Verdict]) -> Iterator[Key]:
    """Keys of the new run in its order, then those that only the old one has."""
    yield from after
    yield from (key for key in before if key not in after)


def _changed(key: Key, before: Mapping[Key, Verdict], after: Mapping[Key, Verdict], fail_on: FailOn) -> Changed | None:
    """What has changed of one verdict; None where nothing has."""
    old, new = before.get(key), after.get(key)
    told = {"test": key.test, "check": key.check, "old": old, "new": new}
    if old is None:
        assert new is not None
        change = change_by_appearing(new)
        return Changed(**told, what="added", change=change, regression=change is Change.WORSE)
    earlier = Earlier(old.status, old.margin, old.unit)
    if new is None:
        change = change_by_leaving(earlier)
        return Changed(**told, what="gone", change=change, regression=change is Change.WORSE)
    lost = margin_lost(earlier, new) if {old.status, new.status} <= JUDGED else None
    change = change_of(earlier, new, LEAST_SHARE)
    counts = change_of(earlier, new, fail_on.tolerance) is Change.WORSE
    if old.status is not new.status:
        return Changed(**told, what="verdict", change=change, regression=counts, margin_lost=lost)
    if change is Change.SAME:
        return None
    return Changed(**told, what="margin", change=change, regression=counts, margin_lost=lost)


_WHAT: tuple[What, ...] = ("verdict", "gone", "added", "margin")
_CHANGE = (Change.WORSE, Change.BETTER, Change.SAME)


def _rank(one: Changed) -> tuple[bool, int, int, float]:
    """Regressions first, then by how it has changed, by what has, and the largest margin first."""
    size = 0.0 if one.margin_lost is None else -abs(one.margin_lost)
    return not one.regression, _CHANGE.index(one.change), _WHAT.index(one.what), size


def _by_test(keys: Iterable[Key]) -> dict[str, tuple[str, ...]]:
    found: dict[str, list[str]] = {}
    for key in keys:
        found.setdefault(key.test, []).append(key.check)
    return {test: tuple(checks) for test, checks in found.items()}


def _compared(results: Results, name: str) -> Compared:
    return Compared(
        name=name,
        run_id=results.run_id,
        status=results.status,
        tests=len(results.tests),
        counts=results.counts(),
        controller=str(results.provenance.get("controller", "")),
        created=str(results.provenance.get("created", "")),
    )
