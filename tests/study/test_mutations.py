"""The table of mutations: each wrong controller fails the checks that are stated for it, and no other."""

import importlib.util
from pathlib import Path

import pytest

import table
from mutants import MUTANTS, RIGHT
from pvlvrt_compliance.profile.requirements import BUILT_IN

pytestmark = pytest.mark.slow

GENERATOR = Path(__file__).parents[2] / "docs" / "mutations" / "generate.py"


@pytest.fixture(scope="session")
def verdicts():
    """What the checks say of every row."""
    return table.verdicts_on_all()


@pytest.mark.parametrize("row", table.ROWS, ids=lambda row: row.name)
def test_a_mutant_fails_what_is_stated(verdicts, row):
    """Exactly the checks that are stated fail, the right controller's none, and every verdict is one."""
    assert verdicts[row.name].failed == set(row.fails)
    assert not verdicts[row.name].undecided


def test_every_kind_of_requirement_is_in_the_table(verdicts):
    """The right controller passes each kind of check in some test, and some mutant fails it in some test."""
    all_kinds = set(BUILT_IN)
    assert set(table.kinds()) == all_kinds
    assert verdicts[RIGHT.name].passed == all_kinds
    assert {kind for mutant in MUTANTS for kind in mutant.fails} == all_kinds


def test_the_page_shows_the_run(verdicts):
    """`python docs/mutations/generate.py` would change nothing in the page."""
    spec = importlib.util.spec_from_file_location("mutations_page", GENERATOR)
    generator = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(generator)
    assert table.page(verdicts) == generator.PAGE.read_text("utf-8")
