import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from pvlvrt_compliance import kernel
from pvlvrt_compliance.plant.inverter import limit_modulation

PACKAGE = Path(kernel.__file__).parent
SOURCES = ["kernel.py", "space_vectors.py", "vectors.py", "sogi.py"] + [
    path.relative_to(PACKAGE).as_posix()
    for folder in ("control", "plant", "simulation")
    for path in sorted((PACKAGE / folder).rglob("*.py"))
]


def digest_of(package: Path, monkeypatch) -> str:
    """Digest of a copy of the package's sources."""
    monkeypatch.setattr(kernel, "_PACKAGE", package)
    kernel.kernel_digest.cache_clear()
    return kernel.kernel_digest()


@pytest.fixture
def copied(tmp_path):
    """A copy of the package's sources; the digest of the real ones is computed anew afterwards."""
    package = tmp_path / "copied"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__"))
    yield package
    kernel.kernel_digest.cache_clear()


def test_an_edit_of_any_kernel_source_moves_the_cache(copied, monkeypatch):
    """Every file that compiled code is made from is part of the cache folder's name."""
    seen = {digest_of(copied, monkeypatch)}
    for n, name in enumerate(SOURCES, start=1):
        file = copied / name
        file.write_text(file.read_text(encoding="utf-8") + "\n# edited\n", encoding="utf-8")
        seen.add(digest_of(copied, monkeypatch))
        assert len(seen) == n + 1, name


def test_other_files_leave_the_cache_where_it_is(copied, monkeypatch):
    """Editing a report or a check does not compile anew."""
    before = digest_of(copied, monkeypatch)
    (copied / "errors.py").write_text("", encoding="utf-8")
    (copied / "checks" / "added.py").write_text("", encoding="utf-8")
    assert digest_of(copied, monkeypatch) == before


def test_all_kernel_modules_are_in_the_digest():
    """No module uses a decorator of compiled code without being a source of the digest."""
    decorated = re.compile(r"^@(cached_)?kernel\b", re.MULTILINE)
    users = {
        path.relative_to(PACKAGE).as_posix()
        for path in PACKAGE.rglob("*.py")
        if decorated.search(path.read_text(encoding="utf-8"))
    }
    assert "control/lvrt.py" in users
    assert users <= set(SOURCES)


def test_the_cache_moves_with_the_environment(monkeypatch, tmp_path):
    """NUMBA_CACHE_DIR says where compiled code is kept; the folder within has the digest's name."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    assert kernel.cache_folder() == tmp_path / f"kernels-{kernel.kernel_digest()}"
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    assert tmp_path not in kernel.cache_folder().parents
    assert kernel.cache_folder().name == f"kernels-{kernel.kernel_digest()}"


def test_the_python_behind_a_kernel():
    """`plain` gives the function that was decorated, and leaves a function that was not as it is."""
    assert kernel.plain(limit_modulation).__name__ == "limit_modulation"
    assert not hasattr(kernel.plain(limit_modulation), "py_func")
    assert kernel.plain(digest_of) is digest_of


SHORT_RUN = """
import sys
import numpy as np
from pvlvrt_compliance.scenario.parameters import parameters_from
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.simulate import simulate

scenario = Scenario(sag=Sag(depth=0.9, phases="c"), duration_s=0.02, before_s=0.25, after_s=0.1)
waveforms = simulate(scenario, parameters_from(["simulation.settling_s=0", *sys.argv[2:]]))
np.save(sys.argv[1], np.array(list(waveforms.segments[0].channels.values())))
"""


@pytest.mark.slow
@pytest.mark.parametrize(("precision", "tolerance"), [("double", 1e-9), ("single", 2.0**-18)])
def test_without_the_compiler_the_same_numbers_come_out(tmp_path, precision, tolerance):
    """NUMBA_DISABLE_JIT=1 runs the same kernels in Python, through a sag, to 1e-9 of the largest value.

    With 32 bits to 32 ulp, as numpy's sine and the machine's differ in the last bit.
    """
    records = []
    for disabled in ("0", "1"):
        file = tmp_path / f"{disabled}.npy"
        environment = os.environ | {"NUMBA_DISABLE_JIT": disabled}
        command = [sys.executable, "-c", SHORT_RUN, str(file), f"controller.precision={precision}"]
        subprocess.run(command, check=True, env=environment)
        records.append(np.load(file))
    compiled, interpreted = records
    scale = np.abs(compiled).max(axis=1, keepdims=True)
    assert (np.abs(compiled - interpreted) <= tolerance * scale).all()
