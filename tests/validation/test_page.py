import math
import re
from pathlib import Path

import pytest

from validation.simulator import page
from validation.simulator.evidence import Row, Section, at_most

ROWS = (Row("crossover", 628.93, 610.4, 27.7, "Hz"), at_most("error", 3e-9, 1e-6, floor=1e-8), at_most("off", 2.0, 1.0))


def test_a_figure_that_is_no_number_is_not_within():
    """What could not be computed is never right."""
    assert not Row("x", math.nan, 0.0, 1.0).within


def test_a_page_shows_what_is_not_within():
    """Found, expected, tolerance and verdict stand in one line; rounding is only bounded."""
    text = page.page([Section("Title", "Words.", ROWS)])
    assert "| crossover | 628.9 | 610.4 | 27.7 | Hz | yes |" in text
    assert "| error | below 1.0e-08 | 0 | 1.0e-06 |  | yes |" in text
    assert "| off | 2 | 0 | 1 |  | **no** |" in text


@pytest.mark.parametrize(
    ("old", "new", "stale"),
    [
        ("found 1.23 %", "found 1.24 %", False),  # on the boundary of rounding either may be printed
        ("found 1.23 %", "found 1.25 %", True),
        ("at 2.3e-05", "at 2.4e-05", False),
        ("at 2.3e-05", "at 2.3e-04", True),
        ("20 times", "21 times", False),
        ("some text", "other text", True),
        ("one line", "one line\nanother", True),
    ],
)
def test_a_stale_page_is_noticed(old, new, stale):
    """Figures count at their printed digits, words exactly."""
    assert bool(page.differences(old, new)) == stale


def test_the_page_has_every_drawing():
    """Each drawing that the page links to is there."""
    text = page.PAGE.read_text(encoding="utf-8")
    files = re.findall(r"\]\((.*?\.svg)\)", text)
    assert len(files) > 10
    assert all((page.PAGE.parent / Path(file)).is_file() for file in files)
    assert "**no**" not in text
