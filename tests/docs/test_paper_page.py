"""The page on the paper's results, made of the golden cases."""

from validation.paper import page


def test_the_page_is_that_of_its_generator():
    """Every golden case is on the page, with its words and its picture."""
    assert page.problems() == []
