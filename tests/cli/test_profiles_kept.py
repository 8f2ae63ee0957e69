"""`pvlvrt-check profiles`: what is kept of a list, until a file of it changes; and no compiler is loaded."""

import json
import os
import subprocess
import sys

import pytest

from pvlvrt_compliance.profile import loading
from pvlvrt_compliance.resources import resource_folder


@pytest.mark.parametrize(
    "arguments", [["list"], ["show", "iec61400-21"], ["check", "iec61400-21"], ["schema"], ["new"]], ids=" ".join
)
def test_no_compiler_is_loaded(arguments):
    """Reading profiles imports neither numba nor scipy nor plotly."""
    script = (
        "import sys\n"
        "from pvlvrt_compliance.cli.main import run\n"
        f"run(['profiles', *{arguments!r}])\n"
        "print(sorted({'numba', 'scipy', 'plotly', 'pandas', 'matplotlib'} & set(sys.modules)), file=sys.stderr)\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stderr.splitlines()[-1] == "[]"


@pytest.fixture
def my_codes(monkeypatch, tmp_path):
    """A folder of one's own with a code that includes another, and a folder of its own for what is kept."""
    folder = tmp_path / "codes"
    folder.mkdir()
    text = (resource_folder("profiles") / "iec61400-21.toml").read_text("utf-8")
    (folder / "base.toml").write_text(text.replace('id = "iec61400-21"', 'id = "base"'), "utf-8")
    over = 'schema_version = 1\nid = "over"\ntitle = "Over"\ninclude = ["base"]\n'
    (folder / "over.toml").write_text(over, "utf-8")
    monkeypatch.setenv("PVLVRT_PROFILES", str(folder))
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "kept"))
    return folder


def listed(command):
    """The entries of the list by their names."""
    return {entry["name"]: entry for entry in json.loads(command("profiles", "list", "--json").out)}


@pytest.mark.usefixtures("my_codes")
def test_a_list_is_kept(command, monkeypatch):
    """The second list is that of the first, and reads no profile as a whole."""
    first = command("profiles", "list")
    monkeypatch.setattr(loading, "load_profile", None)
    assert command("profiles", "list") == first
    assert listed(command)["over"]["tests"] == listed(command)["base"]["tests"] > 0


def test_an_edit_of_what_a_profile_includes_is_listed(command, my_codes):
    """Each file that an entry is made from counts, whichever profile it is of."""
    before = listed(command)
    (my_codes / "over.toml").write_text((my_codes / "over.toml").read_text() + 'drop_tests = ["VD1*"]\n')
    base = my_codes / "base.toml"
    base.write_text(base.read_text("utf-8").replace('title = "', 'title = "Another ', 1), "utf-8")
    after = listed(command)
    assert after["base"]["title"] == f"Another {before['base']['title']}"
    assert 0 < after["over"]["tests"] < before["over"]["tests"]
    assert after["over"]["digest"] != before["over"]["digest"]


def test_a_file_that_comes_before_the_included_one_is_listed(command, my_codes, tmp_path, monkeypatch):
    """What is included lies beside the file or in an earlier folder; once another does, the list is another."""
    first = tmp_path / "first"
    first.mkdir()
    monkeypatch.setenv("PVLVRT_PROFILES", os.pathsep.join([str(first), str(my_codes)]))
    base = (my_codes / "base.toml").rename(first / "base.toml").read_text("utf-8")
    assert listed(command)["over"]["problems"] == []
    (my_codes / "base.toml").write_text(base.replace("schema_version = 1", "schema_version = 9"), "utf-8")
    after = listed(command)
    assert after["over"]["problems"]
    assert after["base"]["problems"] == []


def test_a_list_with_a_file_from_elsewhere_is_not_kept(command, my_codes):
    """A file that no folder of profiles has may change unseen, so such a list is made each time."""
    (my_codes / "below").mkdir()
    outside = my_codes / "below" / "outside.toml"
    (my_codes / "base.toml").rename(outside)
    over = my_codes / "over.toml"
    over.write_text(over.read_text().replace('"base"', '"below/outside.toml"'))
    before = listed(command)["over"]
    outside.write_text(outside.read_text("utf-8") + "unknown = 1\n", "utf-8")
    assert before["problems"] == []
    assert listed(command)["over"]["problems"]
