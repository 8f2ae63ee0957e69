"""What the fixture gives."""

from typing import Any

import pytest

from pvlvrt_compliance.api import check
from pvlvrt_compliance.pytest_plugin.words import red_in_words
from pvlvrt_compliance.report.gate import STOPS, of_the_run, told
from pvlvrt_compliance.results import Results


class GridCode:
    """Judges controllers by grid codes within a test."""

    def __call__(self, profiles: Any, *, must_pass: bool = True, **options: Any) -> Results:
        """Run and judge, as `pvlvrt_compliance.check` does.

        Parameters
        ----------
        profiles
            As of `check`.
        must_pass : bool
            Whether the test fails where a run of the command would end with another status than 0.
        options
            As of `check`.

        Raises
        ------
        UsageError, ProfileError, OutputError
            As `check`.
        """
        __tracebackhide__ = True
        results = check(profiles, **options)
        if must_pass:
            self.must_pass(results)
        return results

    def must_pass(self, results: Results) -> None:
        """Fail the test with the verdicts of results that stop a run; known failures do not."""
        __tracebackhide__ = True
        found = told(results)
        nothing = of_the_run(results, found)
        red = [each for each in (*found, nothing) if each is not None and each.outcome in STOPS]
        if red:
            pytest.fail(red_in_words(red))
