"""Recordings that tests play back: which files these may be, and that they are read before anything is simulated."""

import errno
import os
import pickle
import sys

import numpy as np
import pytest

from pvlvrt_compliance import check, load_profile
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.scenario.events import Recording
from pvlvrt_compliance.scenario.files import load_events
from pvlvrt_compliance.study import run
from pvlvrt_compliance.study.job import Asked, make_job

posix = pytest.mark.skipif(sys.platform == "win32", reason="pipes, devices and links of POSIX")

PEAK_V = 230 * 2**0.5
T_S = np.arange(0, 1.2, 2e-4)


def recording(left=0.5, turned_deg=0.0, sagging="abc"):
    """0.4 s of a grid, then 0.3 s of what is left of some phases, then all of it again."""
    sag = (T_S >= 0.4) & (T_S < 0.7)
    phases = [
        PEAK_V
        * np.where(sag & (name in sagging), left, 1.0)
        * np.cos(2 * np.pi * (50 * T_S - k / 3) + np.radians(turned_deg))
        for k, name in enumerate("abc")
    ]
    rows = (",".join(f"{x:.9g}" for x in row) for row in zip(T_S, *phases, strict=True))
    return "\n".join(["t_s,u_a_v,u_b_v,u_c_v", *rows]) + "\n"


PLAIN = recording()


def events_file(folder, file, **more):
    """An events file that names a recording."""
    keys = "".join(f"{name} = {value!r}\n" for name, value in more.items())
    (folder / "events.toml").write_text(f"[[events]]\nkind = 'recording'\nt_s = 0.0\nfile = '{file}'\n{keys}", "utf-8")
    return str(folder / "events.toml")


@pytest.fixture
def folder(tmp_path):
    """A folder with a recording in it, one below, and one beside it."""
    inside = tmp_path / "inside"
    (inside / "below").mkdir(parents=True)
    for place in (inside, inside / "below", tmp_path):
        (place / "fault.csv").write_text(PLAIN, "utf-8")
    return inside


def asked(**given):
    """A job of one test that plays a recording back."""
    return make_job(Asked(profiles=("iec61400-21",), sag="0%", **given))


def refused(**given):
    """Why there is no such job."""
    with pytest.raises(UsageError) as error:
        asked(**given)
    assert "\n" not in str(error.value)
    return str(error.value)


def played(job):
    """The file that is played back."""
    (event,) = job.tests[0].test.scenario.events
    return event.located()[0]


@pytest.mark.parametrize("name", ["fault.csv", "below/fault.csv", "below/../fault.csv", "./fault.csv"])
def test_a_path_counts_from_the_file_that_names_it(folder, name, monkeypatch, tmp_path):
    """Wherever the command is run, and wherever it is by the time that the test is."""
    events = events_file(folder, name)
    monkeypatch.chdir(folder.parent)
    job = asked(events=os.path.relpath(events))
    monkeypatch.chdir("/")
    assert played(pickle.loads(pickle.dumps(job))).samefile(folder / name)
    assert str(tmp_path) not in job.tests[0].test.model_dump_json()


@posix
@pytest.mark.parametrize(
    "name", ["../fault.csv", "/etc/passwd", "below/../../fault.csv", "link.csv", "linked/fault.csv"]
)
def test_nothing_outside_is_read(folder, name):
    """Whether or not there is such a file, it is said in the same words, with file, line and key."""
    (folder / "link.csv").symlink_to("../fault.csv")
    (folder / "linked").symlink_to("..")
    for file in (name, name.replace("fault", "none")):
        said = refused(events=events_file(folder, file))
        if file in ("linked/none.csv", name):
            assert said == (
                f"{folder / 'events.toml'}:4: events[0].file: {file}: a recording lies in the folder of the file that"
                " names it or below; --recordings FOLDER (recordings) names another"
            )


def _denying(file):
    """What opens all files but this one."""
    opens = os.open

    def open_other(path, *arguments, **given):
        if os.fspath(path) == os.fspath(file):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return opens(path, *arguments, **given)

    return open_other


@posix
@pytest.mark.parametrize("what", ["folder", "pipe", "device", "hole", "none", "password", "locked"])
def test_what_is_no_recording(folder, what, monkeypatch):
    """It is told in one line before anything is simulated; nobody waits, and nothing of it is said."""
    file = folder / "it.csv"
    match what:
        case "folder":
            file.mkdir()
        case "pipe":
            os.mkfifo(file)
        case "device":
            file.symlink_to("/dev/zero")
        case "hole":
            with file.open("wb") as hole:
                hole.truncate(1 << 40)
        case "password":
            file.write_text("root:x:0:0:root:/root:/bin/bash\n" * 3)
        case "locked":
            file.write_text(PLAIN, "utf-8")
            file.chmod(0)
            if os.access(file, os.R_OK):  # this user may read everything
                monkeypatch.setattr(os, "open", _denying(file))
    said = refused(events=events_file(folder, "it.csv"))
    assert said.startswith(f"{folder / 'events.toml'}:4: events[0].file: it.csv: ")
    assert "bash" not in said
    assert {
        "folder": "it is a folder",
        "pipe": "it is a pipe",
        "device": "a recording lies in the folder of the file that names it",
        "hole": "larger than 64 MiB",
        "none": "No such file",
        "password": "line 1: there is no column t_s",
        "locked": "Permission denied",
    }[what] in said


def test_a_folder_of_recordings(folder, tmp_path):
    """What is not beside the file is there, by its path from there or whole; what is beside it comes first."""
    (tmp_path / "pool" / "of").mkdir(parents=True)
    pool = tmp_path / "pool"
    (pool / "of" / "other.csv").write_text(PLAIN, "utf-8")
    (pool / "fault.csv").write_text(PLAIN, "utf-8")
    for name in ("of/other.csv", str(pool / "of" / "other.csv"), "../pool/of/other.csv"):
        job = asked(events=events_file(folder, name), recordings=str(pool))
        assert played(job).samefile(pool / "of" / "other.csv")
    assert played(asked(events=events_file(folder, "fault.csv"), recordings=str(pool))).samefile(folder / "fault.csv")
    said = refused(events=events_file(folder, "../fault.csv"), recordings=str(pool))
    assert "it or below or in the folder of recordings" in said
    assert refused(recordings=str(folder / "fault.csv")).endswith("fault.csv: it is not a folder")


def profile_file(folder, *rows, include="iec61400-21"):
    """A profile with rows that play recordings back."""
    text = f'schema_version = 1\nid = "mine"\ntitle = "t"\ninclude = ["{include}"]\ndrop_tests = ["VD*"]\n'
    for k, (file, more) in enumerate(rows):
        text += (
            f'[[tests]]\nid = "R{k}"\nclause = "c"\nconfidence = "chosen"\nsource = "s"\npowers = ["full"]\n'
            f'duration_s = 1.0\n[[tests.events]]\nkind = "recording"\nfile = "{file}"\nt_s = 0.0\n{more}'
        )
    (folder / "mine.toml").write_text(text, "utf-8")
    return str(folder / "mine.toml")


def test_a_profile_names_recordings_beside_it(folder, tmp_path):
    """Line and key are of the file that the row comes from, and so is the folder, where another includes it."""
    assert played(make_job(Asked(profiles=(profile_file(folder, ("fault.csv", "")),), tests=("R0*",)))).samefile(
        folder / "fault.csv"
    )
    including = tmp_path / "outer.toml"
    including.write_text('schema_version = 1\nid = "outer"\ntitle = "t"\ninclude = ["inside/mine.toml"]\n', "utf-8")
    (folder / "fault.csv").unlink()
    with pytest.raises(UsageError, match=rf"^{folder / 'mine.toml'}:15: tests\[0\]\.events\[0\]\.file: fault\.csv: "):
        make_job(Asked(profiles=(str(including),), tests=("R0*",)))


def test_only_what_is_run_is_read(folder):
    """A test that is not selected needs no recording; a profile can be looked at without any."""
    profile = profile_file(folder, ("fault.csv", ""), ("none.csv", ""))
    assert make_job(Asked(profiles=(profile,), tests=("R0*",))).tests
    assert load_profile(profile).rows
    with pytest.raises(UsageError, match=r"none\.csv: cannot be read"):
        make_job(Asked(profiles=(profile,)))


def test_what_is_only_put_together_needs_none(folder, tmp_path):
    """The parts of a run have been simulated elsewhere, where the recordings were."""
    given = Asked(profiles=(profile_file(folder, ("none.csv", "")),), recordings=str(tmp_path / "none"))
    assert make_job(given, is_simulated=False).tests


def test_recordings_of_one_name_in_two_folders_are_two(folder):
    """Two profiles name their own files alike: each test has its own record."""
    one, two = load_events(events_file(folder, "fault.csv")), load_events(events_file(folder / "below", "fault.csv"))
    assert one != two
    assert one == load_events(events_file(folder, "fault.csv"))


def test_in_python_any_file_is_named(folder, monkeypatch):
    """Nobody else's file has named it: it counts from the working directory."""
    monkeypatch.chdir(folder)
    assert played(asked(events=[Recording(file="../fault.csv", t_s=0.0)])).samefile("../fault.csv")
    said = refused(events=[Recording(file="none.csv", t_s=0.0)])
    assert said == "events: none.csv: cannot be read as a recording (No such file or directory)"


def test_in_python_the_folder_of_recordings_has_what_is_nowhere_else(folder, tmp_path, monkeypatch):
    """A path from here comes first."""
    monkeypatch.chdir(tmp_path)
    (folder / "other.csv").write_text(PLAIN, "utf-8")
    for name, found in (("fault.csv", tmp_path / "fault.csv"), ("other.csv", folder / "other.csv")):
        assert played(asked(events=[Recording(file=name, t_s=0.0)], recordings=str(folder))).samefile(found)
    assert refused(events=[Recording(file="none.csv", t_s=0.0)], recordings=str(folder)).startswith("events: none.csv:")


def test_a_name_is_one_line(folder):
    """One with lines of its own would pass for a further message."""
    events = folder / "events.toml"
    events.write_text('[[events]]\nkind = "recording"\nt_s = 0.0\nfile = "a\\n::error::b.csv"\n', "utf-8")
    with pytest.raises(UsageError, match=r"events\[0\]\.file: a file's name must not have control characters"):
        load_events(str(events))


def test_nothing_is_simulated_before(folder, monkeypatch):
    """A recording with a fault in its last line ends the run before its first test, and no folder is made."""
    monkeypatch.setattr(run, "simulate", None)
    (folder / "fault.csv").write_text(f"{PLAIN}1.2,1,2\n", "utf-8")
    with pytest.raises(UsageError, match=rf"line {len(T_S) + 2} has 3 fields where the header has 4"):
        check("iec61400-21", sag="0%", events=events_file(folder, "fault.csv"), output=folder / "out")
    assert not (folder / "out").exists()


@pytest.mark.parametrize(
    ("left", "phases", "turned_deg"), [(0.5, "abc", 0.0), (0.5, "abc", 60.0), (0.3, "c", 0.0), (0.0, "abc", 0.0)]
)
def test_a_recording_with_a_sag_is_judged_as_that_sag(folder, left, phases, turned_deg):
    """Times count from it, whatever the angle that the recording begins with; verdicts are those of the sag itself."""
    (folder / "fault.csv").write_text(recording(left, turned_deg, phases), "utf-8")
    (found,) = check("iec61400-21", sag="0%", duration=1.2, events=events_file(folder, "fault.csv")).tests
    (itself,) = check("iec61400-21", sag=1 - left, phases=phases, duration=0.3).tests
    grid = found.disturbance
    assert (grid.origin, grid.start_s) == ("found", pytest.approx(0.7, abs=4e-4))
    assert grid.clear_s - grid.start_s == pytest.approx(0.3, abs=4e-4)
    meant = itself.disturbance.no_load(itself.disturbance.start_s + 0.1)
    assert grid.no_load(grid.start_s + 0.1).positive_pu == pytest.approx(meant.positive_pu, abs=1e-3)
    assert grid.no_load(grid.start_s + 0.1).negative_pu == pytest.approx(meant.negative_pu, abs=1e-3)
    assert {c.check: c.status for c in found.checks} == {c.check: c.status for c in itself.checks}
    assert ("angle" in [what for step in grid.steps for what in step.moved]) == (turned_deg > 0)
    assert found.scenario["events"][0]["file"] == "fault.csv"


def test_a_recording_without_one_leaves_what_is_asked(folder):
    """Nothing happens in it, and nothing is asked for: that is what is judged, as ever."""
    (folder / "fault.csv").write_text(recording(1.0), "utf-8")
    (found,) = check("iec61400-21", sag="0%", duration=1.2, events=events_file(folder, "fault.csv")).tests
    assert (found.disturbance.origin, found.disturbance.start_s) == ("asked", 0.3)
