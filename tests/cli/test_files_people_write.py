"""A bad file of each kind, at the command line: status 2, its line and key on stderr, nothing written."""

import os
import sys
from pathlib import Path

import pytest

PROGRAM = Path(__file__).parents[2] / "examples" / "program-python" / "controller.py"
MAIN = ("--profile", "iec61400-21", "--sag", "50%")
OPTIONS = {
    "profile": ("--sag", "50%", "--profile"),
    "events": (*MAIN, "--events"),
    "mapping": (*MAIN, "--controller", f'stdio:"{sys.executable}" "{PROGRAM}"', "--mapping"),
}
MISSPELT = {
    "profile": (
        'schema_version = 1\nid = "mine"\ntitle = "t"\ninclude = ["iec61400-21"]\n[procedure]\nafter_ms = 2\n',
        '6: procedure.after_ms: unknown key; did you mean "after_s"? It is in seconds',
    ),
    "events": (
        '[[events]]\nkind = "phase_jump"\nt_s = 0\nangle_deg = 1\nangle_rad = 3\n',
        '5: events[0].angle_rad: unknown key; did you mean "angle_deg"? It is in degrees',
    ),
    "mapping": (
        '[inputs.Va]\nsignal = "u_a_v"\nunits = "V"\n',
        '3: inputs.Va.units: unknown key; did you mean "unit"?',
    ),
}
NO_FILE_OF_ANY_KIND = {
    "UTF-16": ("a = 1\n".encode("utf-16"), ":1: not UTF-8 text: it is UTF-16; save it as UTF-8"),
    "large": (b"#" * ((1 << 20) + 1), ": larger than 1 MiB; "),
    "deep": (b"a = 1\nb = " + b"[" * 5000 + b"]" * 5000, ":2: b: not TOML: nested too deeply, more than 32 levels"),
    "digits": (b"a = 1\nb = [1, " + b"9" * 5000 + b"]", ":2: b[1]: not TOML: a whole number of more than 64 bits"),
}


@pytest.fixture(params=OPTIONS)
def kind(request):
    """Each kind of file in turn."""
    return request.param


@pytest.fixture
def file(tmp_path):
    """Where a test writes its file."""
    return tmp_path / "mine.toml"


def check_refused(ended, says, file):
    """One problem, on a line below that of the file; nothing else is said, and nothing written."""
    assert (ended.status, ended.out) == (2, "")
    head, problem = ended.err.splitlines()
    assert head.startswith("pvlvrt-check: ")
    assert head.endswith(f"{file}: 1 problem")
    assert problem.startswith(f"  {file}{says}")
    assert [path.name for path in file.parent.iterdir()] == [file.name]


def test_a_misspelt_key(program, kind, file):
    """The program names file, line and key, and the key that was meant, also behind a byte-order mark."""
    text, says = MISSPELT[kind]
    file.write_bytes(b"\xef\xbb\xbf" + text.encode())
    check_refused(program(*OPTIONS[kind], file, "--output", file.parent / "out"), f":{says}", file)


@pytest.mark.parametrize(("content", "says"), NO_FILE_OF_ANY_KIND.values(), ids=NO_FILE_OF_ANY_KIND)
def test_what_no_file_is(command, kind, file, content, says):
    """Another encoding, too many bytes, levels or digits: one line each, and no traceback."""
    file.write_bytes(content)
    check_refused(command(*OPTIONS[kind], file, "--output", file.parent / "out"), says, file)


@pytest.mark.skipif(sys.platform == "win32", reason="pipes and devices of POSIX")
@pytest.mark.parametrize("what", ["folder", "pipe", "device"])
def test_what_is_no_ordinary_file(command, kind, file, what):
    """A folder, a pipe that nobody writes to and a device without end are named, and not read."""
    match what:
        case "folder":
            file.mkdir()
        case "pipe":
            os.mkfifo(file)
        case "device":
            file.symlink_to("/dev/zero")
    ended = command(*OPTIONS[kind], file, "--output", file.parent / "out")
    assert (ended.status, ended.out) == (2, "")
    assert f"it is a {what}" in ended.err
    assert str(file) in ended.err
    assert not (file.parent / "out").exists()
