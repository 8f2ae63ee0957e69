"""The C header of the interface is found where projects look for it, now and from before."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import pvlvrt_compliance
from pvlvrt_compliance.controllers.library import HEADER

PACKAGE = Path(pvlvrt_compliance.__file__).parent
EXAMPLES = Path(__file__).parents[3] / "examples"
BEFORE = PACKAGE / "simulation" / "doors"
"""Folder that Makefiles of projects from version 0.1 name."""

pytestmark = pytest.mark.compiler


def preprocessed(gcc, folder):
    """What a controller that includes the header from this folder is compiled from."""
    command = [gcc, "-std=c99", "-E", "-P", "-I", str(folder), "-x", "c", "-"]
    source = '#include "ieee_cigre.h"\n'
    return subprocess.run(command, input=source, capture_output=True, text=True, check=True).stdout


def test_the_folder_from_before_gives_the_same_interface(gcc):
    """A compiler that is pointed to where the header was gets every declaration of it."""
    assert preprocessed(gcc, BEFORE) == preprocessed(gcc, HEADER.parent)
    assert "Model_Outputs" in preprocessed(gcc, BEFORE)


@pytest.fixture
def checkout(tmp_path):
    """Headers of a checkout, and copies of the examples in C, each at its place."""
    if shutil.which("make") is None:
        pytest.skip("make is missing, so no example can be built")
    for folder in (BEFORE, HEADER.parent):
        place = tmp_path / folder.relative_to(PACKAGE.parent)
        shutil.copytree(folder, place, ignore=lambda _, names: [name for name in names if not name.endswith(".h")])
    for name in ("bundled-controller-c", "negative-sequence-bug"):
        shutil.copytree(EXAMPLES / name, tmp_path / "examples" / name, ignore=shutil.ignore_patterns("*.so"))
    return tmp_path


@pytest.mark.parametrize("interface", ["controllers/library", "simulation/doors"], ids=["now", "before"])
@pytest.mark.parametrize("name", ["bundled-controller-c", "negative-sequence-bug"])
def test_makefiles_of_now_and_before_build(checkout, gcc, name, interface):
    """A copy of an example with the Makefile of an earlier version builds without a warning, as the one of now does."""
    folder = checkout / "examples" / name
    makefile = folder / "Makefile"
    now = "INTERFACE ?= ../../pvlvrt_compliance/controllers/library\n"
    assert makefile.read_text().count(now) == 1
    makefile.write_text(makefile.read_text().replace(now, f"INTERFACE ?= ../../pvlvrt_compliance/{interface}\n"))
    flags = "CFLAGS=-std=c99 -O2 -Wall -Wextra -Werror"
    done = subprocess.run(
        ["make", "-s", f"CC={gcc}", flags, "libcontroller.so"], cwd=folder, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert (folder / "libcontroller.so").is_file()


def test_a_project_fetches_its_header(gcc, tmp_path, monkeypatch):
    """A project in C whose header is not there has the program print it, by its own Makefile."""
    from pvlvrt_compliance.controllers.projects import project_files

    for name, content in project_files("c").items():
        place = tmp_path / "project" / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(content)
    (tmp_path / "project" / HEADER.name).unlink()
    program = tmp_path / "bin" / "pvlvrt-check"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m pvlvrt_compliance.cli.main "$@"\n')
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(program.parent), prepend=":")
    subprocess.run(["make", "-s", f"CC={gcc}"], cwd=tmp_path / "project", check=True)
    assert (tmp_path / "project" / HEADER.name).read_bytes() == HEADER.read_bytes()
    assert (tmp_path / "project" / "libcontroller.so").is_file()
