"""A file's name is bytes, and need not be text: no run is lost to that."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(os.name == "nt", reason="names are text in Windows")

MISBEHAVING = Path(__file__).parents[1] / "controllers" / "misbehaving.py"


def _run(folder, *arguments, **environment):
    program = [sys.executable, "-m", "pvlvrt_compliance.cli.main", *arguments]
    return subprocess.run(program, cwd=folder, env=os.environ | environment, capture_output=True, check=False)


@pytest.fixture
def folder(tmp_path):
    """Folder with a profile of such a name."""
    text = 'schema_version = 1\nid = "mine"\ntitle = "Mine"\ninclude = ["iec61400-21"]\n'
    Path(os.fsdecode(os.fsencode(tmp_path) + b"/\xe9.toml")).write_text(text)
    return tmp_path


def test_profile_and_output(folder, reports):
    """The reports are there, and the command in them is one that a shell reads back."""
    done = _run(folder, "--profile", b"\xe9.toml", "--sag", "90%", "--output", b"it's \xff")
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.endswith(rb"Report: it's \xff/report.html" + b"\n")
    found = reports(folder / os.fsdecode(b"it's \xff"))
    command = found.json["provenance"]["command"]
    assert command == r"pvlvrt-check --profile $'\xe9.toml' --sag 90% --output $'it\'s \xff'"
    assert found.page.xpath("//dl[@class='run']//code")[0].text_content() == command
    assert {p.get("value") for p in found.junit.iterfind(".//property[@name='command']")} == {command}
    words = subprocess.run(["bash", "-c", f"printf '%s\\n' {command}"], capture_output=True, check=True).stdout
    assert words.split(b"\n")[2:7:4] == [b"\xe9.toml", b"it's \xff"]


def test_a_terminal_of_another_encoding(folder):
    """A character that its encoding lacks costs a mark, and no traceback; the bytes of a name are spelled."""
    done = _run(folder, "profiles", "list", PYTHONIOENCODING="ascii", PVLVRT_PROFILES=str(folder))
    assert (done.returncode, done.stderr) == (0, b"")
    assert rb"\xe9 " in done.stdout
    assert b"Rey-Bou? et al." in done.stdout


def test_controller(folder, reports):
    """So is the name of a controller, and what goes wrong in it."""
    shutil.copy(MISBEHAVING, folder / os.fsdecode(b"c-\xff.py"))
    more = ("--controller", b"c-\xff.py:Controller", "--set", "controller.deed=raise", "--output", "out")
    done = _run(folder, "--profile", b"\xe9.toml", "--sag", "50%", *more)
    assert (done.returncode, done.stderr) == (3, b"")
    found = reports(folder / "out")
    assert found.json["provenance"]["controller"] == r"c-\xff.py:Controller"
    assert r"c-\xff.py, line" in found.test["checks"][0]["message"]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--profile", b"no-\xff.toml"), rb"no profile file at 'no-\udcff.toml'"),
        (("--profile", "iec61400-21", "--sag", b"\xff%"), rb"'\udcff%' is not a fraction"),
        (("--profile", "iec61400-21", "--events", b"\xff"), rb"\xff: cannot be read"),
        (("--profile", "iec61400-21", "--sag", "9%", "--controller", b"\xff.py:C"), rb"there is no file \xff.py"),
    ],
    ids=["profile", "sag", "events", "controller"],
)
def test_refusals(folder, arguments, says):
    """A message spells the bytes."""
    done = _run(folder, *arguments)
    lines = 2 if "--events" in arguments else 1  # of a file the problems stand below its name
    assert (done.returncode, done.stdout, done.stderr.count(b"\n")) == (2, b"", lines)
    assert says in done.stderr
