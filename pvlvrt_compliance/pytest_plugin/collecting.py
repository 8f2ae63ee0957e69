"""A file of settings as a file of tests: one item a test of its profiles."""

import os
from collections.abc import Iterator
from dataclasses import fields
from pathlib import Path
from typing import Any, Self

import pytest

from pvlvrt_compliance.cli.options import SETTINGS, given_options, spelled
from pvlvrt_compliance.errors import PvlvrtError
from pvlvrt_compliance.pytest_plugin import MARK
from pvlvrt_compliance.pytest_plugin.words import reasons, red_in_words
from pvlvrt_compliance.report.gate import STOPS, Outcome, told_of
from pvlvrt_compliance.results import JUDGED, Status, TestResult
from pvlvrt_compliance.settings.effective import Effective, effective
from pvlvrt_compliance.settings.finding import read_file
from pvlvrt_compliance.settings.reading import CONFIG
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.one_by_one import OneByOne
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.texts import one_line, printable
from pvlvrt_compliance.trust import distrust

_OF_PYTEST = ("last_failed", "failed_first", "fail_fast")
"""What pytest does by options of its own."""


class NotMetError(Exception):
    """A grid code is not met; the text has the verdicts."""


class SettingsFile(pytest.File):
    """A file of settings."""

    named: bool
    told: list[str]

    @classmethod
    def of(cls, parent: pytest.Collector, path: Path, *, named: bool, told: list[str]) -> Self:
        """A file, which was named on the command line or only met; ``told`` takes what is to be told of it."""
        made: Self = cls.from_parent(parent, path=path)
        made.named, made.told = named, told
        return made

    def collect(self) -> Iterator[pytest.Item]:
        """The tests that it selects; none of one without a profile, unless it was named.

        Raises
        ------
        CollectError
            When the file, a variable or what they say cannot be used.
        """
        try:
            yield from self._items()
        except PvlvrtError as error:
            raise self.CollectError(str(error)) from None

    def _items(self) -> Iterator[pytest.Item]:
        if read_file(self.path) is None:
            raise self.CollectError(f"{one_line(str(self.path))}: there is no table [tool.pvlvrt]")
        holds = effective(SETTINGS, {}, os.environ, start=Path.cwd(), config=str(self.path))
        asked, others = given_options(holds.given, [field.name for field in fields(Asked)])
        if not (self.named or "profiles" in asked):
            return
        self._refuse_of_others()
        self._tell(holds)
        job = make_job(Asked(**{k: v for k, v in asked.items() if k not in _OF_PYTEST}), holds.spell(spelled))
        one_by_one = OneByOne(job)
        for item in one_by_one.tests:
            yield GridCodeItem.of(self, item, one_by_one, allow_unjudged=others.get("allow_unjudged", False))

    def _refuse_of_others(self) -> None:
        """A file that pytest only met may be of anybody, and name code; one that was named is used whosever it is."""
        config = os.environ.get(CONFIG)
        named = self.named or (config and Path(config).resolve() == self.path.resolve())
        if not named and (reason := distrust(self.path)):
            on = f"pytest {self.path.name} uses it all the same, --ignore={self.path.name} leaves it out"
            raise self.CollectError(printable(f"{self.path} is not used: {reason}, and it may name code to run; {on}"))

    def _tell(self, holds: Effective) -> None:
        self.told += [
            printable(f"pvlvrt-check: {line}") for line in (holds.in_words, *holds.put_aside, *holds.warnings)
        ]


class GridCodeItem(pytest.Item):
    """A test of a profile."""

    item: Assignment
    one_by_one: OneByOne
    allow_unjudged: bool

    @classmethod
    def of(
        cls, parent: SettingsFile, item: Assignment, one_by_one: OneByOne, *, allow_unjudged: bool
    ) -> "GridCodeItem":
        """A test among those of its file; ``allow_unjudged`` is as of the command."""
        made: GridCodeItem = cls.from_parent(parent, name=item.key)
        made.item, made.one_by_one, made.allow_unjudged = item, one_by_one, allow_unjudged
        made.add_marker(MARK)
        row = one_by_one.row_of(item)
        if row and parent.config.pluginmanager.has_plugin("xdist"):
            made.add_marker(pytest.mark.xdist_group(row))  # with `--dist loadgroup` its runs stay in one process
        return made

    def runtest(self) -> None:
        """Run the test and judge it.

        Raises
        ------
        NotMetError
            When a verdict stops a run.
        """
        tests = self.one_by_one.results(self.item)
        found = [each for test in tests for each in told_of(test, allow_unjudged=self.allow_unjudged)]
        if any(each.outcome in STOPS for each in found):
            raise NotMetError(red_in_words(found))
        if any(each.verdict.is_known for each in found):
            pytest.xfail(reasons((each for each in found if each.verdict.is_known), Outcome.SKIPPED))
        if not any(each.verdict.status in JUDGED for each in found):
            self._of_nothing(tests, reasons(found, Outcome.SKIPPED))

    def _of_nothing(self, tests: tuple[TestResult, ...], why: str) -> None:
        """Nothing was judged: right where nothing was due, or where that is allowed, and skipped then."""
        if not self.allow_unjudged and any(test.status is Status.NOT_EVALUATED for test in tests):
            raise NotMetError(f"nothing was judged: {why}")
        pytest.skip(f"nothing was judged: {why}")

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], *args: Any, **options: Any) -> Any:
        """Verdicts and what cannot be used as their text; anything else as pytest has it."""
        if isinstance(excinfo.value, NotMetError | PvlvrtError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, *args, **options)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """File and name, in words: pytest reads a name with a dot as that of a class and its function."""
        return self.path, None, f"{self.item.test.id} of {self.item.profile.id}"
