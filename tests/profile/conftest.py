"""Profiles written by a test."""

from collections.abc import Callable
from pathlib import Path

import pytest

from pvlvrt_compliance.profile import Profile, known_profiles, load_profile

HEAD = 'schema_version = 1\nid = "{name}"\ntitle = "a profile of a test"\n'


@pytest.fixture(scope="session")
def shipped() -> dict[str, Profile]:
    """Every profile that ships."""
    return {name: load_profile(name) for name in known_profiles()}


@pytest.fixture
def write(tmp_path: Path) -> Callable[..., str]:
    """Write a profile that includes iec61400-21, or not, and hand back its path."""

    def make(text: str = "", name: str = "mine", include: str = '["iec61400-21"]', head: str = HEAD) -> str:
        file = tmp_path / f"{name}.toml"
        file.write_text(head.format(name=name) + (f"include = {include}\n" if include else "") + text, encoding="utf-8")
        return str(file)

    return make
