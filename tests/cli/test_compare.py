"""`pvlvrt-check compare`: runs that were made, controllers that are run for it, and what is written."""

import json
import shutil
import sys

import pytest

from declared import only_extras
from pvlvrt_compliance import compare, comparison_status, read_results
from pvlvrt_compliance.results import Status

FILES = {"comparison.html", "comparison.json", "comparison.md", "junit.xml"}
SAG = ("--profile", "iec61400-21", "--sag", "10%", "--duration", "200ms", "--quiet")


@pytest.fixture(scope="module")
def made(tmp_path_factory, command):
    """A run of one short sag, and one of the same sag with support from 0.95 pu on: V+ is 0.9 pu in it."""
    folder = tmp_path_factory.mktemp("runs")
    for name, options in (("old", ()), ("new", ("--set", "controller.fault_threshold_pu=0.95"))):
        command(*SAG, *options, "--output", folder / name)
    return folder


def test_two_runs_side_by_side(made, beside):
    """Support that nobody asked for is found, drawn with both waveforms, and the parameter that made it named."""
    ended = beside(made / "old", made / "new")
    (worse,) = [one for one in ended.comparison.of("verdict") if one.regression and one.check == "reactive_support"]
    assert (worse.old.status, worse.new.status) == (Status.PASS, Status.FAIL)
    assert ended.status == 1
    assert {path.name for path in ended.folder.iterdir()} == FILES
    (parameter,) = [one for one in ended.comparison.differences if one.path.startswith("parameters.")]
    assert (parameter.path, parameter.old, parameter.new) == (
        "parameters.controller.fault_threshold_pu",
        0.85,
        0.95,
    )
    assert "parameters.controller.fault_threshold_pu: 0.85 -> 0.95" in ended.out
    headings = [heading.text_content() for heading in ended.page.xpath("//h4[starts-with(@id, 'overlay-')]")]
    assert headings
    assert headings[0].startswith("Reactive power during a sag, iec61400-21.sag-10pct-abc")
    assert "Q, old" in ended.page.text_content()


def test_what_became_better_is_drawn_too(made, beside):
    """Kind by kind, the worse ones first, each figure under the heading of its kind."""
    ended = beside(made / "new", made / "old")
    headed = [part.text_content() for part in ended.page.xpath("//section[@aria-labelledby='overlays']//h3 | //h4")]
    kinds = ["worse verdicts", "better verdicts", "margins gained"]
    found = [text for text in headed if text in kinds]
    assert found == kinds
    figure = headed[headed.index("better verdicts") + 1]
    assert figure.startswith("Reactive power during a sag, iec61400-21.sag-10pct-abc")
    marked = " ".join(ended.page.text_content().split())
    (better,) = [one for one in ended.comparison.of("verdict") if one.check == "reactive_support"]
    assert f"old run worst at {better.old.at_s:.3f} s" in marked


def test_a_run_beside_itself_is_no_regression(made, beside):
    """Nothing is worse, nothing is drawn, nothing differs."""
    ended = beside(made / "old", made / "old" / "results.json", "--fail-on", "margin:0%")
    assert ended.status == 0
    assert ended.comparison.changes == ended.comparison.differences == ()
    assert "NO REGRESSION" in ended.out
    assert "<svg" not in (ended.folder / "comparison.html").read_text("utf-8")


def test_the_same_comparison_twice_is_the_same_bytes(made, beside):
    """Every file is written anew, and alike; nothing of the staging stays."""
    before = {path.name: path.read_bytes() for path in beside(made / "old", made / "new").folder.iterdir()}
    after = {path.name: path.read_bytes() for path in beside(made / "old", made / "new").folder.iterdir()}
    assert before == after


@pytest.mark.parametrize("lost", ["waveforms", "record"])
def test_without_waveforms_the_reason_is_said(made, beside, tmp_path, lost):
    """What cannot be drawn is left out, and all else is told."""
    copy = tmp_path / "new"
    shutil.copytree(made / "new", copy)
    if lost == "waveforms":
        shutil.rmtree(copy / "waveforms")
    else:
        found = json.loads((copy / "results.json").read_text("utf-8"))
        found["tests"][0]["waveforms"] = None
        (copy / "results.json").write_text(json.dumps(found), "utf-8")
    ended = beside(made / "old", copy)
    assert ended.status == 1
    said = " ".join(ended.page.xpath("//ul[@class='nofigure']")[0].text_content().split())
    assert said == (
        f"{copy / 'waveforms' / 'sag-10pct-abc.cfg'} is not there"
        if lost == "waveforms"
        else f"{copy} kept no waveforms of some tests (--waveforms all keeps them)"
    )
    assert [line for line in ended.out.splitlines() if line.startswith("Not drawn")] == [f"Not drawn: {said}"]


def test_no_file_outside_of_the_folder_is_opened(made, beside, tmp_path):
    """A path in a foreign file leads nowhere else."""
    copy = tmp_path / "new"
    shutil.copytree(made / "new", copy)
    found = json.loads((copy / "results.json").read_text("utf-8"))
    found["tests"][0]["waveforms"] = "../../old/waveforms/sag-10pct-abc.cfg"
    (copy / "results.json").write_text(json.dumps(found), "utf-8")
    assert "names waveforms outside of its folder" in beside(made / "old", copy).page.text_content()


def test_an_installation_without_extras_draws(made, beside, monkeypatch):
    """What a run writes is read by what every installation has."""
    for name in only_extras():
        monkeypatch.setitem(sys.modules, name, None)
    ended = beside(made / "old", made / "new")
    assert ended.status == 1
    assert ended.page.xpath("//h4[starts-with(@id, 'overlay-')]")
    assert not ended.page.xpath("//*[@class='nofigure']")
    assert "Not drawn" not in ended.out


def test_python_compares_what_the_command_compares(made, beside):
    """Results, files and folders give the same object."""
    told = beside(made / "old", made / "new").comparison
    for old, new in ((made / "old", str(made / "new")), (made / "old" / "results.json", made / "new")):
        found = compare(old, new)
        assert (found.changes, found.differences) == (told.changes, told.differences)
        assert comparison_status(found) == 1
    assert compare(*(read_results(made / name / "results.json") for name in ("old", "new"))).changes == told.changes


def test_controllers_are_run_and_compared(beside, tmp_path, monkeypatch):
    """Each runs into a folder of its own, by options and settings of the main command; then they are compared.

    Of the settings only what says how controllers are run has a meaning here.
    """
    monkeypatch.chdir(tmp_path)
    written = 'profile = "spain-q-curve"\nsag = "10%"\nwaveforms = "none"\noutput = "elsewhere"\ncontroller = "x.so"\n'
    (tmp_path / "pvlvrt.toml").write_text(written, "utf-8")
    ended = beside("bundled", "bundled", "--duration", "60ms")
    assert ended.status == 0, ended.err
    assert "settings of pvlvrt.toml (profile, sag, waveforms)" in ended.err
    assert {path.name for path in ended.folder.iterdir()} == {*FILES, "old", "new"}
    old, new = (read_results(ended.folder / name / "results.json") for name in ("old", "new"))
    assert old.run_id == new.run_id
    assert old.provenance["settings"]["values"].keys() == {"profile", "sag", "waveforms"}
    assert [test.scenario["duration_s"] for test in old.tests] == [0.06]
    assert ended.comparison.changes == ()


def test_a_controller_that_cannot_be_opened_is_told_before_anything_runs(beside, tmp_path):
    """Neither run has begun, and nothing is written."""
    ended = beside("bundled", tmp_path / "none.so", *SAG)
    assert ended.status == 2
    assert "there is no file" in ended.err
    assert not ended.folder.exists()


def test_an_interruption_keeps_what_is_finished(beside, monkeypatch):
    """The old run stays whole in its folder, an earlier comparison does not stay beside it, and the status is 130."""
    from pvlvrt_compliance.study import comparing

    whole = comparing.run_job

    def run_job(job, *, output, **more):
        if output.folder.endswith("new"):
            end = KeyboardInterrupt()
            end.add_note("0 of 1 tests were finished, nothing was written")
            raise end
        return whole(job, output=output, **more)

    options = ("--profile", "spain-q-curve", "--sag", "10%", "--duration", "60ms", "--waveforms", "none")
    monkeypatch.setattr(comparing, "run_job", run_job)
    ended = beside("bundled", "bundled", *options)
    assert ended.status == 130
    assert "0 of 1 tests were finished" in ended.err
    assert {path.name for path in ended.folder.iterdir()} == {"old"}
    assert read_results(ended.folder / "old" / "results.json").tests
