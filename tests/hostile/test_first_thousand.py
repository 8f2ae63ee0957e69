"""Damaged files, options and parameters: whatever is given, a documented status, a reason, and nothing else.

The other thousand are in a file of their own, so that two processes share them.
"""

import pytest

from tests.hostile.checking import failures


@pytest.mark.slow
def test_first_thousand(tmp_path):
    """Each ends as documented, says why in a line, writes sound files and only where it may, and leaves nothing."""
    found = failures(range(1000), tmp_path, least_reached=50)
    assert not found, found
