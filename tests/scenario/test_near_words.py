"""Phases and vector groups that are nearly right, and what was meant by them."""

import re
from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from pvlvrt_compliance.scenario.sag import PhaseNames, Sag, near_phases
from pvlvrt_compliance.scenario.scenario import Scenario

PHASES = get_args(PhaseNames)
NAMES = {"letters": "abc", "IEC 60445": ("L1", "L2", "L3"), "numbers": "123", "older": "rst", "machines": "UVW"}


@pytest.mark.parametrize("known", PHASES)
@pytest.mark.parametrize("names", NAMES.values(), ids=NAMES.keys())
def test_phases_in_any_order_and_by_other_names(known, names):
    """Whoever writes the phases backwards, in capitals or as another text calls them is told ours."""
    own = [names["abc".index(letter)] for letter in known]
    for spelled in ("".join(own), "".join(reversed(own)), "-".join(own), "".join(own).upper()):
        assert near_phases(spelled) == f'; did you mean "{known}"?'


@given(st.text(max_size=6))
def test_whatever_is_offered_for_phases_is_allowed(text):
    """What is offered can be taken."""
    hint = near_phases(text)
    assert hint == "" or re.fullmatch(r'; did you mean "(\w+)"\?', hint)[1] in PHASES


@pytest.mark.parametrize("text", ["", "x", "abcd", "ad", "n", "4"])
def test_what_is_like_no_phases_has_no_hint(text):
    """Nothing is offered for what is nothing like it."""
    assert near_phases(text) == ""


def scenario(group):
    """A scenario with a transformer."""
    return Scenario(sag=Sag(depth=0.5), duration_s=0.5, vector_group=group)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("dyn11", "Dyn11"),
        ("DYN11", "Dyn11"),
        ("Dyn-11", "Dyn11"),
        ("ynd 1", "YNd1"),
        ("yy0", "Yy0"),
        ("YnYn0", "YNyn0"),
    ],
)
def test_a_vector_group_in_other_letters(text, meant):
    """Capitals and dashes differ among writers; what is offered is a group that can be taken."""
    with pytest.raises(
        ValidationError, match=re.escape(f"'{text}' is no vector group; ") + f'.*did you mean "{meant}"'
    ):
        scenario(text)
    assert scenario(meant).vector_group == meant


@pytest.mark.parametrize("text", ["Dyn12", "11", "Dz11", "", "Dyn"])
def test_what_is_no_vector_group_is_told_what_one_is(text):
    """The sides and the hours are named, with an example that can be taken."""
    with pytest.raises(ValidationError, match=r"the hours, 0 to 11, .* Dyn11 for instance") as refused:
        scenario(text)
    assert "did you mean" not in str(refused.value)
