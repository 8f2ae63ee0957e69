"""Controllers in C, compiled once."""

import shutil
import subprocess
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

import pvlvrt_compliance

FOLDER = Path(__file__).parent
HEADER = Path(pvlvrt_compliance.__file__).parent / "simulation" / "doors" / "ieee_cigre.h"
FLAGS = ("-Wall", "-Wextra", "-Werror", "-O2", "-shared", "-fPIC", f"-I{HEADER.parent}")
EXAMPLES = Path(__file__).resolve().parents[4] / "examples"


@pytest.fixture(scope="session")
def gcc() -> str:
    """The C compiler."""
    found = shutil.which("gcc")
    if found is None:
        pytest.skip("gcc is missing, so no controller in C can be built")
    return found


@pytest.fixture(scope="session")
def header() -> Path:
    """Our header of the interface."""
    return HEADER


@pytest.fixture(scope="session")
def compiled(gcc: str, tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """Build ``compiled("source.c", *definitions) -> library``, with its mapping beside it."""

    @cache
    def build(source: str | Path, *definitions: str) -> Path:
        file = FOLDER / source
        library = tmp_path_factory.mktemp("library") / f"lib{file.stem}.so"
        flags = (*FLAGS, *(f"-D{name}" for name in definitions))
        subprocess.run([gcc, "-std=c99", *flags, str(file), "-o", str(library), "-lm"], check=True)
        mapping = FOLDER / f"lib{file.stem}.mapping.toml"
        if mapping.is_file():
            shutil.copy(mapping, library.parent)
        return library

    return build


@pytest.fixture(scope="session")
def bundled_in_c(compiled: Callable[..., Path]) -> Path:
    """The example: the bundled controller."""
    return compiled(EXAMPLES / "bundled-controller-c" / "controller.c")
