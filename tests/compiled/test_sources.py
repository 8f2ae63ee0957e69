"""The digest and the key of compiled code: what moves them, and what does not."""

import importlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import llvmlite
import llvmlite.binding
import pytest
from small import ended, started, written

import pvlvrt_compliance
from pvlvrt_compliance import kernel
from pvlvrt_compliance.compiled import sources as sources_module
from pvlvrt_compliance.compiled.sources import Sources
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.simulation.loop import run
from pvlvrt_compliance.simulation.streaming import averages, frequency, harmonics, whole_cycles

PACKAGE = Path(pvlvrt_compliance.__file__).parent
HERE = Path(__file__).parent

# Of each entry point: digest and key, and what they are with one byte edited in each of its files, and with others.
EDITS = """
import json, sys
from pathlib import Path
import bundled
from pvlvrt_compliance.kernel import plain, sources_of
from pvlvrt_compliance.compiled.sources import Sources
from pvlvrt_compliance.simulation.loop import run

def now(entry):
    sources = Sources(plain(entry), "pvlvrt_compliance.kernel", Path(sys.argv[1]))
    return sources.digest, sources.key

def edited(entry, file):
    text = file.read_bytes()
    file.write_bytes(text[:3] + bytes([text[3] ^ 1]) + text[4:])
    try:
        return now(entry)
    finally:
        file.write_bytes(text)

found = []
for entry in (run, bundled.kept, bundled.advance):
    sources = sources_of(entry)
    files = {module: Path(sources.file_of(module)) for module in sources.texts}
    others = [Path(file) for file in sys.argv[2:]]
    found.append({
        "files": {module: str(file) for module, file in files.items()},
        "now": [now(entry), (sources.digest, sources.key)],
        "edited": {module: edited(entry, file) for module, file in files.items()},
        "others": [edited(entry, file) for file in others],
    })
print(json.dumps(found))
"""


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """What `EDITS` says of each entry point, in a copy of the package."""
    copy = tmp_path_factory.mktemp("copy")
    package = copy / PACKAGE.name
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(HERE.parent / "controllers" / "bundled.py", copy)
    others = [
        package / name for name in ("errors.py", "checks/evaluate.py", "simulation/simulate.py", "compiled/keeping.py")
    ]
    command = [sys.executable, "-c", EDITS, str(copy / "cache"), *map(str, others)]
    environment = os.environ | {"PYTHONPATH": str(copy)}
    answer = subprocess.run(command, env=environment, cwd=copy, check=True, capture_output=True, text=True).stdout
    entries = json.loads(answer)
    assert all(file.startswith(str(copy)) for entry in entries for file in entry["files"].values())
    return dict(zip(("run", "kept", "advance"), entries, strict=True))


ENTRIES = pytest.mark.parametrize("name", ["run", "kept", "advance"])


@ENTRIES
def test_one_byte_of_any_file_moves_both(found, name):
    """A byte more or less in any file that decides is another digest and another key."""
    entry = found[name]
    seen = [entry["now"][0], *entry["edited"].values()]
    assert len({digest for digest, _ in seen}) == len({key for _, key in seen}) == len(entry["files"]) + 1


@ENTRIES
def test_nothing_else_moves_them(found, name):
    """Files that decide nothing, and whether the sources have been noted, are no part of them."""
    entry = found[name]
    assert {tuple(x) for x in [*entry["now"], *entry["others"]]} == {tuple(entry["now"][0])}


def test_every_block_is_a_source_of_an_entry(found):
    """No module of the package has compiled code that no entry point counts as its source."""
    decorated = re.compile(r"^@(cached_)?kernel\b", re.MULTILINE)
    users = {
        ".".join([PACKAGE.name, *path.relative_to(PACKAGE).with_suffix("").parts])
        for path in PACKAGE.rglob("*.py")
        if decorated.search(path.read_text(encoding="utf-8"))
    }
    assert f"{PACKAGE.name}.control.lvrt" in users
    measuring = (averages.phasors_into, frequency.frequency_pass, harmonics.harmonics_into, whole_cycles.sums_into)
    counted = {module for entry in measuring for module in kernel.sources_of(entry).texts}
    assert users <= counted | {module for entry in found.values() for module in entry["files"]}


def test_sources_of_the_loop():
    """What the loop is made of: blocks, constants that only arithmetic uses, what has it compiled; no check.

    The one loop serves every controller. So the digest of the bundled one, which a report carries, goes by the compiled
    side of a door as well, and a door's by the bundled blocks.
    """
    modules = {module.removeprefix(f"{PACKAGE.name}.") for module in kernel.sources_of(run).texts}
    assert {"kernel", "control.lvrt", "plant.plant", "space_vectors", "sogi", "simulation.loop"} <= modules
    assert {"hardware.precision", "control.precision", "control.synchronised", "measured"} <= modules
    assert {"simulation.recorder", "simulation.columns", "simulation.controlling", "simulation.sample"} <= modules
    door = {"call", "controller", "exchange", "native_call", "ports", "table"}
    assert {f"simulation.door.{name}" for name in door} <= modules
    assert not {"errors", "units", "controllers.run", "simulation.simulate", "simulation.translate"} & modules


MACHINES = {
    "numba": lambda patch: patch.setattr(sources_module, "numbas_release", lambda: "0.0"),
    "llvmlite": lambda patch: patch.setattr(llvmlite, "__version__", "0.0"),
    "processor": lambda patch: patch.setattr(llvmlite.binding, "get_host_cpu_name", lambda: "another"),
    "its features": lambda patch: patch.setattr(llvmlite.binding, "get_host_cpu_features", lambda: Features(a=True)),
    "its features are not known": lambda patch: patch.setattr(llvmlite.binding, "get_host_cpu_features", not_known),
}


class Features(dict[str, bool]):
    """Features of a processor, as the compiler gives them."""

    def flatten(self) -> str:
        return ",".join(self)


def not_known() -> Features:
    """What the compiler does on a processor that it cannot ask."""
    raise RuntimeError("no features")


@pytest.mark.parametrize("machine", MACHINES)
def test_another_machine_has_another_key(monkeypatch, machine):
    """Versions of the compiler and the processor move the key, and leave the digest that a report carries."""
    sources = kernel.sources_of(run)
    digest, key = sources.digest, sources.key
    MACHINES[machine](monkeypatch)
    assert sources.key != key
    assert sources.digest == digest


def test_the_digest_is_that_of_the_files_alone():
    """Without the compiler, or for another processor, the files are the same ones and the digest is, too."""
    code = (
        "from pvlvrt_compliance.kernel import sources_of; from pvlvrt_compliance.simulation.loop import run; "
        "print(sources_of(run).digest)"
    )
    for option in ({"NUMBA_DISABLE_JIT": "1"}, {"NUMBA_CPU_NAME": "generic"}):
        answer = subprocess.run([sys.executable, "-c", code], env=os.environ | option, capture_output=True, check=True)
        assert answer.stdout.decode().strip() == kernel.sources_of(run).digest


def test_a_constant_counts_by_its_value(tmp_path, monkeypatch):
    """A constant that is something else by the time of compilation is another key, though no file says so."""
    program = written(tmp_path / "program")
    monkeypatch.syspath_prepend(str(program))
    importlib.invalidate_caches()
    small = importlib.import_module("small_block")
    block = kernel.plain(small.amplified)
    first, second = (Sources(block, kernel.__name__, None) for _ in range(2))
    key = first.key
    monkeypatch.setattr(small, "K", 4.0)
    assert second.digest == first.digest
    assert second.key != key
    for name in ("small_block", "small_gain", "small_numbers"):
        del sys.modules[name]


@pytest.mark.parametrize("kept", [True, False])
def test_bytecode_of_another_text_is_refused(tmp_path, monkeypatch, kept):
    """An edit that keeps size and time is one that Python does not see: no verdict rather than that of the old text."""
    monkeypatch.delenv("PYTHONDONTWRITEBYTECODE", raising=False)
    program, cache = written(tmp_path / "program"), tmp_path / "cache"
    assert ended(started(program, cache))[0] == "7.0 0"
    file = program / "small_numbers.py"
    times = file.stat()
    file.write_text("BASE = 3.0\n")
    os.utime(file, ns=(times.st_atime_ns, times.st_mtime_ns))
    if not kept:
        shutil.rmtree(cache)
    process = started(program, cache)
    _, said = process.communicate()
    assert process.returncode != 0
    assert f"{UsageError.__name__}: {file}: Python runs " in said
    shutil.rmtree(program / "__pycache__")
    assert ended(started(program, cache))[0] == "11.0 0"
