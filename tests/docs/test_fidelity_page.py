"""The page on fidelity, whose table is made from runs."""

import pytest

from validation.fidelity import page

pytestmark = pytest.mark.slow


def test_the_table_is_what_the_runs_give():
    """`python -m validation.fidelity` would change nothing in the page."""
    assert page.page() == page.PAGE.read_text("utf-8")
