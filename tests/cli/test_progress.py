"""What is told of how far a run is."""

import pytest

from pvlvrt_compliance.cli.progress import pace_in_words


@pytest.mark.parametrize(
    ("done", "total", "elapsed_s", "words"),
    [
        (0, 200, 30.0, ""),
        (10, 200, 1.0, ""),
        (30, 200, 10.0, "3 tests/s, 57 s left"),
        (30, 494, 2.5, "12 tests/s, 39 s left"),
        (2, 200, 9.0, "4.5 s a test, 15 min left"),
        (1, 11, 1800.0, "30 min a test, 5.0 h left"),
        (200, 200, 10.0, "20 tests/s, 0.0 s left"),
        (203, 200, 10.0, "20 tests/s, 0.0 s left"),
    ],
)
def test_pace(done, total, elapsed_s, words):
    """The time left is that of the tests to come at the pace so far; further runs make it no less than nothing."""
    assert pace_in_words(done, total, elapsed_s) == words
