"""The table of mutations: each wrong controller fails the checks that are stated for it, and no other."""

from pathlib import Path

import pytest

from pvlvrt_compliance.profile.requirements import BUILT_IN
from validation.mutations import table
from validation.mutations.mutants import MUTANTS, RIGHT
from validation.mutations.unnoticed import UNNOTICED

PAGE = (Path(__file__).parents[2] / "docs" / "mutations.md").read_text("utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("row", table.ROWS, ids=lambda row: row.name)
def test_a_mutant_fails_what_is_stated(row):
    """Exactly the checks that are stated fail, the right controller's none, every verdict is one; the page says so."""
    verdicts = table.verdicts_on(row)
    assert verdicts.failed == set(row.fails)
    assert not verdicts.undecided
    assert row is not RIGHT or verdicts.passed == set(BUILT_IN)
    assert table.line(row.name, verdicts) in PAGE.splitlines()


def test_every_kind_of_requirement_is_in_the_table():
    """The table has each kind of check, and some mutant fails it."""
    assert set(table.kinds()) == set(BUILT_IN)
    assert {kind for mutant in MUTANTS for kind in mutant.fails} == set(BUILT_IN)


def test_what_no_check_notices_is_left_open_by_a_text():
    """A mutant that fails nothing names the text that leaves it open, and no other does."""
    assert {mutant.name for mutant in MUTANTS if not mutant.fails} == {mutant.name for mutant in UNNOTICED}
    assert all(bool(mutant.left_open) == (mutant in UNNOTICED) for mutant in MUTANTS)
    assert len({mutant.name for mutant in MUTANTS}) == len(MUTANTS) >= 70


def test_the_page_is_that_of_its_generator():
    """The page has every row, and nothing but what `python -m validation.mutations` writes of its table."""
    assert table.page(table.verdicts_in(PAGE)) == PAGE


def test_a_record_that_is_the_right_one_has_its_verdicts():
    """Records are told apart by every number in them."""
    test = table.table_profile().tests()[0]
    parameters = table.parameters_from(())
    right = table.recorded(RIGHT, test.scenario, parameters)
    assert table.digest(right) == table.of_the_right_one()[test.id][0]
    channel = next(iter(right))["i_a_a"]
    channel[-1] = channel[-1] * (1 + 1e-15) + 1e-300
    assert table.digest(right) != table.of_the_right_one()[test.id][0]
