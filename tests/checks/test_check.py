"""What every built-in check says of itself."""

import inspect

import pytest

from pvlvrt_compliance.checks.built_in import CHECKS
from pvlvrt_compliance.checks.check import Check, RowCheck, StretchCheck

BASES = {"record": Check, "stretch": StretchCheck, "row": RowCheck}


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.kind)
def test_a_check_says_in_one_sentence_what_it_judges(check):
    """Whoever writes a check reads the classes of the others first: no title again, and no address in its place."""
    text = inspect.cleandoc(check.__doc__)
    assert text.startswith("Judges ")
    assert text.endswith(".")
    assert "see `" not in text
    assert len(text.split()) > len(check.title.split())


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.kind)
def test_the_scope_of_a_check_is_that_of_its_base(check):
    """What is judged follows from the class that a check derives from, so that both cannot disagree."""
    of_base = [scope for scope, base in BASES.items() if base is not Check and issubclass(check, base)] or ["record"]
    assert of_base == [check.scope]
