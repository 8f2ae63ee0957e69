"""Which check judges which kind of requirement: those of this package, and those that other packages announce."""

import inspect
import sys
import warnings
from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile.requirements import BUILT_IN, CustomRequirement, Requirement

if TYPE_CHECKING:
    from pvlvrt_compliance.evidence.evidence import Evidence
    from pvlvrt_compliance.results import Verdict

ENTRY_POINT_GROUP = "pvlvrt_compliance.checks"
"""Each entry is a class, or a tuple of classes."""

_OWN_ENTRY = "pvlvrt_compliance.checks.built_in:CHECKS"

Judge = Callable[[Any, "Evidence"], "Verdict"]
"""How checks were written before they were classes."""


class FunctionCheck(Check):
    """A function ``(requirement, evidence) -> Verdict`` in place of a class, for a `CustomRequirement`."""

    kind = ""
    title = ""
    requirement = CustomRequirement

    def __init__(self, kind: str, function: Judge) -> None:
        self.kind = kind  # type: ignore[misc]
        self.title = kind.replace("_", " ")  # type: ignore[misc]
        self._function = function

    def judge(self, requirement: Any, evidence: "Evidence") -> "Verdict":
        """Call the function."""
        return self._function(requirement, evidence)


def find_check(kind: str) -> Check | None:
    """Return the check of a kind, None when no installed package has one.

    Other packages are looked at only for kinds that are not built in.

    Raises
    ------
    UsageError
        When a package announces something that is no check, or two announce the same kind.
    """
    return _of_this_package().get(kind) or _of_other_packages().get(kind)


def judges_connection(kind: str) -> bool:
    """Whether verdicts of a kind say if the inverter may stop."""
    check = find_check(kind)
    return check is not None and check.judges_connection


def kinds_of_other_packages() -> dict[str, type[Requirement]]:
    """Kinds that stand in a table of their own; what brings no model stands under ``custom``."""
    return {
        kind: check.requirement
        for kind, check in _of_other_packages().items()
        if check.requirement is not CustomRequirement
    }


@cache
def _of_this_package() -> dict[str, Check]:
    # As the entry point names it, and without the package's metadata, too.
    classes = import_module("pvlvrt_compliance.checks.built_in").CHECKS
    return {check.kind: check() for check in classes}


def _of_other_packages() -> dict[str, Check]:
    return _announced_on(tuple(sys.path))


@cache
def _announced_on(path: tuple[str, ...]) -> dict[str, Check]:
    """Checks that installed packages announce; what is installed goes by the path that modules are looked for on."""
    from importlib.metadata import entry_points

    del path

    found: dict[str, Check] = {}
    for entry in entry_points(group=ENTRY_POINT_GROUP):
        if entry.value != _OWN_ENTRY:
            for check in _checks_in(entry.name, _loaded(entry)):
                if check.kind in found or check.kind in BUILT_IN:
                    raise UsageError(f"entry point {entry.name}: there is already a check {check.kind!r}")
                found[check.kind] = check
    return found


def _loaded(entry: Any) -> Any:
    try:
        return entry.load()
    except Exception as error:  # a package of others may raise what it likes
        text = f"{type(error).__name__}: {error}"
        raise UsageError(f"entry point {entry.name} of {ENTRY_POINT_GROUP} cannot be loaded: {text}") from error


def _checks_in(name: str, announced: Any) -> list[Check]:
    if inspect.isclass(announced) and issubclass(announced, Check):
        return [announced()]
    if isinstance(announced, tuple | list):
        return [check for part in announced for check in _checks_in(name, part)]
    if inspect.isroutine(announced):
        warnings.warn(
            f"the check {name!r} is a function; make it a class (pvlvrt_compliance.checks.api.Check): functions go"
            " after the next release",
            DeprecationWarning,
            stacklevel=2,
        )
        return [FunctionCheck(name, announced)]
    raise UsageError(f"entry point {name}: {announced!r} is no check (pvlvrt_compliance.checks.api.Check)")
