"""Which tests of a profile are run."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.study.selection import Assignment, judge_only, keep_short, kinds_judged, select, skip

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


@pytest.mark.parametrize(
    ("pattern", "found"),
    [
        ("VD3-full", ["VD3-full-1", "VD3-full-2"]),
        ("vd3", ["VD3-full-1", "VD3-full-2", "VD3-partial-1", "VD3-partial-2"]),
        ("iec61400-21.VD3-partial", ["VD3-partial-1", "VD3-partial-2"]),
        ("VD[34]-full", ["VD3-full-1", "VD3-full-2", "VD4-full-1", "VD4-full-2"]),
        ("paper-phase-c-90", ["paper-phase-c-90"]),
    ],
)
def test_a_row_stands_for_its_runs(pattern, found):
    """At one power, or as the test table names it at all of them; patterns match the ids of rows, too."""
    assert ids(pattern) == found


def test_a_long_row_is_named_by_its_row():
    """The id of a row asks for its long runs as the id of one of them does."""
    long = Assignment(PROFILE, TESTS[0].test.model_copy(update={"long": True}))
    assert keep_short([long], ["VD1-full"]) == (long,)


def skipped(patterns, found=TESTS):
    """Ids of what is left when the patterns are skipped."""
    return [item.test.id for item in skip(found, patterns, TESTS)]


@given(st.lists(st.sampled_from(["VD1", "VD2-*", "vd3-full", "paper-*", "VD4-full-1"]), max_size=4))
def test_what_is_skipped_is_what_would_be_selected(patterns):
    """Selecting and skipping divide the tests between them, each once and in order."""
    selected = ids(*patterns) if patterns else []
    assert sorted([*selected, *skipped(patterns)], key=IDS.index) == IDS


def test_what_nobody_selected_may_be_skipped():
    """A pattern is of all tests: settings that skip a test do not forbid to select others."""
    assert skipped(["VD1"], select(TESTS, ["VD3-full"])) == ["VD3-full-1", "VD3-full-2"]


@pytest.mark.parametrize(
    ("patterns", "says"),
    [
        (["VD1", "VD3-ful"], r'^skip VD3-ful: no test of this name; did you mean "VD3-full"'),
        (["*"], r"^skip \*: all 27 tests selected are skipped$"),
    ],
)
def test_what_cannot_be_skipped(patterns, says):
    """A pattern that matches nothing is a mistake, and so is a run of nothing."""
    with pytest.raises(UsageError, match=says):
        skipped(patterns)


def judged(*names, profile=PROFILE):
    """Tests that are left for these checks, with what each is judged by."""
    items = [Assignment(profile, test) for test in profile.tests()]
    return {
        item.test.id: [kind for kind, _ in profile.requirements.by_kind() if item.test.judges(kind)]
        for item in judge_only([profile], items, names)
    }


def test_only_the_checks_that_are_named_judge():
    """All tests that they judge are left, in order, and nothing else is judged in them."""
    assert list(judged("dc_ripple", "current_limit").items()) == [
        (name, ["current_limit", "dc_ripple"]) for name in IDS
    ]
    assert judge_only([PROFILE], TESTS, ()) == tuple(TESTS)


def test_a_test_that_none_of_them_judges_is_left_out():
    """A row that names its checks is judged by no other."""
    profile = load_profile("ieee1547-cat-iii")
    kind = "frequency_ride_through"
    expected = [test.id for test in profile.tests() if test.checks is None or kind in test.checks]
    assert list(judged(kind, profile=profile)) == expected
    assert 0 < len(expected) < len(profile.tests())


def test_a_rule_on_rows_goes_with_the_connection():
    """It counts what the checks of the connection say, so that these are judged, too; not the other way round."""
    profile = load_profile("es-po-12.3")
    assert kinds_judged(profile, ["repeated_runs"]) == ("ride_through", "repeated_runs")
    assert kinds_judged(profile, ["ride_through"]) == ("ride_through",)
    assert kinds_judged(profile, ["dc_ripple"]) == ()
    assert kinds_judged(profile, []) == ()


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("dc_riple", r'^checks dc_riple: no check of iec61400-21; did you mean "dc_ripple"\?$'),
        ("xyz", r"^checks xyz: no check of iec61400-21; there are: ride_through, "),
    ],
)
def test_a_check_that_there_is_not(name, says):
    """The message names the near misses, else all of them."""
    with pytest.raises(UsageError, match=says):
        judged("dc_ripple", name)


def test_a_check_that_judges_none_of_the_tests():
    """It is refused: nothing would be shown."""
    profile = load_profile("ieee1547-cat-iii")
    items = [Assignment(profile, test) for test in profile.tests() if "harmonics" not in test.checks]
    with pytest.raises(UsageError, match=f"^checks harmonics: judges none of the {len(items)} tests selected$"):
        judge_only([profile], items, ["harmonics"])
