"""Which tests are in which part of a run."""

import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.study.executors.units import cost_s, units_of
from pvlvrt_compliance.study.job import Asked, make_job

IEC, PO = "iec61400-21", "es-po-12.3"


def parts(count, *profiles, **asked):
    """The jobs of all parts."""
    return [make_job(Asked(profiles=profiles, shard=f"{n}/{count}", **asked)) for n in range(1, count + 1)]


@pytest.mark.parametrize("count", [1, 2, 5])
def test_each_test_is_in_one_part(count):
    """No test is lost or there twice, each keeps its place, and what is in other parts is not selected here."""
    whole = make_job(Asked(profiles=(IEC, PO)))
    keys = [item.key for item in whole.tests]
    found = parts(count, IEC, PO)
    assert sorted(item.key for part in found for item in part.tests) == sorted(keys)
    for part in found:
        own = [item.key for item in part.tests]
        assert own == [key for key in keys if key in own]
        assert part.size == len(keys)
        assert {item.key for item in part.not_selected} == set(keys) - set(own)


def test_what_shares_a_record_or_a_row_stays_together():
    """Each unit of the whole is a unit of one part."""
    units = units_of(make_job(Asked(profiles=(IEC, PO))).tests)
    found = [unit for part in parts(3, IEC, PO) for unit in units_of(part.tests)]
    assert sorted(found, key=str) == sorted(units, key=str)


def test_parts_cost_the_same():
    """No part costs more than another by more than the dearest unit."""
    costs = [[cost_s(unit) for unit in units_of(part.tests)] for part in parts(4, "es-nts-631-lt110kv")]
    sums = [sum(part) for part in costs]
    assert max(sums) - min(sums) <= max(max(part) for part in costs)


@pytest.mark.parametrize("text", ["0/2", "3/2", "2", "1/0", "a/b", "", "-1/2", "1/2/3", "1.0/2"])
def test_what_is_no_part(text):
    """It is refused with an example."""
    with pytest.raises(UsageError, match=rf"shard {text}: give the number of the part.*2/5"):
        make_job(Asked(profiles=(IEC,), shard=text))


def test_more_parts_than_there_can_be():
    """Whoever runs any of them learns how many there are at most."""
    for number in (1, 3):
        with pytest.raises(UsageError, match=rf"shard {number}/3: 4 tests make 2 parts at most"):
            make_job(Asked(profiles=(IEC,), tests=("VD6-*",), shard=f"{number}/3"))


@pytest.mark.parametrize("field", ["fail_fast", "last_failed", "failed_first"])
def test_what_goes_by_other_tests_does_not_go_with_parts(field):
    """Each part would come to something else than the whole run does."""
    with pytest.raises(UsageError, match=rf"{field} goes by what other tests have come to.*does not go with shard"):
        make_job(Asked(profiles=(IEC,), shard="1/2", **{field: True}), last_run="out")
