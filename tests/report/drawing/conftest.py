"""The drawing that most tests look at."""

from collections.abc import Callable

import pytest

from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.results import TestResult


@pytest.fixture(scope="session")
def drawn(make_test: Callable[..., TestResult], make_drawing: Callable[..., Drawing]) -> Drawing:
    """The drawing of the common test."""
    return make_drawing(make_test())
