"""`pvlvrt-check compare` on results that are there: what is a regression, what is refused, and what is printed."""

import pytest

from pvlvrt_compliance.results import ProfileSummary, Status, TestResult, Verdict, conclude, worst


def results_file(folder, *statuses, **more):
    """A `results.json` of one test with a verdict of each status."""
    checks = tuple(Verdict(check=f"check-{n}", status=status, **more) for n, status in enumerate(statuses))
    folder.mkdir(exist_ok=True)
    file = folder / "results.json"
    test = TestResult(id="VD1", profile="code", status=worst(statuses), checks=checks)
    file.write_text(conclude([test]).model_dump_json(), "utf-8")
    return file


def test_status_3_says_that_something_can_no_longer_be_judged(tmp_path, beside):
    """An error that was there before is none; a failure beside a new error is 3."""
    old = results_file(tmp_path / "a", Status.PASS, Status.PASS, Status.ERROR)
    new = results_file(tmp_path / "b", Status.FAIL, Status.ERROR, Status.ERROR)
    assert beside(old, new).status == 3
    assert beside(new, new).status == 0
    assert beside(old, new, "--exit-zero").status == 0


def test_a_margin_is_a_regression_where_it_is_asked_for(tmp_path, beside):
    """2 of 10 kW is a fifth."""
    numbers = {"limit": 10.0, "unit": "kW"}
    old = results_file(tmp_path / "a", Status.PASS, margin=5.0, **numbers)
    new = results_file(tmp_path / "b", Status.PASS, margin=3.0, **numbers)
    assert beside(old, new).status == 0
    assert beside(old, new, "--fail-on", "margin:21%").status == 0
    assert beside(old, new, "--fail-on", "margin:19%").status == 1


@pytest.mark.parametrize("left", ["test", "check", "interrupted"])
def test_what_was_not_selected_is_told_and_is_no_regression(tmp_path, beside, left):
    """A run of a part is compared by what it was asked for; what it has not come to is gone."""
    checks = (Verdict(check="a", status=Status.PASS), Verdict(check="b", status=Status.PASS))
    one, two = (TestResult(id=name, profile="code", status=Status.PASS, checks=checks) for name in ("one", "two"))
    aside = {"test": {"not_selected": ("two",)}, "check": {"selected_checks": ("a",)}}.get(left, {"not_run": ("two",)})
    part = [test.model_copy(update={"checks": checks[:1]}) for test in (one, two)] if left == "check" else [one]
    for name, tests, more in (("old", [one, two], {}), ("new", part, aside)):
        (tmp_path / name).mkdir()
        results = conclude(tests, [ProfileSummary(id="code", title="A code", digest="0", **more)])
        (tmp_path / name / "results.json").write_text(results.model_dump_json(), "utf-8")
    ended = beside(tmp_path / "old", tmp_path / "new")
    assert ended.status == (1 if left == "interrupted" else 0)
    said = "2 verdicts (tests: " in ended.out and "not selected in the new run are not compared" in ended.out
    assert said == (left != "interrupted")
    expected = {"test": {"code.two": ("a", "b")}, "check": {"code.one": ("b",), "code.two": ("b",)}}
    assert ended.comparison.not_selected == expected.get(left, {})


@pytest.mark.parametrize(
    ("names", "options", "said"),
    [
        (
            ("bundled", "x.so"),
            (),
            "bundled: no results (a results.json, or a folder that holds one); a controller is run",
        ),
        (("{empty}", "{file}"), (), "the folder has no results.json"),
        (("{file}", "missing.json"), (), "missing.json: cannot be read"),
        (("{file}", "{file}"), ("--fail-on", "margins"), "--fail-on margins: allowed are verdict and margin:SHARE"),
        (
            ("{file}", "{file}"),
            ("--profile", "nonesuch", "--scr", "7"),
            "--profile, --scr go with controllers, not with results: nothing is run",
        ),
        (("{file}", "{file}"), ("--config", "x.toml"), "--config goes with controllers, not with results"),
        (("{file}", "{file}"), ("--language", "xx"), "--language: no language 'xx'"),
        (("{file}", "{file}"), ("--output", "{folder}"), "holds the reports of a run"),
    ],
)
def test_what_cannot_be_compared_is_refused(tmp_path, command, names, options, said):
    """One line says what is allowed, and nothing is written."""
    file = results_file(tmp_path / "run", Status.PASS)
    (tmp_path / "empty").mkdir()
    places = {"empty": tmp_path / "empty", "file": file, "folder": tmp_path / "run"}
    output = () if "--output" in options else ("--output", tmp_path / "out")
    words = [str(word).format_map(places) for word in (*names, *options, *output)]
    status, _, err = command("compare", *words)
    assert status == 2
    assert said in err
    assert len(err.splitlines()) == 1
    assert not (tmp_path / "out").exists()
    assert {path.name for path in (tmp_path / "run").iterdir()} == {"results.json"}


def test_what_an_interrupted_run_has_finished_is_named(tmp_path, beside):
    """Its tests are in a folder of their own; to compare them is a choice."""
    results_file(tmp_path, Status.PASS)
    part = tmp_path / "run" / "interrupted"
    part.mkdir(parents=True)
    (tmp_path / "results.json").rename(part / "results.json")
    ended = beside(tmp_path / "run", tmp_path / "run")
    assert ended.status == 2
    assert str(part / "results.json") in ended.err
    assert beside(part, part).status == 0


def test_a_piped_table_breaks_no_line(tmp_path, beside):
    """Names stand whole in one line each, for grep, and in it no letter is lost."""
    old = results_file(tmp_path / "a", Status.PASS, message="x")
    new = results_file(tmp_path / "b", Status.FAIL)
    out = beside(old, new, "--quiet").out
    assert len(out.splitlines()) == 1
    out = beside(old, new).out
    assert any("check-0" in line and "pass" in line and "fail" in line for line in out.splitlines())
    assert max(map(len, out.splitlines())) > 80
