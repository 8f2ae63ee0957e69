"""Further controllers that do harm in a deep sag, beside those of `support/evil.py`: forty of each door in all."""

import os
import shutil
import subprocess
import textwrap
import zipfile
from pathlib import Path

from evil import BELOW_PU, EVIL, Evil, compile_library
from evil_sources import LIBRARY_DEEDS
from tests.hostile.evil_texts import C_DEEDS, DESCRIPTION, FMU, LIBRARY, PROGRAM, PROGRAM_DEEDS, PYTHON, PYTHON_DEEDS

_NOT_OF_A_LIBRARY = "instance"
"""In the text of a deed that only a library can do."""


def _function(deed: str) -> str:
    return "def deed(self=None):\n" + textwrap.indent(deed, "    ")


def _python(deed: str, expected: str) -> Evil:
    text = PYTHON.replace("{deed}", _function(deed)).replace("{below}", str(BELOW_PU))
    return Evil("python", {"evil.py": text}, expected)


def _program(deed: str, expected: str) -> Evil:
    text = PROGRAM.replace("{deed}", _function(deed)).replace("{below}", str(BELOW_PU))
    return Evil("program", {"evil.py": text}, expected)


def _library(deed: str, expected: str) -> Evil:
    text = LIBRARY.replace("{deed}", deed).replace("{below}", str(BELOW_PU))
    return Evil("library", {"evil.c": text}, expected, make=compile_library)


def _fmu(deed: str, expected: str) -> Evil:
    text = FMU.replace("{deed}", deed).replace("{below}", str(BELOW_PU))
    return Evil("fmu", {"evil.c": text}, expected, make=_pack)


def _pack(folder: Path) -> None:
    """Build ``evil.fmu`` of ``evil.c``."""
    gcc = shutil.which("gcc")
    assert gcc is not None
    binary = folder / "evil.so"
    flags = ["-std=gnu99", "-O1", "-w", "-shared", "-fPIC"]
    subprocess.run([gcc, *flags, folder / "evil.c", "-o", binary, "-lm"], check=True)
    with zipfile.ZipFile(folder / "evil.fmu", "w") as archive:
        archive.writestr("modelDescription.xml", DESCRIPTION)
        archive.write(binary, f"binaries/linux64/{binary.name}")
    binary.unlink()


MORE: dict[str, Evil] = {
    **{f"{name}, python": _python(*deed) for name, deed in PYTHON_DEEDS.items()},
    **{f"{name}, program": _program(*deed) for name, deed in PROGRAM_DEEDS.items()},
    **{f"{name}, library": _library(*deed) for name, deed in C_DEEDS.items()},
    **{f"{name}, fmu": _fmu(*deed) for name, deed in C_DEEDS.items()},
    **{
        f"{name} as well, fmu": _fmu(f"{deed} return 0;", "")
        for name, deed in LIBRARY_DEEDS.items()
        if _NOT_OF_A_LIBRARY not in deed
    },
}
"""By name and door."""

ALL: dict[str, Evil] = {name: evil for name, evil in (EVIL | MORE).items() if os.name != "nt"}
"""All that there are."""


def needs_compiler(evil: Evil) -> bool:
    """Whether gcc is needed."""
    return "evil.c" in evil.files
