"""The computations behind docs/validation.md, as modules; `pythonpath` in pyproject.toml leads to them."""

from collections.abc import Callable, Iterable

import pytest

from evidence import Row


@pytest.fixture(scope="session")
def assert_within() -> Callable[[Iterable[Row]], None]:
    """Fail with every figure that is not where it is expected."""

    def check(rows: Iterable[Row]) -> None:
        rows = tuple(rows)
        assert rows
        assert [f"{row.name}: {row.found:g} {row.unit}" for row in rows if not row.within] == []

    return check
