"""`--shard` and `merge`: parts of a run, and the run that they make."""

import json
import os
import shutil
from zipfile import ZIP_DEFLATED, ZipFile

import pytest

pytestmark = pytest.mark.slow

WHOLE = ("--profile", "iec61400-21", "--test", "VD[46]-full-*", "--waveforms", "failed", "--csv", "-q")


@pytest.fixture(scope="module")
def made(command, tmp_path_factory):
    """Folder with the whole run in `whole/out`, and its parts in `1/out` and `2/out`; what the run said."""
    folder, said = tmp_path_factory.mktemp("parts"), {}
    with pytest.MonkeyPatch.context() as here:
        for name, more in (("whole", ()), ("1", ("--shard", "1/2")), ("2", ("--shard=2/2", "--exit-zero"))):
            (folder / name).mkdir()
            here.chdir(folder / name)
            said[name] = command(*WHOLE, *more, "--output", "out", SOURCE_DATE_EPOCH="1700000000")
    return folder, said


@pytest.fixture
def merge(command, made, tmp_path, monkeypatch):
    """Merge copies of parts that something is done to: ``merge(change, *names) -> its end``; the result is in `out`."""
    folder, _ = made
    monkeypatch.chdir(tmp_path)

    def merge(change=None, names=("1", "2"), more=()):
        for name in ("1", "2"):
            shutil.copytree(folder / name / "out", tmp_path / name)
        if change:
            change(tmp_path / "2")
        return command("merge", *names, *more, "--output", "out", "-q", SOURCE_DATE_EPOCH="1700000000")

    return merge


def files(folder):
    """Content by name."""
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("names", [("1", "2"), ("2", "1")])
def test_parts_make_the_run_that_they_are_of(made, merge, tmp_path, names):
    """Status, words and every byte are those of one run, in whatever order the parts are named."""
    folder, said = made
    assert merge(names=names) == said["whole"]
    assert files(tmp_path / "out") == files(folder / "whole" / "out")
    assert said["whole"].status == 1


def test_the_whole_may_have_more_formats(made, merge, tmp_path):
    """One that shows no figures is made of what the parts have found, and is in the recorded command."""
    folder, said = made
    assert merge(more=("--format", "markdown", "--format", "html")).status == said["whole"].status
    found, whole = files(tmp_path / "out"), files(folder / "whole" / "out")
    assert found.keys() - whole.keys() == {"report.md"}
    command = json.loads(found["results.json"])["provenance"]["command"]
    assert command.endswith("--output out --format markdown --format html")


def test_figures_of_another_form_are_not_there(merge):
    """They were to be made with the records."""
    ended = merge(more=("--format", "pdf"))
    said = "pvlvrt-check: --format pdf: its figures are made with the records: give it with the parts\n"
    assert (ended.status, ended.err) == (2, said)


def test_a_part_says_that_it_is_one(made):
    """What is in the other is not selected here; each has tests, and the parts share none."""
    folder, _ = made
    found = [json.loads((folder / name / "out" / "results.json").read_text("utf-8")) for name in ("1", "2")]
    ids = [{test["id"] for test in part["tests"]} for part in found]
    assert [len(part) for part in ids] == [2, 2]
    assert not ids[0] & ids[1]
    for part, other in zip(found, reversed(ids), strict=True):
        assert other <= set(part["profiles"][0]["not_selected"])
    assert "--shard 1/2" in found[0]["provenance"]["command"]
    assert "--shard=2/2" in found[1]["provenance"]["command"]


def replaced(name, old, new):
    """A change of a file."""

    def change(folder):
        text = (folder / name).read_text("utf-8")
        assert old in text
        (folder / name).write_text(text.replace(old, new), "utf-8")

    return change


def with_record(name):
    """A change of the name of a test's record."""
    return replaced("results.json", '"wall_time_s"', f'"waveforms": "{name}", "wall_time_s"')


def linked_record(folder):
    """Records of either part that are links to a file of somebody else's."""
    for file in folder.parent.glob("*/waveforms/*"):
        file.unlink()
        file.symlink_to("/etc/passwd")


def with_head(**values):
    """A change of what a part says of the whole."""
    return repacked(lambda head, made: (head | values, made))


def with_made(content):
    """A change of what was made of its records."""
    return repacked(lambda head, _: (head, content))


def with_picture(end):
    """A change of the end of the first picture."""
    return repacked(lambda head, made: (head, made.replace(b"</svg>", end, 1)))


def repacked(change_of):
    """A change of both."""

    def change(folder):
        with ZipFile(folder / "shard.zip") as file:
            head, made = change_of(json.loads(file.read("head.json")), file.read("made.json"))
        with ZipFile(folder / "shard.zip", "w", ZIP_DEFLATED) as file:
            file.writestr("head.json", json.dumps(head))
            file.writestr("made.json", made)

    return change


def in_place_of_the_part(folder):
    """A pipe that nobody writes to, where the system has such; else a folder."""
    (folder / "shard.zip").unlink()
    getattr(os, "mkfifo", os.mkdir)(folder / "shard.zip")


@pytest.mark.parametrize(
    ("change", "names", "words"),
    [
        (None, ("1",), "missing: part 2/2 of the run"),
        (None, ("1", "2", "1"), "1: is part 1/2, as 1 is"),
        (with_head(shard="2/3"), ("1", "2"), "2: is part 2/3, and 1 is part 1/2: they are not of one run"),
        (with_head(given={"profiles": ["iec61400-21"]}), ("1", "2"), "2: options tests: None is not what 1 has"),
        (with_head(run_id="other"), ("1", "2"), "shard.zip: is not of the run that results.json beside it is of"),
        (with_head(shard="x"), ("1", "2"), "give the number of the part and how many there are"),
        (with_head(shard=2), ("1", "2"), "2/shard.zip: is damaged: 1 validation error for Head shard"),
        (with_head(command=[5]), ("1", "2"), "2/shard.zip: is damaged: 1 validation error for Head command"),
        (with_head(given={"profiles": 5}), ("1", "2"), "2/shard.zip: --profile: must be a text or a list of texts"),
        (with_head(given={"whole": 1}), ("1", "2"), "2/shard.zip: whole: there is no such option"),
        (with_made(b"null"), ("1", "2"), "2/shard.zip: is damaged: "),
        (with_made(b"[" * 100_000), ("1", "2"), "2/shard.zip: is damaged: "),
        (with_made(b'{"a": 5}'), ("1", "2"), "2/shard.zip: is damaged: a: is nothing that is made of a record"),
        (with_picture(b"<script>alert(1)</script></svg>"), ("1", "2"), "is damaged: a picture has an element 'script'"),
        (with_made(b" " * 10_000_000), ("1", "2"), "2/shard.zip: is damaged: made.json would be 10000000 bytes"),
        (
            with_record("waveforms/../../1/results.json"),
            ("1", "2"),
            "there is no 'waveforms/../../1/results.json' in 2",
        ),
        (with_record("/etc/passwd"), ("1", "2"), "there is no '/etc/passwd' in 2"),
        (linked_record, ("1", "2"), "leads out of the folder that it may lie in"),
        (lambda folder: (folder / "shard.zip").unlink(), ("1", "2"), "it is no part of a run (--shard makes parts)"),
        (lambda folder: (folder / "shard.zip").write_bytes(b"no"), ("1", "2"), "2/shard.zip: is damaged: "),
        (in_place_of_the_part, ("1", "2"), "2/shard.zip: cannot be read: it is no ordinary file"),
        (lambda folder: (folder / "results.json").unlink(), ("1", "2"), "2/results.json: cannot be read"),
        (replaced("results.json", '"profile_digest": "', '"profile_digest": "0'), ("1", "2"), "record profile_digest"),
        (replaced("results.json", '"numba": "', '"numba": "9'), ("1", "2"), "record versions numba: '9"),
        (replaced("results.json", '"id": "VD', '"id": "XD'), ("1", "2"), "no part has run it"),
    ],
)
def test_what_is_not_merged(merge, tmp_path, change, names, words):
    """It is refused with the name of the part, and nothing is written."""
    ended = merge(change, names)
    assert (ended.status, ended.out) == (2, "")
    assert words in ended.err
    assert not (tmp_path / "out" / "results.json").exists()


def test_a_version_that_is_not_the_one_here(merge, monkeypatch):
    """Parts that agree are refused, too, where what is read here is not what they were judged by."""
    from pvlvrt_compliance.study import provenance

    monkeypatch.setattr(provenance, "__version__", "9.9")
    ended = merge()
    assert ended.status == 2
    assert "versions pvlvrt-compliance was" in ended.err
