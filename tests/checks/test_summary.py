"""What a report is told of a profile: its head, and every clause that it knows."""

import pytest

from pvlvrt_compliance.checks.summary import clauses_of, summarise
from pvlvrt_compliance.data.marks import CONFIDENCES
from pvlvrt_compliance.profile import known_profiles, load_profile


def test_the_head_comes_with_the_summary():
    """Edition, place, plants and address are the profile's own, and what it does not judge."""
    profile = load_profile("es-nts-631-ge110kv")
    summary = summarise(profile, profile.tests())
    assert (summary.edition, summary.jurisdiction) == ("v2.0 (November 2020)", "Spain")
    assert summary.applies_to.voltage == "110 kV and above"
    assert [entry.what for entry in summary.not_covered] == [entry.what for entry in profile.not_covered]


@pytest.mark.parametrize("name", known_profiles())
def test_every_clause_is_told_once(name):
    """All that the resolved profile calls a clause is there, each once, and nothing else is."""
    profile = load_profile(name)
    told = [clause.clause for clause in clauses_of(profile)]
    assert len(set(told)) == len(told)
    tables = {row.steps.table for row in profile.rows if row.steps is not None}
    assert set(told) == (
        set(_clauses(profile.requirements.model_dump()))
        | {row.clause for row in profile.all_rows}
        | {profile.procedure.steps[table].clause for table in tables} - {""}
    )


def _clauses(data):
    """Every value of a key ``clause``, however deep."""
    if isinstance(data, dict):
        yield from (value for key, value in data.items() if key == "clause" and value)
        data = list(data.values())
    if isinstance(data, list | tuple):
        for part in data:
            yield from _clauses(part)


def test_one_clause_of_several_checks_is_one():
    """NTS 631 has the current of both sequences and its times in one clause; a row is told with its runs."""
    clauses = {each.clause: each for each in clauses_of(load_profile("es-nts-631-lt110kv"))}
    support = clauses["NTS 631 v2.0, 5.11.2.2.4"]
    assert support.checks == ("reactive_current", "negative_sequence_current", "support_dynamics")
    assert support.confidence == "chosen", "the weakest of all its numbers"
    assert clauses["NTS 631 v2.0, Tables 48 to 50, 53 and 54, U5TPmax"].tests == ("U5TPmax-1", "U5TPmax-2")


def test_a_part_of_a_requirement_has_its_own_clause():
    """Frequency bands that stand in another table than the demand are told by themselves, with their own mark."""
    clauses = {each.clause: each for each in clauses_of(load_profile("ieee1547-cat-ii"))}
    bands = clauses["IEEE 1547-2018, Table 19"]
    assert (bands.checks, bands.parts) == ((), ("frequency_ride_through.bands",))
    assert bands.confidence == "code"
    steps = clauses["IEEE 1547.1-2020, Tables 4 and 5"]
    assert steps.checks == ()
    assert steps.tests


def test_how_many_tests_could_judge_a_clause_is_told():
    """Rows may name the checks that judge them: power quality is judged in the steady tests alone."""
    profile = load_profile("ieee1547-cat-ii")
    clauses = {each.clause: each for each in clauses_of(profile)}
    assert clauses["IEEE 1547-2018, 7.3"].judged_tests == sum(
        "harmonics" in (test.checks or ("harmonics",)) for test in profile.tests()
    )
    nerc = load_profile("nerc-prc-029")
    frequency = next(each for each in clauses_of(nerc) if each.clause == "PRC-029-1, Table 3")
    assert frequency.judged_long == sum(test.long for test in nerc.tests()) > 0
    assert all(each.confidence in CONFIDENCES for each in clauses_of(nerc))
