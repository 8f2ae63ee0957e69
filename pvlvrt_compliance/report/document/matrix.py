"""The matrix of tests and checks: a symbol where they meet, one table a profile."""

from collections.abc import Hashable, Sequence
from itertools import groupby, takewhile
from typing import NamedTuple

from pvlvrt_compliance.report.format import MARK_SYMBOL, marks_of
from pvlvrt_compliance.report.verdicts import verdicts
from pvlvrt_compliance.results import Results, Status, TestResult, worst

_POINT_ON_WAVE = "point_on_wave_deg"
_WHOLE = "test"


class Cell(NamedTuple):
    """What a check has found in a test; ``status`` is the worst of its verdicts, None where it was not asked.

    ``marks`` are those of any of its verdicts, of `MARK_SYMBOL`; it is known where all of its failures are.
    """

    check: str
    status: Status | None
    marks: tuple[str, ...] = ()

    @property
    def marginal(self) -> bool:
        """Whether one of them is marginal."""
        return "marginal" in self.marks


class Cells(NamedTuple):
    """Where a group meets a check: the cell of each run, and ``one`` that stands for all of them, the worst."""

    each: tuple[Cell, ...]
    one: Cell


class Run(NamedTuple):
    """One test, with its number in the report, from 1 on, and what tells it from the others of its group."""

    number: int
    test: TestResult
    name: str
    cells: tuple[Cell, ...]

    @property
    def marks(self) -> tuple[str, ...]:
        """What is to be said of the verdicts of the test."""
        return _common_marks(self.cells)

    @property
    def columns(self) -> tuple[Cell, ...]:
        """The verdict of the whole test, then each check in the order of the matrix."""
        return Cell(_WHOLE, self.test.status, self.marks), *self.cells

    @property
    def point_on_wave_deg(self) -> float | None:
        """Where on the wave its sag begins (deg)."""
        return _point_on_wave(self.test)


class Group(NamedTuple):
    """Runs that differ only in the point on wave at which the sag begins; most have one run."""

    name: str
    title: str
    runs: tuple[Run, ...]

    @property
    def columns(self) -> tuple[Cells, ...]:
        """The same of all its runs."""
        return tuple(Cells(each, _worst(each)) for each in zip(*(run.columns for run in self.runs), strict=True))


class Matrix(NamedTuple):
    """The tests of one profile; ``checks`` are the columns, ``idle`` the checks that applied in none of the tests."""

    profile: str
    title: str
    checks: tuple[str, ...]
    idle: tuple[str, ...]
    groups: tuple[Group, ...]

    @property
    def runs(self) -> tuple[Run, ...]:
        """All tests, in order."""
        return tuple(run for group in self.groups for run in group.runs)

    def count(self, status: Status) -> int:
        """How many of the tests have this verdict."""
        return sum(run.test.status is status for run in self.runs)


def matrices(results: Results) -> tuple[Matrix, ...]:
    """A matrix for each profile that has tests, in the order of the tests."""
    titles = {profile.id: profile.title for profile in results.profiles}
    numbered = list(enumerate(results.tests, start=1))
    names = dict.fromkeys(test.profile for test in results.tests)
    return tuple(_matrix(name, titles.get(name, ""), [x for x in numbered if x[1].profile == name]) for name in names)


def _matrix(profile: str, title: str, numbered: Sequence[tuple[int, TestResult]]) -> Matrix:
    found = [verdict for _, test in numbered for verdict in verdicts(test)]
    names = dict.fromkeys(verdict.check for verdict in found)
    applied = {verdict.check for verdict in found if verdict.status is not Status.NOT_APPLICABLE}
    checks = tuple(name for name in names if name in applied)
    groups = tuple(_group(list(same), checks) for _, same in groupby(numbered, key=lambda x: _apart_from_wave(*x)))
    return Matrix(profile, title, checks, tuple(name for name in names if name not in applied), groups)


def _apart_from_wave(number: int, test: TestResult) -> Hashable:
    """What runs of one group have in common: all that was asked but the point on wave, and the stem of their names."""
    stem = test.id.rpartition("-")[0]
    if not stem or _point_on_wave(test) is None:
        return number
    asked = {name: value for name, value in test.scenario.items() if name != _POINT_ON_WAVE}
    return stem, repr(sorted(asked.items())), test.expect, test.by_s, test.k_factor


def _group(numbered: Sequence[tuple[int, TestResult]], checks: Sequence[str]) -> Group:
    tests = [test for _, test in numbered]
    name = _common([test.id for test in tests], "-")
    title = _common([test.title for test in tests], ", ")
    runs = [
        Run(n, test, _rest(test.id, name, len(tests)), tuple(_cell(test, check) for check in checks))
        for n, test in numbered
    ]
    return Group(name, title, tuple(runs))


def _common(names: Sequence[str], separator: str) -> str:
    """The parts that all names begin with: VD3-full of VD3-full-1 and VD3-full-2."""
    parts = zip(*(name.split(separator) for name in names), strict=False)
    return separator.join(alike[0] for alike in takewhile(lambda part: len(set(part)) == 1, parts))


def _rest(name: str, common: str, runs: int) -> str:
    return name if runs == 1 else name.removeprefix(f"{common}-")


def _cell(test: TestResult, check: str) -> Cell:
    found = [verdict for verdict in verdicts(test) if verdict.check == check]
    if not found:
        return Cell(check, None)
    each = [Cell(check, verdict.status, marks_of(verdict)) for verdict in found]
    return Cell(check, worst(v.status for v in found), _common_marks(each))


def _worst(cells: Sequence[Cell]) -> Cell:
    """One cell for several of a check."""
    found = [cell.status for cell in cells if cell.status is not None]
    return Cell(cells[0].check, worst(found) if found else None, _common_marks(cells))


def _common_marks(cells: Sequence[Cell]) -> tuple[str, ...]:
    """Marks of several verdicts together."""
    found = {mark for cell in cells for mark in cell.marks}
    if any(cell.status is Status.FAIL and "known" not in cell.marks for cell in cells):
        found.discard("known")
    return tuple(mark for mark in MARK_SYMBOL if mark in found)


def _point_on_wave(test: TestResult) -> float | None:
    found = test.scenario.get(_POINT_ON_WAVE)
    return found if isinstance(found, int | float) else None
