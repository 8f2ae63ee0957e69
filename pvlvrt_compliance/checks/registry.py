"""Which function judges a kind of requirement. Other packages add kinds through an entry point."""

from collections.abc import Callable
from importlib.metadata import entry_points
from typing import Any

from pvlvrt_compliance.checks import current_limit, dc_ripple, reactive_support, ride_through
from pvlvrt_compliance.checks.evidence import Evidence
from pvlvrt_compliance.checks.results import Check

ENTRY_POINT_GROUP = "pvlvrt_compliance.checks"
"""An entry point of this group is named as the kind of requirement and refers to a `Judge`."""

# The requirement's type belongs to its kind; a profile's `custom` kinds hand over a `CustomRequirement`.
Judge = Callable[[Any, Evidence], Check]

_BUILT_IN: dict[str, Judge] = {
    ride_through.KIND: ride_through.check_ride_through,
    current_limit.KIND: current_limit.check_current_limit,
    reactive_support.KIND: reactive_support.check_reactive_support,
    dc_ripple.KIND: dc_ripple.check_dc_ripple,
}


def find_judge(kind: str) -> Judge | None:
    """Return the function that judges a kind, None when no installed package has one.

    Other packages are looked at only for kinds that are not built in.
    """
    if kind in _BUILT_IN:
        return _BUILT_IN[kind]
    for entry_point in entry_points(group=ENTRY_POINT_GROUP, name=kind):
        judge: Judge = entry_point.load()
        return judge
    return None
