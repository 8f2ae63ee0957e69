"""A run that ends at the first failure, or that begins with what failed; no test is simulated."""

import json

import pytest

from pvlvrt_compliance.output import output_in
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.report.formats import results_json
from pvlvrt_compliance.results import Status, TestResult, Verdict, conclude, exit_status, worst
from pvlvrt_compliance.study import run as running_tests
from pvlvrt_compliance.study.baseline.files import update_file
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.run import Judged
from pvlvrt_compliance.study.running import run_job

IEC, PO = "iec61400-21", "es-po-12.3"


@pytest.fixture
def judged(monkeypatch):
    """Have tests judged as told, all others passed: ``judged["VD1-full-1"] = {"dc_ripple": Status.FAIL}``."""
    told, begun = {}, []

    def run_test(profile, test, _parameters, _simulator):
        begun.append(test.id)
        found = {"ride_through": Status.PASS, "dc_ripple": Status.PASS} | told.get(test.id, {})
        checks = tuple(Verdict(check=kind, status=status) for kind, status in found.items())
        status = worst(found.values())
        return Judged(TestResult(id=test.id, profile=profile.id, status=status, checks=checks), None)

    monkeypatch.setattr(running_tests, "run_test", run_test)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")  # no time that a test takes
    told["begun"] = begun
    return told


def results_of(*profiles, folder=None, **asked):
    """Results of a run."""
    allowed = asked.pop("allow_unjudged", False)
    job = make_job(Asked(profiles=profiles, **asked), last_run=None if folder is None else str(folder))
    output = None if folder is None else output_in(str(folder), len(job.tests))
    return run_job(job, command="", output=output, allow_unjudged=allowed)


def failed(folder, profile):
    """Leave results of a run in a folder, in which one test of a profile failed."""
    checks = (Verdict(check="dc_ripple", status=Status.FAIL),)
    results = conclude([TestResult(id="VD3-full-1", profile=profile, status=Status.FAIL, checks=checks)])
    (folder / "results.json").write_text(results_json.render(results), "utf-8")


def ids(results):
    """Ids of the tests, in the order of the report."""
    return [test.id for test in results.tests]


def test_it_ends_at_the_first_failure(judged):
    """Nothing is begun after it; what was finished is a whole result, which says where it ended, and before what."""
    judged["VD1-full-2"] = {"dc_ripple": Status.FAIL}
    results = results_of(IEC, tests=("VD1", "VD2-full-1"), fail_fast=True)
    assert ids(results) == judged["begun"] == ["VD1-full-1", "VD1-full-2"]
    assert exit_status(results) == 1
    assert results.ended_at == f"{IEC}.VD1-full-2"
    assert results.profiles[0].not_run == ("VD1-partial-1", "VD1-partial-2", "VD2-full-1")


@pytest.mark.parametrize(
    ("status", "allowed", "ends"),
    [
        (Status.FAIL, True, True),
        (Status.ERROR, True, True),
        (Status.NOT_EVALUATED, False, True),
        (Status.NOT_EVALUATED, True, False),
        (Status.NOT_APPLICABLE, False, False),
    ],
)
def test_what_ends_it_is_what_keeps_it_from_ending_with_0(judged, status, allowed, ends):
    """A failure, an error, and what could not be judged unless that is allowed."""
    judged["VD1-full-1"] = {"dc_ripple": status}
    results = results_of(IEC, tests=("VD1",), fail_fast=True, allow_unjudged=allowed)
    assert (len(results.tests) == 1) is ends is (exit_status(results) != 0)
    assert bool(results.ended_at) is ends


def test_where_nothing_fails_all_is_run(judged):
    """The result is the same as without."""
    assert results_of(IEC, fail_fast=True).run_id == results_of(IEC).run_id
    assert len(judged["begun"]) == 2 * 27


def test_what_the_baseline_knows_ends_nothing(judged, tmp_path):
    """A known failure is passed over; the first that is new ends the run."""
    judged["VD1-full-1"] = judged["VD2-full-1"] = {"dc_ripple": Status.FAIL}
    results_of(IEC, folder=tmp_path / "out", tests=("VD1",))
    done = update_file(str(tmp_path / "known.txt"), str(tmp_path / "out"))
    done.file.write_bytes(done.content)
    asked = {"tests": ("VD1-full", "VD2-full"), "baseline": str(done.file), "fail_fast": True}
    results = results_of(IEC, **asked)
    assert (ids(results), exit_status(results)) == (["VD1-full-1", "VD1-full-2", "VD2-full-1"], 1)
    assert results.tests[0].checks[1].known
    assert results.ended_at == f"{IEC}.VD2-full-1"


def test_a_row_that_is_judged_as_one_is_finished(judged):
    """Its rule needs all runs, and may let one off; the run ends behind the row."""
    judged["PVVC-1-1"] = {"dc_ripple": Status.FAIL}
    results = results_of(PO, fail_fast=True)
    assert ids(results) == ["PVVC-1-1", "PVVC-1-2", "PVVC-1-3"]
    assert [check.check for check in results.tests[-1].checks][-1] == "repeated_runs"


def test_a_run_that_is_let_off_ends_nothing(judged):
    """One run of three that was not ridden through, and four further ones that were: the next row is run."""
    judged["PVVC-1-2"] = {"ride_through": Status.FAIL}
    results = results_of(PO, tests=("PVVC-1", "PVVC-2"), fail_fast=True)
    assert len(results.tests) == 3 + 4 + 3
    assert results.ended_at == ""


def test_it_ends_whichever_profile_failed(judged):
    """Of several profiles the others have not run then, and say so."""
    judged["VD1-full-1"] = {"dc_ripple": Status.FAIL}
    results = results_of(PO, IEC, tests=(f"{IEC}.VD1", f"{PO}.PVVC-4"), fail_fast=True, last_failed=False)
    assert results.tests[-1].id == "VD1-full-1"
    assert [len(profile.not_run) for profile in results.profiles] == [0, 3]


def test_the_files_are_those_of_a_run(judged, tmp_path):
    """They are in their places, not among those of an interrupted run."""
    judged["VD1-full-1"] = {"dc_ripple": Status.FAIL}
    results = results_of(IEC, folder=tmp_path / "out", fail_fast=True)
    assert json.loads((tmp_path / "out" / "results.json").read_text("utf-8"))["run_id"] == results.run_id
    assert {"report.html", "junit.xml"} <= {path.name for path in (tmp_path / "out").iterdir()}
    assert not (tmp_path / "out" / "interrupted").exists()


def test_what_failed_is_run_first(judged, tmp_path):
    """The report keeps the order of the profile."""
    failed(tmp_path, profile=IEC)
    results = results_of(IEC, folder=tmp_path, failed_first=True)
    profile = [test.id for test in load_profile(IEC).tests()]
    assert ids(results) == profile
    # Runs of a row stay together, whichever of them failed.
    assert judged["begun"] == ["VD3-full-1", "VD3-full-2", *(name for name in profile if "VD3-full" not in name)]


def test_what_shares_a_record_goes_along(judged, tmp_path):
    """Another profile's test of the same scenario is judged at once, so that no record is kept for it."""
    other = load_profile(IEC).model_copy(update={"id": "other"})
    failed(tmp_path, profile="other")
    results = results_of(IEC, other, folder=tmp_path, failed_first=True, tests=("VD2-full", "VD3-full"))
    rows = ["VD3-full-1", "VD3-full-2"] * 2 + ["VD2-full-1", "VD2-full-2"] * 2
    assert judged["begun"] == rows
    names = [name for name in load_profile(IEC).tests() if name.id.startswith(("VD2-full", "VD3-full"))]
    assert [test.key for test in results.tests] == [f"{p}.{t.id}" for p in (IEC, "other") for t in names]
