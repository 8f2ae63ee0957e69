"""The page on fidelity, whose table is made from runs."""

import importlib.util
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

GENERATOR = Path(__file__).parents[2] / "docs" / "fidelity" / "generate.py"


def test_the_table_is_what_the_runs_give():
    """`python docs/fidelity/generate.py` would change nothing in the page."""
    spec = importlib.util.spec_from_file_location("fidelity_page", GENERATOR)
    generator = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(generator)
    assert generator.page() == generator.PAGE.read_text("utf-8")
