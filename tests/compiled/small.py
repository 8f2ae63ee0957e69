"""A program so small that it compiles in a moment, in files of its own: what tests of the cache run."""

import os
import subprocess
import sys
from pathlib import Path

FILES = {
    "small_numbers.py": "BASE = 2.0\n",
    "small_gain.py": (
        "from small_numbers import BASE\n\n\ndef twice(x):\n    return 2 * x\n\n\nGAIN = twice(BASE) - 1.0\n"
    ),
    "small_block.py": (
        "from pvlvrt_compliance.kernel import kernel\nfrom small_gain import GAIN as K\n\n\n"
        "@kernel\ndef amplified(x):\n    return K * x\n"
    ),
    "small.py": (
        "from pvlvrt_compliance.kernel import cached_kernel\nfrom small_block import amplified\n\n\n"
        "@cached_kernel\ndef entry(x):\n    return amplified(x) + 1.0\n"
    ),
}
"""Text by file: ``entry(x)`` is 3 x + 1."""

_PROGRAM = "import small; print(small.entry(2.0), small.entry.found_kept)"


def written(folder: Path) -> Path:
    """Write the files in a folder, which is made."""
    folder.mkdir(parents=True)
    for name, text in FILES.items():
        (folder / name).write_text(text, "utf-8")
    return folder


def started(program: Path, cache: Path, *, code: str = _PROGRAM, **environment: str) -> "subprocess.Popen[str]":
    """Start the program in a process of its own."""
    paths = os.pathsep.join([str(program), *filter(None, [os.environ.get("PYTHONPATH")])])
    own = {"PYTHONPATH": paths, "NUMBA_CACHE_DIR": str(cache), **environment}
    command = [sys.executable, "-c", code]
    return subprocess.Popen(
        command, env=os.environ | own, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8"
    )


def ended(process: "subprocess.Popen[str]") -> tuple[str, str]:
    """Wait for it: what it gives and how often it found its code kept, and what it says besides."""
    out, said = process.communicate()
    assert process.returncode == 0, said
    return out.strip(), said


def ran(program: Path, cache: Path, **environment: str) -> tuple[str, str]:
    """Run the program in a process of its own."""
    return ended(started(program, cache, **environment))


def kept_in(cache: Path) -> list[Path]:
    """Files of machine code."""
    return sorted(cache.glob("kernels-*/*/*"))
