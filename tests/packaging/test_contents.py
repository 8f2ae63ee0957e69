"""Wheel and sdist: each has what it needs, and nothing else."""

import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

from calls import completed

pytestmark = pytest.mark.slow

_NAME = "pvlvrt_compliance"

_BUILT = {".so", ".o"}

_LEFT_BY_TOOLS = {"__pycache__", "build", ".pytest_cache", ".hypothesis"}


def _is_left(path):
    """Whether a tool has left this file behind."""
    return path.suffix in _BUILT or bool(_LEFT_BY_TOOLS & set(path.parts))


@pytest.fixture(scope="module")
def wheel_files(distributions):
    """Content of the wheel by name."""
    with zipfile.ZipFile(distributions[".whl"]) as wheel:
        return {name: wheel.read(name) for name in wheel.namelist()}


@pytest.fixture(scope="module")
def sdist_files(distributions):
    """Names in the sdist, without its top folder."""
    with tarfile.open(distributions[".gz"]) as sdist:
        return {name.partition("/")[2] for name in sdist.getnames()}


def test_wheel_has_every_source_profile_and_template(root, wheel_files):
    """What the package needs at run time is inside the package, byte for byte."""
    sources = {p.relative_to(root).as_posix(): p for p in (root / _NAME).rglob("*.py")}
    sources |= {f"{_NAME}/{p.relative_to(root).as_posix()}": p for p in (root / "profiles").glob("*.toml")}
    sources |= {f"{_NAME}/{p.relative_to(root).as_posix()}": p for p in (root / "reports").iterdir() if p.is_file()}
    sources |= {p.relative_to(root).as_posix(): p for p in (root / _NAME).rglob("*.h")}
    sources |= {p.relative_to(root).as_posix(): p for p in _templates(root)}
    sources[f"{_NAME}/py.typed"] = root / _NAME / "py.typed"
    assert {name for name in sources if name not in wheel_files} == set()
    assert {name for name, path in sources.items() if wheel_files[name] != path.read_bytes()} == set()


def _templates(root):
    return [
        p
        for p in (root / _NAME / "controllers" / "templates").rglob("*")
        if p.is_file() and "__pycache__" not in p.parts
    ]


def test_wheel_has_nothing_else(wheel_files):
    """No tests, no benchmarks, no caches; the licence goes with it."""
    tops = {name.partition("/")[0] for name in wheel_files}
    assert {top for top in tops if not top.endswith(".dist-info")} == {_NAME}
    inside = {Path(name).suffix for name in wheel_files if name.startswith(f"{_NAME}/")}
    assert inside <= {
        ".py",
        ".typed",
        ".toml",
        ".j2",
        ".typ",
        ".css",
        ".js",
        ".svg",
        ".c",
        ".h",
        ".md",
        ".txt",
        ".yml",
        "",
    }
    assert not any("cache" in folder for name in wheel_files for folder in Path(name).parts[:-1])
    assert any(name.endswith("/licenses/LICENSE") for name in wheel_files)


def test_sdist_can_be_tested(root, sdist_files):
    """The sdist carries tests, and what they need, besides what the wheel is made from."""
    folders = ("tests", "profiles", "reports", "benchmarks", "examples", "validation", "docs")
    wanted = [p for folder in folders for p in (root / folder).rglob("*.*")]
    names = {p.relative_to(root).as_posix() for p in wanted if p.is_file() and not _is_left(p)}
    assert names - sdist_files == set()
    assert sdist_files >= {"README.md", "LICENSE", "pyproject.toml"}


def test_checkout_and_sdist_give_the_same_wheel(root, wheel_files, tmp_path):
    """A wheel built from the checkout has the same files as one built from the sdist."""
    completed(sys.executable, "-m", "build", "--wheel", "--outdir", tmp_path, root, cwd=tmp_path)
    with zipfile.ZipFile(next(tmp_path.glob("*.whl"))) as wheel:
        direct = {name: wheel.read(name) for name in wheel.namelist()}
    assert {name for name in direct.keys() | wheel_files.keys() if direct.get(name) != wheel_files.get(name)} == set()
