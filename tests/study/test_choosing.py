"""Which tests a job has, by what is asked for and by what the last run has left unsettled."""

import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.report.formats import results_json
from pvlvrt_compliance.results import Status, TestResult, Verdict, conclude
from pvlvrt_compliance.study.job import Asked, make_job

IEC, PO = "iec61400-21", "es-po-12.3"


def job(folder=None, profiles=(IEC,), **asked):
    """A job of these profiles, after a run into this folder."""
    return make_job(Asked(profiles=profiles, **asked), last_run=None if folder is None else str(folder))


def ids(items):
    """Ids of tests."""
    return [item.test.id for item in items]


def ran(folder, profile=IEC, **found):
    """Write the results of a run into a folder: the verdict, or several, of each test by its id."""
    tests = [
        TestResult(
            id=name.replace("_", "-"),
            profile=profile,
            status=Status.PASS,
            checks=tuple(v if isinstance(v, Verdict) else Verdict(check="dc_ripple", status=v) for v in verdicts),
        )
        for name, verdicts in found.items()
    ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "results.json").write_text(results_json.render(conclude(tests)), "utf-8")
    return folder


def test_every_test_is_told_once():
    """What is run, what is left out for its length, and what was not selected are all tests of the profiles."""
    made = job(profiles=("nerc-prc-029", IEC), tests=("VD3", "0.705pu*", "*-1800s"), skip=("VD3-full-2", "*bc*"))
    parts = (made.tests, made.left_out, made.not_selected)
    keys = [item.key for part in parts for item in part]
    everything = [item.key for item in job(profiles=("nerc-prc-029", IEC), include_long=True).tests]
    assert sorted(keys) == sorted(everything)
    assert all(parts)
    assert all(item.test.long for item in made.left_out)
    assert "VD3-full-2" in ids(made.not_selected)


def test_what_a_check_leaves_out_is_told():
    """Tests that none of the checks judges are not run; a note says how many."""
    made = job(profiles=("ieee1547-cat-iii",), checks=("harmonics",))
    assert {item.test.only for item in made.tests} == {("harmonics",)}
    left_out = len(made.not_selected)
    assert left_out > 0
    (note,) = made.notes
    assert note == f"checks: judges nothing in {left_out} of {left_out + len(made.tests)} tests, which are left out"


def test_a_sag_of_ones_own_may_be_judged_by_some_checks():
    """Checks select among demands, which a sag of one's own is judged by, too."""
    (item,) = job(sag=0.5, checks=("dc_ripple",)).tests
    assert item.test.only == ("dc_ripple",)


@pytest.mark.parametrize("field", ["tests", "skip", "last_failed", "failed_first"])
def test_what_selects_among_the_tests_of_a_profile_needs_them(field):
    """With a sag of one's own there is nothing to select from."""
    with pytest.raises(UsageError, match=f"^{field} selects from the profile's own tests; it does not go with sag$"):
        job("", sag=0.5, **{field: ("VD1",) if field in {"tests", "skip"} else True})


def test_what_was_not_passed_the_last_time(tmp_path):
    """A failure, an error and what could not be judged; what passed, did not apply or is known is left."""
    ran(
        tmp_path,
        VD1_full_1=[Status.PASS, Status.FAIL],
        VD1_full_2=[Verdict(check="current_limit", status=Status.FAIL, known=True)],
        VD2_full_1=[Status.PASS],
        VD2_full_2=[Status.NOT_APPLICABLE, Status.PASS],
        VD3_full_1=[Status.ERROR],
        VD3_full_2=[Status.NOT_EVALUATED],
        gone=[Status.FAIL],
    )
    made = job(tmp_path, last_failed=True)
    assert ids(made.tests) == ["VD1-full-1", "VD3-full-1", "VD3-full-2"]
    assert len(made.not_selected) == 24
    assert made.notes == ("last_failed: 3 of the 27 tests selected were not passed the last time",)
    assert ids(job(tmp_path, last_failed=True, tests=("VD1", "VD2")).tests) == ["VD1-full-1"]


def test_what_was_not_passed_comes_first_on_request(tmp_path):
    """All tests are run; the job says which of them before the others."""
    made = job(ran(tmp_path, VD3_full_1=[Status.FAIL]), failed_first=True)
    assert len(made.tests) == 27
    assert set(made.first) == {f"{IEC}.VD3-full-1"}
    assert made.notes == ("failed_first: 1 of the 27 tests selected was not passed the last time; it goes first",)


@pytest.mark.parametrize(("found", "says"), [(None, "no results of a run yet"), ({}, "none of the tests selected")])
@pytest.mark.parametrize("field", ["last_failed", "failed_first"])
def test_where_nothing_failed_all_is_run(tmp_path, field, found, says):
    """No results of a run, or none that failed: all tests, and a note says why."""
    if found is not None:
        ran(tmp_path, VD1_full_1=[Status.PASS], gone=[Status.FAIL])
    made = job(tmp_path, **{field: True})
    assert (len(made.tests), set(made.first)) == (27, set())
    (note,) = made.notes
    assert note.startswith(f"{field}: {tmp_path}/results.json: {says}")
    assert note.endswith("; all are run")


def test_the_last_run_may_have_been_interrupted(tmp_path):
    """What it had finished counts; of the rest, what the whole run before it found."""
    ran(tmp_path, VD1_full_1=[Status.FAIL], VD2_full_1=[Status.FAIL], VD3_full_1=[Status.PASS])
    ran(tmp_path / "interrupted", VD1_full_1=[Status.PASS], VD3_full_1=[Status.FAIL])
    assert ids(job(tmp_path, last_failed=True).tests) == ["VD2-full-1", "VD3-full-1"]


def test_a_long_test_that_failed_is_run_again(tmp_path):
    """It was asked for when it failed."""
    profile = "nerc-prc-029"
    long = next(item.test.id for item in job(profiles=(profile,)).left_out)
    ran(tmp_path, profile, **{long: [Status.FAIL]})
    made = job(tmp_path, profiles=(profile,), last_failed=True)
    assert (ids(made.tests), made.left_out) == ([long], ())


@pytest.mark.parametrize("failed", ["PVVC-1-2", "PVVC-1-further-3"])
def test_a_row_that_is_judged_as_one_is_run_as_a_whole(tmp_path, failed):
    """One run of a row that failed, or a further one, brings back all of its runs: the rule needs them."""
    ran(tmp_path, PO, **{failed: [Status.FAIL]})
    assert ids(job(tmp_path, (PO,), last_failed=True).tests) == ["PVVC-1-1", "PVVC-1-2", "PVVC-1-3"]


def test_who_brings_a_row_back_is_told(tmp_path):
    """What failed and what is run besides it are two numbers: a run of which nothing was found did not fail."""
    only = ran(tmp_path / "one", PO, **{"PVVC-1-2": [Status.FAIL]})
    said = "1 test was not passed the last time; with the other runs of its row 3 of the 12 tests selected"
    assert job(only, (PO,), last_failed=True).notes == (f"last_failed: {said} are run",)
    assert job(only, (PO,), failed_first=True).notes == (f"failed_first: {said} go first",)
    further = ran(tmp_path / "further", PO, **{"PVVC-1-further-3": [Status.FAIL]})
    assert job(further, (PO,), last_failed=True).notes == (f"last_failed: {said} are run",)
    two = ran(tmp_path / "two", PO, **{"PVVC-1-2": [Status.FAIL], "PVVC-2-1": [Status.ERROR]})
    said = "2 tests were not passed the last time; with the other runs of their rows 6 of the 12 tests selected"
    assert job(two, (PO,), last_failed=True).notes == (f"last_failed: {said} are run",)
    whole = ran(tmp_path / "whole", PO, **{f"PVVC-1-{k}": [Status.FAIL] for k in (1, 2, 3)})
    assert job(whole, (PO,), last_failed=True).notes == (
        "last_failed: 3 of the 12 tests selected were not passed the last time",
    )


def test_the_last_run_is_the_last_one_whatever_it_ran(tmp_path):
    """A later run of another part takes its place: what failed before that is told by no file, and all is run."""
    ran(tmp_path, VD1_full_1=[Status.FAIL])
    ran(tmp_path, VD3_full_1=[Status.PASS])
    assert len(job(tmp_path, last_failed=True).tests) == 27


def test_the_last_run_needs_a_folder():
    """Without one nobody knows what failed."""
    with pytest.raises(UsageError, match=r"^last_failed: needs output, the folder of the last run$"):
        job(last_failed=True)


def test_results_that_cannot_be_read(tmp_path):
    """A file that holds no results is named, and nothing is run."""
    (tmp_path / "results.json").write_text("[]", "utf-8")
    with pytest.raises(UsageError, match=r"results\.json: no results of a run"):
        job(tmp_path, last_failed=True)
