"""Figures of reports that pages show."""

import pytest

from validation.pictures import drawn


@pytest.fixture(scope="module")
def made():
    """The figures as a run of now draws them."""
    return drawn.pictures()


def test_pages_show_what_a_report_shows(made):
    """`python -m validation.pictures` would change nothing that is seen."""
    assert [file.name for file, text in made.items() if not drawn.is_shown_by(text, file)] == []


@pytest.mark.parametrize(
    ("now", "same"),
    [
        ("<path d='M3 4l5 6'/><text>1.106 pu</text>", True),
        ("<path d='M5 4l2 3 3 3'/><text>1.106 pu</text>", True),
        ("<path d='M30 4l5 6'/><text>1.106 pu</text>", False),
        ("<path d='M3 4l5 6'/><text>1.107 pu</text>", False),
        ("<path d='M3 4l5 6'/><path d='M3 4l5 6'/><text>1.106 pu</text>", False),
    ],
)
def test_words_and_places_count(tmp_path, now, same):
    """One more point of a curve is nothing; another place, number or curve is."""
    file = tmp_path / "x.svg"
    file.write_text('<path d="M3 4l5 6"/><text>1.106 pu</text>', "utf-8")
    assert drawn.is_shown_by(now.replace("'", '"'), file) == same


def test_a_figure_that_is_missing_is_shown_by_nothing(tmp_path):
    """The page would have a hole."""
    assert not drawn.is_shown_by("<svg/>", tmp_path / "x.svg")
