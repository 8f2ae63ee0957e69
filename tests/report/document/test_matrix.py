"""The matrix: a symbol where test and check meet, runs of one sag in one row, idle checks apart."""

from pvlvrt_compliance.report.document.matrix import matrices
from pvlvrt_compliance.results import ProfileSummary, Status, TestResult, Verdict, conclude

PASS, FAIL, IDLE = Status.PASS, Status.FAIL, Status.NOT_APPLICABLE


def _test(name, *checks, profile="p", point_on_wave=0.0, **fields):
    scenario = {"sag": {"depth": 0.5}, "point_on_wave_deg": point_on_wave} | fields.pop("scenario", {})
    return TestResult(id=name, profile=profile, scenario=scenario, status=PASS, checks=checks, **fields)


def _check(name, status=PASS, **fields):
    return Verdict(check=name, status=status, **fields)


def _groups(*tests):
    (matrix,) = matrices(conclude(tests))
    return [(group.name, [run.name for run in group.runs]) for group in matrix.groups]


def test_a_cell_is_the_worst_of_its_verdicts():
    """A check with a verdict for each stretch has one symbol; marginal is what one of them is."""
    near = _check("a", margin=0.1, uncertainty=0.2, limit=1.0, measured=0.9)
    (matrix,) = matrices(conclude([_test("t", near, _check("a", FAIL), _check("b"))]))
    assert [(cell.check, cell.status, cell.marginal) for cell in matrix.runs[0].cells] == [
        ("a", FAIL, True),
        ("b", PASS, False),
    ]
    assert matrix.runs[0].marks == ("marginal",)


def test_a_check_that_was_not_asked_leaves_its_cell_empty():
    """That is told from one that did not apply."""
    (matrix,) = matrices(conclude([_test("t", _check("a")), _test("s", _check("a", IDLE), _check("b"))]))
    assert [[cell.status for cell in run.cells] for run in matrix.runs] == [[PASS, None], [IDLE, PASS]]


def test_what_applied_nowhere_has_no_column():
    """It is named below, once for the profile."""
    (matrix,) = matrices(conclude([_test("t", _check("a"), _check("b", IDLE)), _test("s", _check("b", IDLE))]))
    assert (matrix.checks, matrix.idle) == (("a",), ("b",))


def test_runs_that_differ_in_the_point_on_wave_alone_are_one_row():
    """Next to each other and of one name; a sag, a demand or a K of another kind stands by itself."""
    first, second = _test("VD3-full-1"), _test("VD3-full-2", point_on_wave=90.0)
    assert _groups(first, second) == [("VD3-full", ["1", "2"])]
    for other in (
        _test("VD3-full-2", point_on_wave=90.0, scenario={"sag": {"depth": 0.6}}),
        _test("VD3-full-2", point_on_wave=90.0, expect="may_trip"),
        _test("VD3-full-2", point_on_wave=90.0, k_factor=3.0),
        _test("VD4-full-2", point_on_wave=90.0),
    ):
        assert _groups(first, other) == [("VD3-full-1", ["VD3-full-1"]), (other.id, [other.id])]


def test_one_symbol_can_stand_for_the_runs_of_a_row():
    """It is the worst of them, marginal where one is; a check that none of them was asked has none."""
    near = _check("a", margin=0.1, uncertainty=0.2, limit=1.0, measured=0.9)
    runs = [_test("V-1", near), _test("V-2", _check("a", FAIL), point_on_wave=90.0), _test("other", _check("b"))]
    (matrix,) = matrices(conclude(runs))
    whole, first, second = matrix.groups[0].columns
    assert [(cell.status, cell.marginal) for cell in first.each] == [(PASS, True), (FAIL, False)]
    assert (first.one.status, first.one.marginal) == (FAIL, True)
    assert second.one.status is None
    assert [cell.status for cell in whole.each] == [run.test.status for run in matrix.groups[0].runs]


def test_a_recording_is_a_row_of_its_own():
    """Nobody knows the scenario of a record from the field, nor whether two are of one."""
    tests = [TestResult(id=f"record-{n}", status=PASS) for n in (1, 2)]
    assert _groups(*tests) == [("record-1", ["record-1"]), ("record-2", ["record-2"])]


def test_a_title_is_what_the_runs_share():
    """The point on wave at its end is told with each run."""
    runs = [_test(f"V-{n}", title=f"phase c, full power, {90 * n} deg", point_on_wave=90.0 * n) for n in (0, 1)]
    (matrix,) = matrices(conclude(runs))
    assert matrix.groups[0].title == "phase c, full power"
    assert [run.point_on_wave_deg for run in matrix.runs] == [0.0, 90.0]


def test_every_profile_has_its_matrix_and_numbers_go_on():
    """A number is the place of the test in the whole report."""
    profiles = [ProfileSummary(id=name, title=name.upper(), digest="") for name in ("p", "q")]
    found = matrices(conclude([_test("a"), _test("a", profile="q"), _test("b", profile="q")], profiles))
    assert [(m.profile, m.title, [run.number for run in m.runs]) for m in found] == [
        ("p", "P", [1]),
        ("q", "Q", [2, 3]),
    ]
    assert found[1].count(PASS) == 2
