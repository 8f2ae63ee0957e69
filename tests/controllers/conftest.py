"""Controllers of these tests, opened once."""

import shutil
import subprocess
from collections.abc import Callable
from functools import cache, lru_cache
from pathlib import Path

import pytest
import vendor_model

from pvlvrt_compliance.controllers.library import HEADER
from pvlvrt_compliance.controllers.simulator import ForeignSimulator

FOLDER = Path(__file__).parent
LIBRARY = FOLDER / "library"
FLAGS = ("-Wall", "-Wextra", "-Werror", "-O2", "-shared", "-fPIC", f"-I{HEADER.parent}")


@pytest.fixture(scope="session")
def opened() -> Callable[..., ForeignSimulator]:
    """Open a controller of this folder: ``opened("file.py:Class", name=value, ...)``."""

    @lru_cache(maxsize=None, typed=True)
    def opened(spec, **given):
        return ForeignSimulator(f"{FOLDER / spec}", given)

    return opened


@pytest.fixture(scope="session")
def gcc() -> str:
    """The C compiler."""
    found = shutil.which("gcc")
    if found is None:
        pytest.skip("gcc is missing, so no controller in C can be built")
    return found


@pytest.fixture(scope="session")
def vendor_forms(gcc: str, tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Specification of the vendor's model in C, as an FMU and in Python, by the form."""
    return vendor_model.built(tmp_path_factory.mktemp("vendor"), gcc)


@pytest.fixture(scope="session")
def compiled(gcc: str, tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """Build ``compiled("source.c", *definitions) -> library``, with its mapping beside it."""

    @cache
    def build(source: str | Path, *definitions: str) -> Path:
        file = LIBRARY / source
        library = tmp_path_factory.mktemp("library") / f"lib{file.stem}.so"
        flags = (*FLAGS, *(f"-D{name}" for name in definitions))
        subprocess.run([gcc, "-std=c99", *flags, str(file), "-o", str(library), "-lm"], check=True)
        mapping = LIBRARY / f"lib{file.stem}.mapping.toml"
        if mapping.is_file():
            shutil.copy(mapping, library.parent)
        return library

    return build
