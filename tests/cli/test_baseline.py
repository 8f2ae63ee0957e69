"""Known failures at the command line: the file is written, held against, and kept."""

import json
import re
from pathlib import Path

import pytest

from baselines import HEAD, case_of, run_of, verdict
from pvlvrt_compliance import check, exit_status
from pvlvrt_compliance.report.formats import results_json

EXAMPLE = Path(__file__).parents[2] / "examples" / "baseline" / "pvlvrt-baseline.txt"
ONE = ("--test", "VD1-full-1", "--waveforms", "none")


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An empty folder to work in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _write_results(*tests, folder="pvlvrt-report"):
    Path(folder).mkdir(exist_ok=True)
    (Path(folder) / "results.json").write_text(results_json.render(run_of(*tests)), "utf-8")


def _lines(file="pvlvrt-baseline.txt"):
    return [" ".join(line.split()) for line in Path(file).read_text("utf-8").splitlines()[4:]]


@pytest.mark.slow
def test_the_bundled_control_is_green_with_its_known_failures_named(command, here):
    """All runs of its profile, held against the file that ships as an example."""
    ended = command("--profile", "iec61400-21", "--waveforms", "none", "--baseline", EXAMPLE)
    said = " ".join(ended.out.split())
    assert ended.status == 0, ended
    assert re.search(r"known: 4 failures that \S+pvlvrt-baseline\.txt knows", said)
    assert "PASS by --baseline " in said
    found = json.loads((here / "pvlvrt-report" / "results.json").read_text("utf-8"))
    known = [(t["id"], c["check"]) for t in found["tests"] for c in t["checks"] if c["known"]]
    assert known == [(f"VD{n}-full-{k}", "current_limit") for n in (1, 4) for k in (1, 2)]
    assert all(c["known_reason"] for t in found["tests"] for c in t["checks"] if c["known"])
    assert (found["status"], found["baseline"]["better"], found["baseline"]["gone"]) == ("fail", [], [])
    checked = command("baseline", "update", EXAMPLE, "--check")
    assert (checked.status, checked.out) == (0, f"{EXAMPLE}: 4 lines: 0 added, 0 changed, 0 dropped\n")


def test_one_line_less_is_red(judge, tmp_path):
    """What the file does not name fails as without it; the other is known."""
    lines = EXAMPLE.read_text("utf-8").splitlines(keepends=True)
    file = tmp_path / "b.txt"
    file.write_text("".join(line for line in lines if "VD1-full-2" not in line), "utf-8")
    ended, reports = judge("--test", "VD1-full-*", "--waveforms", "none", "--baseline", str(file))
    assert ended.status == 1
    said = " ".join(ended.out.split())
    assert "fail: current_limit in VD1-full-2: " in said
    assert "fail: current_limit in VD1-full-1: " not in said
    cases = {
        case.get("classname"): [child.tag for child in case]
        for case in reports.junit.iter("testcase")
        if case.get("name") == "current_limit"
    }
    assert cases == {"iec61400-21.VD1-full-1": ["skipped"], "iec61400-21.VD1-full-2": ["failure"]}
    assert reports.json["baseline"]["gone"] == []  # VD4 was not selected, and is in the table


def test_a_run_that_ends_at_the_first_failure_does_not_end_at_a_known_one(judge):
    """Known failures let it go on."""
    ended, reports = judge("--test", "VD1-full-*", "--waveforms", "none", "--baseline", str(EXAMPLE), "--fail-fast")
    assert ended.status == 0
    assert len(reports.json["tests"]) == 2


@pytest.mark.parametrize(
    ("tolerance", "margin", "status"),
    [(None, "-0.070", 1), ("2%", "-0.070", 0), ("0", "-0.086", 0), ("0", "-0.085", 1)],
)
def test_how_much_may_be_lost(judge, tmp_path, tolerance, margin, status):
    """1 % of the limit, or as much as is asked for; what was rounded off the file is no loss."""
    file = tmp_path / "b.txt"
    file.write_text(f"{HEAD}iec61400-21.VD1-full-1 current_limit fail {margin} pu # why\n", "utf-8")
    given = () if tolerance is None else ("--baseline-tolerance", tolerance)
    ended, reports = judge(*ONE, "--baseline", str(file), *given)
    assert ended.status == status
    (found,) = [c for c in reports.test["checks"] if c["check"] == "current_limit"]
    assert (found["known"], bool(found["worse"])) == (status == 0, status == 1)


def test_what_is_better_is_told_with_the_command_that_updates_the_file(judge, tmp_path):
    """The line of the file is out of date; the run is green."""
    file = tmp_path / "a b.txt"
    lines = ("VD1-partial-1 current_limit fail -0.2 pu", "VD9 x fail")
    file.write_text(HEAD + "".join(f"iec61400-21.{line}\n" for line in lines), "utf-8")
    ended, reports = judge("--test", "VD1-partial-1", "--waveforms", "none", "--baseline", str(file))
    assert ended.status == 0
    said = " ".join(ended.out.split())
    assert "better: current_limit in iec61400-21.VD1-partial-1: was fail, -0.2 pu; now pass, +0." in said
    assert "gone: x in iec61400-21.VD9: was fail; now no such test" in said
    (update,) = [line for line in ended.out.splitlines() if line.startswith("To update the baseline: ")]
    assert update.endswith(f"pvlvrt-check baseline update '{file}' --results {reports.folder}")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--baseline", "no.txt"), "--baseline no.txt: cannot be read: No such file or directory"),
        (("--baseline", "bad.txt"), "--baseline bad.txt: 1 problem\n  bad.txt:3: verdict 'maybe' is unknown"),
        (("--baseline", "good.txt", "--baseline-tolerance", "5"), "--baseline-tolerance: '5' is outside 0% to 100%"),
        (("--baseline-tolerance", "5%"), "--baseline-tolerance needs --baseline"),
    ],
)
def test_what_cannot_be_used_is_told_before_anything_is_run(command, here, options, said):
    """With status 2, and nothing is written."""
    (here / "good.txt").write_text(HEAD, "utf-8")
    (here / "bad.txt").write_text(f"{HEAD}p.t x maybe\n", "utf-8")
    ended = command("--profile", "iec61400-21", "--sag", "90%", *options)
    assert ended.status == 2
    assert ended.err.startswith(f"pvlvrt-check: {said}")
    assert not (here / "pvlvrt-report").exists()


@pytest.mark.usefixtures("here")
def test_what_a_run_had_finished_is_held_against_its_baseline():
    """An interrupted run knows its known failures, and takes no test that it did not come to for gone."""

    def stop(*told):
        if told[1] == 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        check("iec61400-21", tests="VD1-full-*", baseline=EXAMPLE, output="out", waveforms="none", progress=stop)
    found = json.loads(Path("out/interrupted/results.json").read_text("utf-8"))
    assert [[c["known"] for c in t["checks"] if c["status"] == "fail"] for t in found["tests"]] == [[True]]
    assert found["baseline"]["gone"] == []


@pytest.mark.usefixtures("here")
def test_the_same_from_python():
    """A run is green by its file, and by its results the same run."""
    with_file = check("iec61400-21", tests="VD1-full-1", baseline=str(EXAMPLE), baseline_tolerance=0.02)
    without = check("iec61400-21", tests="VD1-full-1")
    assert (exit_status(with_file), exit_status(without)) == (0, 1)
    assert with_file.run_id == without.run_id
    assert with_file.baseline.tolerance == 0.02


def test_update_writes_and_tells_what_it_did(command, here):
    """Added, changed, dropped, kept, never known, without a reason."""
    _write_results(case_of("a", verdict()), case_of("b", verdict(), verdict("error", None, "y")))
    first = command("baseline", "update", "--reason", "ticket 42")
    assert first.out.splitlines() == [
        "+ x in p.a: fail, -1.00 kvar",
        "+ x in p.b: fail, -1.00 kvar",
        "pvlvrt-baseline.txt: 2 lines: 2 added, 0 changed, 0 dropped",
        "never known, since it could not be judged: y in p.b",
    ]
    assert _lines() == ["p.a x fail -1.00 kvar # ticket 42", "p.b x fail -1.00 kvar # ticket 42"]
    _write_results(case_of("a", verdict(margin=-2.0), verdict(check="z")), folder="other")
    second = command("baseline", "update", "pvlvrt-baseline.txt", "--results", "other/results.json")
    assert second.out.splitlines() == [
        "+ z in p.a: fail, -1.00 kvar",
        "~ x in p.a: fail, -2.00 kvar; was fail, -1.00 kvar",
        "pvlvrt-baseline.txt: 3 lines: 1 added, 1 changed, 0 dropped",
        "kept: 1 line, its test was not run (--prune drops them)",
        "without a reason: 1 failure; write it behind a # at the end of the line",
    ]
    assert _lines()[0] == "p.a x fail -2.00 kvar # ticket 42"
    assert command("baseline", "update", "--results", "other", "--prune").status == 0
    assert [line.split()[0] for line in _lines()] == ["p.a", "p.a"]
    assert list(here.glob(".*")) == []


@pytest.mark.usefixtures("here")
def test_a_link_stays_one_and_long_lists_are_cut(command):
    """What it leads to is written; the file has all lines, whatever is told."""
    _write_results(*(case_of(f"t{n}", verdict()) for n in range(103)))
    Path("b.txt").symlink_to("shared.txt")
    told = command("baseline", "update", "b.txt", "--reason", "why").out.splitlines()
    assert told[100:] == ["... and 3 lines more", "b.txt: 103 lines: 103 added, 0 changed, 0 dropped"]
    assert Path("b.txt").is_symlink()
    assert len(_lines("shared.txt")) == 103


@pytest.mark.usefixtures("here")
def test_check_writes_nothing(command):
    """It ends with 1 where the file would change, whatever ends its lines."""
    _write_results(case_of("a", verdict()))
    assert command("baseline", "update", "--check").status == 1
    assert not Path("pvlvrt-baseline.txt").exists()
    command("baseline", "update")
    written = Path("pvlvrt-baseline.txt").read_bytes()
    for content in (written, written.replace(b"\n", b"\r\n")):
        Path("pvlvrt-baseline.txt").write_bytes(content)
        assert command("baseline", "update", "--check").status == 0
        command("baseline", "update")
        assert Path("pvlvrt-baseline.txt").read_bytes() == content
    _write_results(case_of("a", verdict("pass", 1.0)))
    assert command("baseline", "update", "--check").status == 1
    assert Path("pvlvrt-baseline.txt").read_bytes() == content


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--results", "nowhere"), "nowhere: cannot be read"),
        (("--results", "bad.txt"), "bad.txt: no results of a run"),
        (("bad.txt",), "baseline bad.txt: 1 problem\n  bad.txt:1: no baseline"),
        (("--reason", "two\nlines"), "--reason: has a control character"),
        (
            ("no/such/folder/b.txt",),
            "pvlvrt-check: no/such/folder/b.txt: cannot be written (No such file or directory)",
        ),
    ],
)
def test_what_cannot_be_updated_is_left_as_it_is(command, here, arguments, said):
    """With status 2; a file that is no baseline is never written over."""
    _write_results(case_of("a", verdict()))
    (here / "bad.txt").write_text("my notes\n", "utf-8")
    ended = command("baseline", "update", *arguments)
    assert ended.status == 2
    assert said in ended.err
    assert (here / "bad.txt").read_text("utf-8") == "my notes\n"


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(
    "change", [lambda text: text.replace("  ", " "), lambda text: text.replace("# A line", "# Line")]
)
def test_where_only_the_form_differs_it_says_so(command, change):
    """Whoever reads that nothing was added, changed or dropped learns why the check is red."""
    _write_results(case_of("a", verdict()))
    command("baseline", "update")
    file = Path("pvlvrt-baseline.txt")
    written = file.read_text("utf-8")
    file.write_text(change(written), "utf-8")
    for options, status in ((("--check",), 1), ((), 0)):
        ended = command("baseline", "update", *options)
        assert ended.status == status
        assert "\nonly the form differs: " in ended.out
    assert file.read_text("utf-8") == written
    assert "form" not in command("baseline", "update").out


_OURS, _THEIRS = "p.a x fail -1.00 kvar # ours", "p.a x fail -2.00 kvar # theirs"
_MARKERS = ("<<<<<<< HEAD", "=======", ">>>>>>> theirs")


@pytest.mark.parametrize(
    ("broken", "by_hand"),
    [
        (f"{HEAD}<<<<<<< HEAD\n{_OURS}\n=======\n{_THEIRS}\n>>>>>>> theirs\n", f"{HEAD}{_OURS}\n"),
        (f"<<<<<<< HEAD\n{HEAD}{_OURS}\n=======\n{HEAD}{_THEIRS}\n>>>>>>> theirs\n", f"{HEAD}{_OURS}\n"),
        (f"{HEAD}{_OURS}\n{_THEIRS}\n", f"{HEAD}{_OURS}\n"),
        (f"{_OURS}\n", f"{HEAD}{_OURS}\n"),
        (f"{_OURS}\n", None),
        ("my notes\n", None),
    ],
)
def test_what_is_advised_of_a_broken_file_mends_it(command, here, broken, by_hand):
    """No advice is to run what has just refused the file: first it is mended by hand, or removed."""
    _write_results(case_of("a", verdict()))
    file = here / "pvlvrt-baseline.txt"
    file.write_text(broken, "utf-8")
    refused = command("baseline", "update")
    assert refused.status == 2
    for problem in refused.err.splitlines()[1:]:
        assert "remove" in problem.partition("pvlvrt-check baseline update")[0], problem
    assert sum("marker of a merge conflict; remove it" in line for line in refused.err.splitlines()) == sum(
        broken.count(marker) for marker in _MARKERS
    )
    file.unlink()
    if by_hand is not None:
        file.write_text(by_hand, "utf-8")
    assert command("baseline", "update").status == 0
    assert command("baseline", "update", "--check").status == 0


@pytest.mark.usefixtures("here")
def test_a_baseline_that_could_not_be_read_again_is_not_written(command):
    """It says what would make it smaller."""
    _write_results(*(case_of(f"t{'x' * 380}{n}", verdict("pass", 1.0)) for n in range(2600)))
    ended = command("baseline", "update", "--margins")
    assert ended.status == 2
    assert "would be larger than 1 MiB; --no-margins leaves out what passed" in ended.err
    assert not Path("pvlvrt-baseline.txt").exists()


def test_settings_say_where_the_files_are(command, here):
    """A team's file of settings names the baseline and the folder of the run; what is typed counts before it."""
    _write_results(case_of("a", verdict()), folder="build")
    (here / "pvlvrt.toml").write_text('baseline = "known.txt"\noutput = "build"\nsag = "90%"\n', "utf-8")
    assert command("baseline", "update", "--check").status == 1
    assert command("baseline", "update").err == "pvlvrt-check: settings of pvlvrt.toml (baseline, output)\n"
    assert _lines("known.txt") == ["p.a x fail -1.00 kvar"]
    assert command("baseline", "update", "other.txt", "--results", "build").status == 0
    assert _lines("other.txt") == _lines("known.txt")
    assert command("baseline", "update", "--isolated").status == 2
