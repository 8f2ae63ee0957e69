"""How property tests draw; what none takes from its surroundings; loops over time with one block replaced."""

import os
from collections.abc import Callable, Iterator
from typing import Any

import pytest

import draws
from pvlvrt_compliance import kernel as kernel_module
from validation.mutations.rebuild import Loop, rebuilt_loop
from validation.mutations.wrong_parts import WRONG_PARTS


def pytest_addoption(parser: pytest.Parser) -> None:
    """Search by hand: ``pytest -m hypothesis --search 2000``."""
    words = f"let property tests draw so many fresh examples where they usually draw {draws.USUAL}"
    parser.addoption("--search", type=int, metavar="EXAMPLES", help=words)


def pytest_configure(config: pytest.Config) -> None:
    """Every run draws the same, but for a search."""
    draws.load_profile(config.getoption("--search"))


@pytest.fixture(scope="session", autouse=True)
def _settings_of_nobody(tmp_path_factory: pytest.TempPathFactory) -> None:
    """No test takes settings from above its folder, or from the environment: what it is given is all there is."""
    (tmp_path_factory.getbasetemp() / ".git").mkdir(exist_ok=True)  # where the search for a file ends
    for name in [name for name in os.environ if name.startswith("PVLVRT_")]:
        del os.environ[name]


COUNT_CHILDREN = "COVERAGE_PROCESS_CONFIG"
"""Variable by which a process that a test starts finds that its lines are counted."""


@pytest.fixture(scope="session", autouse=True)
def how_children_count() -> Iterator[str | None]:
    """Lines are counted in this process; in those that tests start it makes imports and programs half as slow again.

    Gives the variable's value, None where nothing is counted.
    """
    yield (value := os.environ.pop(COUNT_CHILDREN, None))
    if value is not None:
        os.environ[COUNT_CHILDREN] = value


@pytest.fixture
def counted_children(monkeypatch: pytest.MonkeyPatch, how_children_count: str | None) -> None:
    """Count lines in the processes that a test starts as well: for what runs nowhere else."""
    if how_children_count is not None:
        monkeypatch.setenv(COUNT_CHILDREN, how_children_count)


@pytest.fixture(scope="session")
def rebuild_loop() -> Callable[..., Loop]:
    """Build ``rebuild_loop(block_name=function, ...) -> run``, see `rebuilt_loop`."""
    return rebuilt_loop


@pytest.fixture(scope="session")
def in_python() -> Callable[..., Any]:
    """Give the Python behind a kernel and behind every kernel that it calls.

    Kernels can only be called from compiled code; a test of a single block needs none of that.
    """
    return kernel_module.in_python


class WrongRuns(dict[str, Loop]):
    """Loops by the name of what is wrong with them, compiled when first asked for."""

    def __init__(self, rebuild: Callable[..., Loop]) -> None:
        super().__init__()
        self._rebuild = rebuild

    def __missing__(self, name: str) -> Loop:
        self[name] = self._rebuild(**WRONG_PARTS[name])
        return self[name]


@pytest.fixture(scope="session")
def wrong_runs(rebuild_loop) -> WrongRuns:
    """Loops with one wrong part each, by name: the keys of `WRONG_PARTS`."""
    return WrongRuns(rebuild_loop)
