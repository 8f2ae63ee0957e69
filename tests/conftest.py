"""How property tests draw; and loops over time with one block replaced, that tests tell from the right one."""

from collections.abc import Callable
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
