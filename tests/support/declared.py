"""What pyproject.toml says that an installation brings."""

import re
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

_PROJECT = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text("utf-8"))["project"]
_USERS = ("test", "docs", "dev")
"""Extras of those who work on the package."""


def always():
    """Distributions that every installation is told to bring."""
    return set(map(_name, _PROJECT["dependencies"]))


def extras():
    """Distributions of each extra for users, without what every installation has."""
    asked = {name: wanted for name, wanted in _PROJECT["optional-dependencies"].items() if name not in _USERS}
    return {name: set(map(_name, wanted)) - always() for name, wanted in asked.items()}


def only_extras():
    """Packages, by the names that they are imported by, that only an extra brings."""
    wanted = set().union(*extras().values())
    return {name for name, of in packages_distributions().items() if wanted & set(map(str.lower, of))}


def _name(requirement):
    return re.match(r"[\w.-]+", requirement)[0].lower()
