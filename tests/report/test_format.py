import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.report import format as spell
from pvlvrt_compliance.results import Status, Verdict

finite = st.floats(-1e9, 1e9, allow_nan=False)
units = st.sampled_from(["", "kvar", "pu", "%", "s", "furlong"])


@given(value=finite, unit=units)
def test_a_number_reads_back_close_to_its_value(value, unit):
    """What is printed is the value to the decimals of its unit, or to four significant digits."""
    text = spell.number(value, unit)
    printed = float(text.removesuffix(unit))
    assert math.isclose(printed, value, rel_tol=5.1e-4, abs_tol=0.051)
    assert not text.startswith("-") or printed < 0


@given(limit=st.floats(0.01, 1e4), margin=st.floats(1e-8, 1).map(lambda x: -x) | st.floats(1e-8, 1))
def test_a_margin_never_reads_as_zero(limit, margin):
    """A verdict that fails by little still shows by how much, in all three numbers alike."""
    check = Verdict(check="x", status=Status.FAIL, measured=limit - margin, limit=limit, margin=margin, unit="pu")
    numbers = spell.row(check)
    assert math.copysign(1, float(numbers.margin.removesuffix(" pu"))) == math.copysign(1, margin)
    assert float(numbers.margin.removesuffix(" pu")) != 0
    decimals = {text.removesuffix(" pu").partition(".")[2] for text in numbers[:3]}
    assert len({len(text) for text in decimals}) == 1


def test_nothing_measured_is_nothing_written():
    """Absent numbers are empty cells, not the word None."""
    assert spell.row(Verdict(check="x", status=Status.NOT_APPLICABLE)) == ("",) * 5


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (49.96, "kvar", "50.0 kvar"),
        (1.02, "pu", "1.020 pu"),
        (0.094, "%", "0.094 %"),
        (-1e-9, "pu", "0.000 pu"),
        (3, "", "3"),
    ],
)
def test_usual_numbers(value, unit, text):
    """Each unit has the decimals that its quantity is read with."""
    assert spell.number(value, unit) == text


def test_every_verdict_has_its_word_and_symbol():
    """No two verdicts look alike, with or without colour."""
    assert len({spell.STATUS_WORD[s] for s in Status}) == len({spell.STATUS_SYMBOL[s] for s in Status}) == len(Status)
