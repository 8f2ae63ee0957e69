"""Whatever a file of others holds, or is called: it is shown as lines of text, and nothing in it is obeyed."""

import importlib
import json
import os
import pkgutil
import sys
import zipfile

import pytest

import pvlvrt_compliance
import worst
from pvlvrt_compliance.data.reader import Kind
from pvlvrt_compliance.results.files import RESULTS, SHARD
from told import BROKEN, FAILED, KNOWN, PASSED, UNJUDGED, WORSE, run_of, test_of

TEXT = json.dumps(worst.IN_TOML, ensure_ascii=False)
KEY = json.dumps(worst.IN_TOML.replace("\n", " "), ensure_ascii=False)
MAIN = ("--profile", "iec61400-21", "--sag", "50%")
PROFILE = f"""
schema_version = 1
id = "mine"
title = {TEXT}
include = ["iec61400-21"]
edition = {TEXT}
jurisdiction = {TEXT}
applies_to = {{ plant = {TEXT}, power = {TEXT}, voltage = {TEXT} }}
not_covered = [{{ what = {TEXT}, clause = {TEXT}, why = {TEXT} }}]

[requirements.current_limit]
clause = {TEXT}
source = {TEXT}
"""
EVENT = '[[events]]\nkind = "phase_jump"\nt_s = 0.0\nangle_deg = 10\n'

KINDS = {
    "a profile": (
        lambda file: ("profiles", "check", file),
        (
            PROFILE + f"{KEY} = 1\n",
            PROFILE.replace('"iec61400-21"', TEXT),
            PROFILE + f"[[tests]]\nid = {TEXT}\n",
            PROFILE + f"[requirements.{KEY}]\nclause = 3\n",
        ),
    ),
    "an events file": (
        lambda file: (*MAIN, "--events", file, "--list"),
        (
            f"[[events]]\nkind = {TEXT}\n",
            EVENT + f"{KEY} = {TEXT}\n",
            f'[[events]]\nkind = "playback"\nfile = {TEXT}\n',
            f"events = {TEXT}\n",
        ),
    ),
    "a mapping file": (
        lambda file: ("controllers", "inspect", f"stdio:{sys.executable} absent.py", "--mapping", file),
        (f"[inputs.{KEY}]\nsignal = {TEXT}\n{KEY} = 1\n", f"files = [{TEXT}]\n", f"output_kind = {TEXT}\n"),
    ),
    "a settings file": (
        lambda file: (*MAIN, "--list", "--config", file),
        (f"{KEY} = {TEXT}\n", f"profile = {TEXT}\n", f"set = {TEXT}\njobs = {TEXT}\n", f"[set]\n{KEY} = {TEXT}\n"),
    ),
}
"""By the words of the kind: the command that takes such a file, and what one may hold."""

OURS = {"a catalogue of texts"}


def kinds():
    """Words of every kind of file that somebody writes."""
    for module in pkgutil.walk_packages(pvlvrt_compliance.__path__, f"{pvlvrt_compliance.__name__}."):
        if "templates" not in module.name and not module.name.endswith("__main__"):
            loaded = importlib.import_module(module.name)
            yield from (each.one for each in vars(loaded).values() if isinstance(each, Kind))


def test_no_kind_of_file_is_left_out():
    """Whoever adds a kind of file says here what the worst of it is."""
    assert set(kinds()) - OURS == set(KINDS)


def check(ended, *, statuses=(0, 1, 2, 3)):
    """A documented status, and lines of text on both streams."""
    assert ended.status in statuses
    assert "Traceback" not in ended.err
    worst.of_a_terminal(ended.out)
    worst.of_a_terminal(ended.err)
    assert len(ended.err) < 30 * worst.LONGEST


@pytest.mark.parametrize(
    ("kind", "number"), [(kind, n) for kind, (_, all_of) in KINDS.items() for n in range(len(all_of))]
)
def test_what_a_file_holds(command, tmp_path, kind, number):
    """Values, keys and names are told with their file; whatever of them is in the message is a text to be shown."""
    asked, contents = KINDS[kind]
    file = tmp_path / f"mine{'.mapping' * (kind == 'a mapping file')}.toml"
    file.write_text(contents[number], "utf-8")
    ended = command(*asked(file))
    check(ended, statuses=(0, 2))  # 0: what is typed goes before what a file of settings says
    assert str(file) in ended.err


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    "content", [f"a = {TEXT}\n{KEY} =\n", "a = 1\n" + worst.IN_C, worst.IN_C], ids=["key", "text", "all"]
)
def test_what_is_no_toml(command, tmp_path, kind, content):
    """What cannot even be read is quoted no further than it can be shown."""
    file = tmp_path / f"mine{'.mapping' * (kind == 'a mapping file')}.toml"
    file.write_text(content, "utf-8")
    check(command(*KINDS[kind][0](file)), statuses=(2,))


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such names")
@pytest.mark.parametrize("kind", KINDS)
def test_how_a_file_is_called(command, tmp_path, kind):
    """A name is a text of others, too, whether the file is there or not."""
    file = tmp_path / f"{worst.NAME}.toml"
    for content in (None, "a = \n", EVENT if kind == "an events file" else "b = 1\n"):
        if content is not None:
            file.write_text(content, "utf-8")
        ended = command(*KINDS[kind][0](file))
        check(ended)
        assert ended.status == 0 or worst.MARK in ended.err


@pytest.fixture
def profile(tmp_path):
    """A profile that can be used, with such texts wherever it may have texts."""
    file = tmp_path / "mine.toml"
    file.write_text(PROFILE, "utf-8")
    return file


@pytest.mark.parametrize("more", [(), ("--json",)], ids=["words", "json"])
@pytest.mark.parametrize("what", ["show", "list", "tests"])
def test_what_a_profile_says(command, profile, what, more):
    """Its words, its row among others and its tests are shown; in JSON they are the same texts."""
    words = {"show": ("profiles", "show", profile), "list": ("profiles", "list")}
    ended = command(*words.get(what, ("--profile", profile, "--list")), *more, PVLVRT_PROFILES=str(profile.parent))
    check(ended, statuses=(0,))
    assert what == "tests" or worst.MARK in (
        ended.out if not more else json.dumps(json.loads(ended.out), ensure_ascii=False)
    )
    if more:
        worst.data(json.loads(ended.out))


@pytest.mark.parametrize("suffix", ["svg", "html", "png"])
def test_how_a_profile_is_drawn(command, profile, tmp_path, suffix):
    """A drawing is a file of texts as others are."""
    file = tmp_path / f"drawn.{suffix}"
    check(command("profiles", "plot", profile, "--output", file), statuses=(0,))
    worst.text_of(file)


def test_a_run_by_a_profile(command, profile, tmp_path):
    """Title, clauses and what is not covered are in the reports."""
    out, formats = tmp_path / "out", [word for name in ("markdown", "github", "gitlab") for word in ("--format", name)]
    check(command("--profile", profile, "--sag", "90%", "--output", out, "-v", *formats), statuses=(0, 1))
    worst.output_folder(out)
    for file in ("report.html", "results.json", "junit.xml"):
        assert worst.MARK in worst.text_of(out / file)


@pytest.mark.slow
def test_the_sheets_of_a_run_by_a_profile(command, profile, tmp_path):
    """The same texts as PDF."""
    pytest.importorskip("typst", reason="the extra pdf is not installed")
    run = ("--profile", profile, "--sag", "90%", "--output", tmp_path / "out", "--waveforms", "none")
    check(command(*run, "--format", "pdf"), statuses=(0, 1))
    assert worst.IN_SHEETS in worst.text_of(tmp_path / "out" / "report.pdf")


FORGED = f"{worst.IN_C}\x00{'y' * 20_000}"  # JSON has no halves of letters

KEPT = {"status", "bound", "schema_version", "kind", "there", "confidence", "language", "moved", "is", "origin"}
"""Keys whose values are words of ours: with others the file is no results."""


def changed(found, text, key=""):
    """Results in which every text is another."""
    if isinstance(found, str):
        return found if key in KEPT else text
    if isinstance(found, dict):
        return {name: changed(value, text, name) for name, value in found.items()}
    return [changed(value, text, key) for value in found] if isinstance(found, list) else found


@pytest.fixture
def runs(tmp_path):
    """Two runs that somebody has forged, in folders `old` and `new`."""
    checks = (PASSED, FAILED, KNOWN, WORSE, UNJUDGED, BROKEN)
    provenance = {
        "controller": "mine",
        "command": "pvlvrt-check",
        "parameters": {"a": {"b": 1.0}},
        "versions": {"x": "1"},
    }
    for name, value in (("old", -10.0), ("new", -11.0)):
        tests = test_of("t", *(each.model_copy(update={"margin": value}) for each in checks), title="t", clause="c")
        found = json.loads(run_of(tests, **provenance).model_dump_json())
        found = changed(found, FORGED)
        found["provenance"] |= {FORGED: name, "parameters": {FORGED: {FORGED: value}}}
        (tmp_path / name).mkdir()
        (tmp_path / name / RESULTS).write_text(json.dumps(found), "utf-8")
    return tmp_path


@pytest.mark.parametrize("more", [(), ("--quiet",), ("--language", "es")])
def test_forged_results_compared(command, runs, more):
    """Every text of a `results.json` may be anything."""
    ended = command("compare", runs / "old", runs / "new", "--output", runs / "out", *more)
    check(ended, statuses=(0, 1, 3))
    assert worst.MARK in worst.output_folder(runs / "out")


def test_forged_results_become_a_baseline(command, runs):
    """What is written is a file that can be read again."""
    file = runs / "baseline.txt"
    words = ("baseline", "update", file, "--results", runs / "new", "--reason", worst.IN_TOML.replace("\n", " "))
    check(command(*words), statuses=(0,))
    check(command("baseline", "update", file, "--results", runs / "new", "--check"), statuses=(0, 1))


def test_no_results(command, runs):
    """A file that is none is refused with a line, whatever is in it."""
    for content in (
        json.dumps({worst.WORST: 1, "tests": worst.WORST}),
        json.dumps({"status": worst.WORST}),
        worst.IN_C,
    ):
        (runs / "new" / RESULTS).write_text(content, "utf-8")
        ended = command("compare", runs / "old", runs / "new", "--output", runs / "out")
        check(ended, statuses=(2,))
        check(command("baseline", "update", runs / "b.txt", "--results", runs / "new"), statuses=(2,))


def test_a_forged_part_of_a_run(command, runs):
    """Head, results and what lies in a part may say anything."""
    head = {"shard": worst.WORST, worst.WORST: worst.WORST, "run_id": worst.WORST}
    with zipfile.ZipFile(runs / "new" / SHARD, "w") as file:
        file.writestr("head.json", json.dumps(head))
        file.writestr("made.json", "{}")
    check(command("merge", runs / "new", runs / "old", "--output", runs / "out"), statuses=(2,))


@pytest.mark.parametrize("place", ["reason", "name", "head", "verdict", "margin"])
def test_a_baseline(command, tmp_path, place):
    """Its names, reasons and whatever stands where they should."""
    line = worst.IN_TOML.replace("\n", " ")
    lines = {
        "reason": f"iec61400-21.sag-90pct-abc reactive_support fail -0.1 kvar # {line}",
        "name": f"{KEY} {KEY} fail -0.1 kvar",
        "verdict": f"a b {KEY} -0.1 kvar",
        "margin": f"a b fail {KEY} {KEY}",
    }
    head = f"# pvlvrt-baseline {line}" if place == "head" else "# pvlvrt-baseline 1"
    file = tmp_path / "baseline.txt"
    file.write_text(f"{head}\n\n{lines.get(place, '')}\n", "utf-8")
    ended = command(*MAIN, "--baseline", file, "--output", tmp_path / "out")
    check(ended, statuses=(0, 1, 2))
    if (tmp_path / "out").is_dir():
        worst.output_folder(tmp_path / "out")


@pytest.mark.parametrize("suffix", ["csv", "cfg"])
def test_a_recording(command, tmp_path, suffix):
    """Names of channels, and whatever else its head says."""
    text = worst.IN_TOML.replace("\n", " ").replace(",", "")
    (tmp_path / f"r.{suffix}").write_text(
        f"t_s,{text},u_a_v\n0,{text},1\n" if suffix == "csv" else f"{text},{text},2013\n1,1A,0D\n1,{text},,,V,x\n",
        "utf-8",
    )
    file = tmp_path / "events.toml"
    file.write_text(f'[[events]]\nkind = "playback"\nfile = "r.{suffix}"\nt_s = 0\n', "utf-8")
    check(command(*MAIN, "--events", file, "--output", tmp_path / "out"), statuses=(2,))
