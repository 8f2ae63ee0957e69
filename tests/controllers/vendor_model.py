"""The vendor's model of `examples/vendor-model`, built in a folder of its own."""

import shutil
import subprocess
import sys
from pathlib import Path

from pvlvrt_compliance.controllers.library import HEADER

EXAMPLE = Path(__file__).parents[2] / "examples" / "vendor-model"
FORMS = {"c": "liblcl1000.so", "fmu": "LCL1000.fmu", "python": "lcl1000.py:LCL1000"}
BASES = {"VLLbase": 398.37, "Sbase": 500.0}
"""Of the plant, in place of the model's own 600 V and 1 MVA."""


def built(folder: Path, gcc: str) -> dict[str, str]:
    """Build a copy of it by its own Makefile, with no warning; the specification of each form."""
    copy = folder / EXAMPLE.name
    shutil.copytree(EXAMPLE, copy, ignore=shutil.ignore_patterns("*.so", "*.fmu", "__pycache__"))
    flags = ["CFLAGS=-std=c99 -O2 -Wall -Wextra -Werror -pedantic", f"CC={gcc}", f"PYTHON={sys.executable}"]
    command = ["make", "-s", f"INTERFACE={HEADER.parent}", *flags]
    subprocess.run(command, cwd=copy, check=True)
    return {form: str(copy / name) for form, name in FORMS.items()}
