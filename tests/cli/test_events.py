"""Events from a file, sags by type and faults beyond a transformer, at the command line."""

import os
import sys

import pytest

MAIN = ("--profile", "iec61400-21", "--sag", "50%")


@pytest.fixture
def events_file(tmp_path):
    """Write a file of events and return its path."""

    def write(text):
        path = tmp_path / "events.toml"
        path.write_text(text, "utf-8")
        return path

    return write


def test_events_reach_the_run_and_the_report(command, reports, events_file, tmp_path):
    """A phase jump from a file is in the scenario of the results and in the page."""
    file = events_file('[[events]]\nkind = "phase_jump"\nt_s = 0.0\nangle_deg = 10\n')
    assert command(*MAIN, "--events", file, "--output", tmp_path / "out").status in {0, 1}
    found = reports(tmp_path / "out")
    assert found.test["scenario"]["events"] == [{"kind": "phase_jump", "t_s": 0.0, "angle_deg": 10.0}]
    assert "phase jump" in found.page.text_content()


def test_sag_by_type_beyond_a_transformer(command, reports, tmp_path):
    """A single-phase fault beyond a Dyn11 transformer reaches the terminals as V+ 0.833 and V- 0.167."""
    out = tmp_path / "out"
    assert command(*MAIN, "--sag-type", "B", "--transformer", "Dyn11", "--output", out).status == 0
    test = reports(out).test
    assert test["id"] == "sag-50pct-abc-type-B"
    during = test["measurements"]["during"]
    assert during["voltage_positive_pu"] == pytest.approx(0.8333, abs=1e-3)
    assert during["voltage_negative_pu"] == pytest.approx(0.1667, abs=1e-3)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[[events]]\nkind = 'jump'\n", "events[0]"),
        ("[[events]]\nkind = 'phase_jump'\nt_s = 0\n", "events.toml:1: events[0].angle_deg: missing"),
        ("events = 3\n", "events: "),
        ("[[events\n", "not TOML"),
    ],
)
def test_a_wrong_file_is_refused(command, events_file, tmp_path, text, says):
    """A file that cannot be used gives status 2, names file and key, and nothing is written."""
    file = events_file(text)
    ended = command(*MAIN, "--events", file, "--output", tmp_path / "out")
    assert ended.status == 2
    assert str(file) in ended.err
    assert says in ended.err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "options", [("--sag-type", "H"), ("--sag-type", "C", "--phases", "ab"), ("--transformer", "Dx11")]
)
def test_wrong_options_are_refused(command, tmp_path, options):
    """An unknown type, a type with a pair of phases and an unknown vector group are one line and status 2."""
    ended = command(*MAIN, *options, "--output", tmp_path / "out")
    assert ended.status == 2
    assert options[0] in ended.err
    assert len(ended.err.strip().splitlines()) == 1


RECORDING = "[[events]]\nkind = 'recording'\nt_s = 0.0\nfile = '{}'\n"


@pytest.mark.skipif(sys.platform == "win32", reason="pipes and devices of POSIX")
@pytest.mark.parametrize("file", ["pipe.csv", "/dev/zero", "/etc/passwd", "../events.toml", "folder", "none.csv"])
def test_what_is_no_recording_is_not_waited_for(command, events_file, tmp_path, file):
    """One line with file, line and key; nothing of it is shown, and nothing is simulated or written."""
    os.mkfifo(tmp_path / "pipe.csv")
    (tmp_path / "folder").mkdir()
    events = events_file(RECORDING.format(file))
    ended = command("--profile", "iec61400-21", "--sag", "0%", "--events", events, "--output", tmp_path / "out")
    assert (ended.status, ended.out) == (2, "")
    assert ended.err.startswith(f"pvlvrt-check: {events}:4: events[0].file: {file}: ")
    assert ended.err.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_project_says_where_its_recordings_lie(command, events_file, tmp_path, monkeypatch):
    """In its file of settings, by a path that counts from there; the command that is recorded says it, too."""
    rows = (f"{k * 1e-3:.3f},{400 * (k % 20 < 10)},0,0" for k in range(40))
    (tmp_path / "pool").mkdir()
    (tmp_path / "pool" / "fault.csv").write_text("\n".join(["t_s,u_a_v,u_b_v,u_c_v", *rows]) + "\n", "utf-8")
    (tmp_path / "sub").mkdir()
    (tmp_path / "pvlvrt.toml").write_text("recordings = 'pool'\n", "utf-8")
    events = events_file(RECORDING.format("fault.csv"))
    monkeypatch.chdir(tmp_path / "sub")
    ended = command("--profile", "iec61400-21", "--sag", "0%", "--events", events, "--list")
    assert (ended.status, "sag-0pct-abc" in ended.out) == (0, True)
    ended = command("--profile", "iec61400-21", "--sag", "0%", "--events", events, "--list", "--isolated")
    assert (ended.status, "fault.csv: cannot be read as a recording (No such" in ended.err) == (2, True)
