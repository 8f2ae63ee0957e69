"""Which tests of a profile are run."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.study.selection import Assignment, keep_short, select

PROFILE = load_profile("iec61400-21")
TESTS = [Assignment(PROFILE, test) for test in PROFILE.tests()]
IDS = [item.test.id for item in TESTS]


def ids(*patterns):
    """Ids of the tests that the patterns select."""
    return [item.test.id for item in select(TESTS, patterns)]


def test_no_pattern_selects_all():
    """Without a pattern the whole profile is run."""
    assert ids() == IDS


@pytest.mark.parametrize(
    ("patterns", "count"),
    [(["VD3*"], 4), (["*full*"], 12), (["VD?-partial-1"], 6), (["VD[12]-full-1"], 2), (["*"], 27), (["paper-*"], 3)],
)
def test_shell_patterns(patterns, count):
    """Star, question mark and brackets mean what they mean in a shell."""
    assert len(ids(*patterns)) == count


def test_patterns_add_up():
    """Several patterns select what any of them selects, each test once, in the profile's order."""
    assert ids("VD2-full-1", "VD1-full-1", "VD1-full-?") == ["VD1-full-1", "VD1-full-2", "VD2-full-1"]


@given(st.lists(st.sampled_from(IDS), min_size=1, unique=True))
def test_exact_ids_select_themselves(names):
    """Any set of ids selects exactly these, whatever their order and case."""
    assert ids(*(name.upper() for name in names)) == [name for name in IDS if name in names]


@pytest.mark.parametrize(
    ("pattern", "hint"),
    [
        ("VD3-ful-1", 'did you mean "VD3-full-1"'),
        ("xyz", "the profile has VD1-full-1 to paper-phase-c-50"),
        ("", "no test of this name"),
    ],
)
def test_pattern_that_matches_nothing(pattern, hint):
    """Every pattern must match, even beside one that does; the near misses are named."""
    with pytest.raises(UsageError, match=hint):
        select(TESTS, ["VD1*", pattern])


def test_profile_without_tests():
    """A pattern on a profile without tests is refused without a list of ids."""
    with pytest.raises(UsageError, match=r"^tests VD1: no test of this name"):
        select([], ["VD1"])


def test_a_pattern_with_the_profile():
    """The profile's id before a dot tells tests of several profiles apart."""
    assert ids("iec61400-21.VD3-*-1") == ["VD3-full-1", "VD3-partial-1"]


def test_long_tests_run_on_request():
    """A long test is left out unless a pattern names it in full."""
    long = Assignment(PROFILE, TESTS[0].test.model_copy(update={"id": "half-an-hour", "long": True}))
    assert keep_short([*TESTS, long], ()) == tuple(TESTS)
    assert keep_short([*TESTS, long], ["half*"]) == tuple(TESTS)
    assert keep_short([*TESTS, long], ["Half-an-Hour"])[-1] == long
