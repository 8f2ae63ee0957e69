"""Loads the benchmarks' modules, which are scripts beside the package."""

import importlib.util
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

_BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"


def _script(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"pvlvrt_benchmark_{name}", _BENCHMARKS / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def twin_module() -> ModuleType:
    """Module that builds and calls the twin."""
    return _script("twin")


@pytest.fixture(scope="session")
def agreement() -> ModuleType:
    """Module that compares two records."""
    return _script("agreement")


@pytest.fixture(scope="session")
def twin(twin_module: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """C twin of the package's loop."""
    if twin_module.compiler() is None:
        pytest.skip("gcc is missing, so the C twin cannot be built")
    return twin_module.Twin(tmp_path_factory.mktemp("twin"))


@pytest.fixture(scope="session")
def row() -> ModuleType:
    """Module of the rows of the table."""
    return _script("row")
