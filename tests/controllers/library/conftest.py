"""Controllers in C."""

from collections.abc import Callable
from pathlib import Path

import pytest

from pvlvrt_compliance.controllers.library import HEADER

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"


@pytest.fixture(scope="session")
def header() -> Path:
    """Our header of the interface."""
    return HEADER


@pytest.fixture(scope="session")
def bundled_in_c(compiled: Callable[..., Path]) -> Path:
    """The example: the bundled controller."""
    return compiled(EXAMPLES / "bundled-controller-c" / "controller.c")
