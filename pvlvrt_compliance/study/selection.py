"""Which tests of a profile are run."""

from collections.abc import Sequence
from fnmatch import fnmatchcase

from pvlvrt_compliance.errors import UsageError, did_you_mean
from pvlvrt_compliance.profile.procedure import TestCase


def select(tests: Sequence[TestCase], patterns: Sequence[str]) -> tuple[TestCase, ...]:
    """Tests whose id matches any of the shell-style patterns (``VD3*``), upper and lower case alike.

    Without patterns, all of them.

    Raises
    ------
    UsageError
        When a pattern matches no test, with the near misses.
    """
    if not patterns:
        return tuple(tests)
    for pattern in patterns:
        if not any(_matches(test, pattern) for test in tests):
            ids = [test.id for test in tests]
            hint = did_you_mean(pattern, ids) or f"; the profile has {ids[0]} to {ids[-1]}" if ids else ""
            raise UsageError(f"--test {pattern}: no test of this name{hint} (--list shows all)")
    return tuple(test for test in tests if any(_matches(test, pattern) for pattern in patterns))


def _matches(test: TestCase, pattern: str) -> bool:
    return fnmatchcase(test.id.lower(), pattern.lower())
