"""Figures are packed without loss that could be seen, into text that ends no script."""

import base64
import json
import re
import zlib

import numpy as np
import pytest

from pvlvrt_compliance.report.drawing.packing import packed
from pvlvrt_compliance.report.drawing.plotly_traces import typed_array


def opened(text):
    """The JSON that was packed, and the numbers behind it."""
    whole = zlib.decompress(base64.b64decode(text))
    begin = 4 + int.from_bytes(whole[:4], "little")
    return json.loads(whole[4:begin]), whole[begin:]


def values(array, numbers):
    """Values in steps of their range, by the description of the format."""
    bytes_ = np.frombuffer(numbers, np.uint8)[array["at"] : array["at"] + 2 * array["count"]].astype(int)
    levels = np.cumsum(bytes_[: array["count"]] + 256 * bytes_[array["count"] :]) % 65_536
    return np.where(levels == 65_535, np.nan, array["low"] + array["step"] * levels)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e6])
def test_values_come_out_within_a_step(scale):
    """Any values, in any order, differ by half a 65,534th of their range at most, and gaps stay gaps."""
    draw = np.random.default_rng(3)
    given = np.float32(scale * draw.normal(size=500)).astype(float)
    given[[0, 17, 499]] = np.nan
    (array,), numbers = opened(packed([typed_array(given)]))
    assert array["dtype"] == "q2"
    np.testing.assert_allclose(
        values(array, numbers), given, rtol=0, atol=0.51 * np.nanmax(given - np.nanmin(given)) / 16_382
    )


def test_what_does_not_move_comes_out_exactly():
    """A constant, and a list of nothing but gaps, have no range to divide by."""
    (constant, gaps), numbers = opened(packed([[7.25] * 20, [None] * 20]))
    assert set(values(constant, numbers)) == {7.25}
    assert np.isnan(values(gaps, numbers)).all()


def test_short_lists_and_words_stay_as_they_are():
    """Ranges and names are read where they stand; times keep a nanosecond."""
    given = {"range": [0.123456789, 1.5], "name": "</script>", "flags": [1, 2], "x": None}
    text = packed(given)
    assert re.fullmatch(r"[A-Za-z0-9+/=]+", text)
    assert opened(text)[0] == given
