"""The distributions of this checkout, built once."""

import sys
from pathlib import Path

import pytest

from calls import completed


@pytest.fixture(scope="session")
def root(request: pytest.FixtureRequest) -> Path:
    """The checkout."""
    return request.config.rootpath


@pytest.fixture(scope="session")
def distributions(root: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Build the sdist, and the wheel from the sdist alone."""
    folder = tmp_path_factory.mktemp("dist")
    completed(sys.executable, "-m", "build", "--outdir", folder, root, cwd=folder)
    return {path.suffix: path for path in folder.iterdir()}
