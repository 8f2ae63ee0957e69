"""Controllers of these tests, opened once."""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

import pytest

from pvlvrt_compliance.simulation.foreign_simulate import ForeignSimulator

FOLDER = Path(__file__).parent


@pytest.fixture(scope="session")
def opened() -> Callable[..., ForeignSimulator]:
    """Open a controller of this folder: ``opened("file.py:Class", name=value, ...)``."""

    @lru_cache(maxsize=None, typed=True)
    def opened(spec, **given):
        return ForeignSimulator(f"{FOLDER / spec}", given)

    return opened
