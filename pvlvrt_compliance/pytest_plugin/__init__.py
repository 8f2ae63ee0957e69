"""Grid codes in pytest: a file of settings is collected as tests, and a fixture judges controllers (docs/pytest.md).

pytest loads this in each of its runs where the package is installed, so nothing of the package is imported before a
file of settings is collected or the fixture is used.
"""

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from pvlvrt_compliance.settings import FILE, PROJECT_FILE

if TYPE_CHECKING:
    from pvlvrt_compliance.pytest_plugin.fixture import GridCode

MARK = "pvlvrt"
_TOLD = pytest.StashKey[list[str]]()


def pytest_configure(config: pytest.Config) -> None:
    """Announce the mark of the tests."""
    config.addinivalue_line("markers", f"{MARK}: a test of a grid code, out of a file of settings of pvlvrt-check")
    config.stash[_TOLD] = []


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Take a ``pvlvrt.toml``, and a ``pyproject.toml`` that was named."""
    named = parent.session.isinitpath(file_path)
    if file_path.name != FILE and not (file_path.name == PROJECT_FILE and named):
        return None
    from pvlvrt_compliance.pytest_plugin.collecting import SettingsFile

    return SettingsFile.of(parent, file_path, named=named, told=parent.config.stash[_TOLD])


def pytest_report_collectionfinish(config: pytest.Config) -> list[str]:
    """Say what was taken of files of settings and of the environment."""
    told = config.stash[_TOLD]
    return list(dict.fromkeys(told))


@pytest.fixture(scope="session")
def grid_code() -> "GridCode":
    """Judge a controller: ``grid_code("es-nts-631-lt110kv", controller=MyController, tests="VD*") -> Results``.

    The test fails with all verdicts that are red, unless ``must_pass=False`` is given. Options are those of
    `pvlvrt_compliance.check`.
    """
    from pvlvrt_compliance.pytest_plugin.fixture import GridCode

    return GridCode()
