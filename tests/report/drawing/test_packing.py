"""Figures are packed without loss that could be seen, into text that ends no script."""

import base64
import json
import re
import zlib

import numpy as np
import pytest

from pvlvrt_compliance.report.drawing.packing import packed
from pvlvrt_compliance.report.drawing.plotly_traces import single


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
    (array,), numbers = opened(packed([single(given)]))
    assert array["dtype"] == "q2"
    np.testing.assert_allclose(
        values(array, numbers), given, rtol=0, atol=0.51 * np.nanmax(given - np.nanmin(given)) / 16_382
    )


def test_what_does_not_move_comes_out_exactly():
    """A constant, and an array of nothing but gaps, have no range to divide by."""
    (constant, gaps), numbers = opened(packed([np.full(20, 7.25), np.full(20, np.nan)]))
    assert set(values(constant, numbers)) == {7.25}
    assert np.isnan(values(gaps, numbers)).all()


@pytest.mark.parametrize("kind", ["<u1", "<u2", "<u4"])
def test_whole_numbers_come_out_exactly(kind):
    """Whole numbers stand as they are, behind one another, however many bytes each of them has."""
    given = np.array([0, 1, np.iinfo(kind).max], dtype=kind)
    (_, array), numbers = opened(packed([np.arange(5, dtype="<u1"), given]))
    np.testing.assert_array_equal(np.frombuffer(numbers, kind, array["count"], array["at"]), given)
    assert array["dtype"] == kind[1:]


def test_what_is_neither_of_json_nor_an_array_is_refused():
    """A set has no order: it is no number of a figure."""
    with pytest.raises(TypeError, match="set"):
        packed([{1.0}])


def test_short_lists_and_words_stay_as_they_are():
    """Ranges and names are read where they stand; times keep a nanosecond."""
    given = {"range": [0.123456789, 1.5], "name": "</script>", "flags": [1, 2], "x": None}
    text = packed(given)
    assert re.fullmatch(r"[A-Za-z0-9+/=]+", text)
    assert opened(text)[0] == given
