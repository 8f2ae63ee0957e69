"""Files of settings in folders of their own, and what holds by them."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from pvlvrt_compliance.cli.options import SETTINGS
from pvlvrt_compliance.settings.effective import Effective, effective


@pytest.fixture
def project(tmp_path, monkeypatch) -> Path:
    """A repository, with the home folder elsewhere; the working directory is its root."""
    (tmp_path / "repository" / ".git").mkdir(parents=True)
    (tmp_path / "home").mkdir()
    monkeypatch.setattr(Path, "home", lambda: tmp_path / "home")
    monkeypatch.chdir(tmp_path / "repository")
    return tmp_path / "repository"


@pytest.fixture
def hold(project) -> Callable[..., Effective]:
    """What holds: ``hold(text of pvlvrt.toml, environment, **typed)``."""

    def hold(text: str | None = None, environment: dict[str, str] | None = None, **typed: Any) -> Effective:
        if text is not None:
            (project / "pvlvrt.toml").write_text(text, "utf-8")
        return effective(SETTINGS, typed, environment or {}, start=Path.cwd())

    return hold
