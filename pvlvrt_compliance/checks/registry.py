"""Which function judges which kind of requirement."""

from collections.abc import Callable
from importlib import import_module
from importlib.metadata import entry_points
from typing import Any

from pvlvrt_compliance.checks.evidence import Evidence
from pvlvrt_compliance.checks.results import Check
from pvlvrt_compliance.profile.requirements import Requirements

ENTRY_POINT_GROUP = "pvlvrt_compliance.checks"

# The requirement type belongs to its kind; a profile's `custom` kinds hand over a `CustomRequirement`.
Judge = Callable[[Any, Evidence], Check]

BUILT_IN = tuple(kind for kind in Requirements.model_fields if kind != "custom")
"""Kinds of this package: ``check_KIND`` in the file ``KIND.py`` of this folder judges each."""


def find_judge(kind: str) -> Judge | None:
    """Return the function that judges a kind, None when no installed package has one.

    Other packages are looked at only for kinds that are not built in.
    """
    if kind in BUILT_IN:
        judge: Judge = getattr(import_module(f"pvlvrt_compliance.checks.{kind}"), f"check_{kind}")
        return judge
    for entry_point in entry_points(group=ENTRY_POINT_GROUP, name=kind):
        loaded: Judge = entry_point.load()
        return loaded
    return None
