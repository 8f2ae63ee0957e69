"""The figures behind docs/validation.md, held to what is expected of them."""

from collections.abc import Callable, Iterable

import pytest

from validation.simulator.evidence import Row


@pytest.fixture(scope="session")
def assert_within() -> Callable[[Iterable[Row]], None]:
    """Fail with every figure that is not where it is expected."""

    def check(rows: Iterable[Row]) -> None:
        rows = tuple(rows)
        assert rows
        assert [f"{row.name}: {row.found:g} {row.unit}" for row in rows if not row.within] == []

    return check
