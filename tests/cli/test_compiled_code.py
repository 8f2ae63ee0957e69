"""The command and its compiled code: the sources as they are decide the verdict, wherever the code can be kept."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numba
import pytest

import pvlvrt_compliance

ROOT = Path(pvlvrt_compliance.__file__).parent.parent
SITE = Path(numba.__file__).parent.parent
OTHER = 54321  # a user that the system has no entry for, and so no home

# File, and an edit of it by which a sag is not ridden through as it should be.
LVRT = ("control/lvrt.py", "Q = min(reactive_power_of_voltage", "Q = -0.5 * min(reactive_power_of_voltage")
REGULATOR = ("control/current_regulator.py", "m = scaled(p.K_P, e)", "m = scaled(-p.K_P, e)")
PLANT = ("plant/inverter.py", "u=scaled(K_PWM * v_dc, m)", "u=scaled(-K_PWM * v_dc, m)")


def python_of_another() -> list[str]:
    """Begin of a command that runs Python as somebody whom permissions bind.

    Where root asks, that is another user; or root without its privileges, if others cannot read this environment.
    """
    if os.getuid() != 0:
        return [sys.executable]
    other = ["setpriv", f"--reuid={OTHER}", f"--regid={OTHER}", "--clear-groups", "/usr/bin/python3"]
    tried = subprocess.run(
        [*other, "-c", "import numba"], env={"PYTHONPATH": str(SITE)}, check=False, capture_output=True
    )
    if tried.returncode == 0:
        return other
    return ["setpriv", "--bounding-set=-all", "--inh-caps=-all", sys.executable]


class Place:
    """A checkout of somebody's, and the command run in it."""

    def __init__(self, folder: Path, python: list[str]) -> None:
        self.checkout = folder / "checkout"
        self.home = folder / "home"
        self._python = python
        for name in ("pvlvrt_compliance", "profiles", "reports"):
            shutil.copytree(ROOT / name, self.checkout / name, ignore=shutil.ignore_patterns("__pycache__"))
        self.home.mkdir()
        self.give(self.home)

    @property
    def is_nobody(self) -> bool:
        """Whether whoever runs the command has no entry."""
        return f"--reuid={OTHER}" in self._python

    def give(self, place: Path) -> None:
        """Let whoever runs the command own a folder and all that is in it."""
        if self.is_nobody:
            for path in [place, *place.rglob("*")]:
                os.chown(path, OTHER, OTHER)

    def edit(self, name: str, old: str, new: str) -> None:
        """Replace a text that is there once, and keep the file's time."""
        file = self.checkout / "pvlvrt_compliance" / name
        text, times = file.read_text("utf-8"), file.stat()
        assert text.count(old) == 1
        file.write_text(text.replace(old, new), "utf-8")
        os.utime(file, ns=(times.st_atime_ns, times.st_mtime_ns))

    def close(self) -> None:
        """Let nobody make a file in the checkout."""
        for path in [self.checkout, *self.checkout.rglob("*")]:
            if path.is_dir():
                path.chmod(0o555)

    def open(self) -> None:
        """Take that back."""
        for path in [self.checkout, *self.checkout.rglob("*")]:
            if path.is_dir():
                path.chmod(0o755)

    def check(self, **environment: str) -> "subprocess.CompletedProcess[str]":
        """Run the main command with nothing of this process's environment."""
        paths = os.pathsep.join([str(self.checkout), str(SITE)])
        command = [*self._python, "-m", "pvlvrt_compliance.cli.main", "--profile", "iec61400-21", "--sag", "90%"]
        given = {"PYTHONPATH": paths, "PATH": os.environ["PATH"], **environment}
        with tempfile.TemporaryDirectory(dir=self.home, ignore_cleanup_errors=True) as output:
            self.give(Path(output))
            return subprocess.run(
                [*command, "--output", f"{output}/report"],
                cwd=self.home, env=given, capture_output=True, encoding="utf-8", check=False,
            )  # fmt: skip

    def compiled_in_tree(self) -> list[Path]:
        """Files of numba's own cache beside the sources."""
        return [path for path in self.checkout.rglob("*") if re.fullmatch(r"\.nb.", path.suffix)]


@pytest.fixture
def place():
    """A checkout in a folder that others may read; what pytest gives they may not."""
    folder = Path(tempfile.mkdtemp(prefix="pvlvrt-tests-"))
    folder.chmod(0o755)
    place = Place(folder, python_of_another())
    yield place
    place.open()
    shutil.rmtree(folder)


@pytest.mark.slow
def test_an_edit_decides_where_nothing_can_be_kept(place):
    """No home, one that cannot be written in, or no cache folder that can be made: the sources as they are decide."""
    place.give(place.checkout)
    shut = place.home.parent / "shut"
    shut.mkdir(mode=0o555)
    before = place.check(**({} if place.is_nobody else {"HOME": str(shut)}))
    assert (before.returncode, before.stderr.count("\n")) == (0, 1)
    assert before.stderr.startswith("pvlvrt-check: compiled code is not kept")
    place.edit(*LVRT)
    edited = place.check(HOME=str(shut))
    assert "reactive_support -25.0 kvar" in " ".join(edited.stdout.split())
    assert (edited.returncode, edited.stderr.count("\n")) == (1, 1)
    place.edit(*REGULATOR)
    again = place.check(HOME=str(place.home), NUMBA_CACHE_DIR=str(shut / "cache"))
    assert "reactive_support -25.0 kvar" not in " ".join(again.stdout.split())
    assert again.returncode != 0
    assert again.stderr.startswith("pvlvrt-check: compiled code is not kept")
    assert f"{shut / 'cache'}: Permission denied" in again.stderr
    assert place.compiled_in_tree() == []
    assert list(shut.iterdir()) == []
    assert not (place.home / ".cache").exists()


@pytest.mark.slow
def test_an_installation_that_cannot_be_written(place):
    """Its code is kept in the user's home. An edit decides; the text of before has its code still, if that is whole."""
    place.close()
    own = {"HOME": str(place.home), "PYTHONWARNINGS": "error"}
    first = place.check(**own)
    assert (first.returncode, first.stderr) == (0, "")
    (file,) = place.home.glob(".cache/pvlvrt-compliance/kernels-*/*/*")
    written = file.stat().st_mtime_ns
    name, old, new = PLANT
    place.edit(name, old, new)
    assert place.check(**own).returncode != 0
    place.edit(name, new, old)
    again = place.check(**own)
    assert (again.returncode, again.stderr, file.stat().st_mtime_ns) == (0, "", written)
    file.write_bytes(b"")
    damaged = place.check(**own)
    assert (damaged.returncode, "PASS: 1 test" in damaged.stdout) == (0, True)
    assert damaged.stderr == f"pvlvrt-check: {file}: damaged (empty): thrown away and made anew\n"
    assert place.compiled_in_tree() == []
