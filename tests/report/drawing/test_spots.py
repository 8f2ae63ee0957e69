"""Words of spots stand beside them, within their frame, and none over another."""

import itertools

import pytest

from pvlvrt_compliance.report.drawing.frame import CHARACTER_PX
from pvlvrt_compliance.report.drawing.spots import placed


def boxes(spots, words, width):
    """Begin, end and line of each words."""
    for (x, y), text, place in zip(spots, words, placed(spots, words, width, 180), strict=True):
        length = CHARACTER_PX * len(text)
        begin = x if place.anchor == "left" else x - length
        yield begin, begin + length, y + place.below_px


@pytest.mark.parametrize("x", [(300, 310, 320, 330), (10, 300, 305, 680), (680, 681, 682, 683)])
@pytest.mark.parametrize("y", [5, 90, 178])
def test_no_words_cover_others_or_leave_the_frame(x, y):
    """Four at one place, at an end, at the top or at the bottom."""
    spots, words = [(at, y) for at in x], ["Current limit", "Oscillation of the power", "Ride-through", "Recovery"]
    made = list(boxes(spots, words, 686))
    for a, b in itertools.combinations(made, 2):
        assert a[1] <= b[0] or b[1] <= a[0] or abs(a[2] - b[2]) >= 12
    assert all(begin >= 0 and end <= 686 for begin, end, _ in made)
