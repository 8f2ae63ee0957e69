"""Damaged files, options and parameters: a thousand cases more, beside those of `test_first_thousand.py`."""

import pytest

from tests.hostile.checking import failures


@pytest.mark.slow
def test_second_thousand(tmp_path):
    """Each ends as documented, says why in a line, writes sound files and only where it may, and leaves nothing."""
    found = failures(range(1000, 2000), tmp_path, least_reached=50)
    assert not found, found
