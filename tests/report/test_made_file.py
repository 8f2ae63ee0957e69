"""What was made of records, written and read again."""

import numpy as np
import pytest

from pvlvrt_compliance.report.drawing.in_page import Figure, Figures
from pvlvrt_compliance.report.drawing.model import Named, OnGrid, Text
from pvlvrt_compliance.report.made_file import pack, unpack

FIGURES = Figures((Figure("voltage", "V", "rms", "time", 300, "<svg/>"),), (), "packed")


def test_everything_comes_back_as_it_was():
    """Numbers to the bit, texts, tuples of their kind, arrays of their type and shape."""
    values = {
        "none": None,
        "numbers": (0.1 + 0.2, 1, True, -0.0),
        "text": Text("a.key", {"of": Named("table", "name"), "many": (Text("b", {}),)}),
        "list": [1.5, "µ"],
        ("a", 1): "any key",
    }
    grid = OnGrid(0.5, 1e-4, np.arange(5, dtype=np.int64))
    array = np.array([[0.1, np.inf], [np.nan, 1e-45]], dtype=np.float32)
    found = unpack(pack({"p.t": {"page": FIGURES, "drawing": (values, grid, array)}}))["p.t"]
    again, same_grid, same_array = found["drawing"]
    assert found["page"] == FIGURES
    assert type(found["page"]) is Figures
    assert again == values
    assert type(again["text"]) is Text
    assert str(again["numbers"]) == str(values["numbers"])
    assert (type(same_grid), same_grid.first, same_grid.step) == (OnGrid, 0.5, 1e-4)
    np.testing.assert_array_equal(same_grid.numbers, grid.numbers, strict=True)
    np.testing.assert_array_equal(same_array, array, strict=True)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        '{"a": {"of": "os.system", "is": ["true"]}}',
        '{"a": {"of": "tuple"}}',
        '{"a": {"of": "array", "is": [1]}}',
    ],
)
def test_what_is_none_is_refused(text):
    """A file names no class but those of what is drawn."""
    with pytest.raises((ValueError, KeyError, TypeError, AttributeError)):
        unpack(text.encode())
