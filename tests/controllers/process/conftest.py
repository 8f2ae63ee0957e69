"""What runs in the process of a user's controller runs nowhere else."""

import pytest


@pytest.fixture(autouse=True)
def _counted(counted_children: None) -> None:
    """Count its lines."""
