"""The checks of this package, found by listing its folders: what its entry point names."""

from importlib import import_module
from pkgutil import iter_modules

from pvlvrt_compliance.checks import connection, current, power, quality
from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.profile.requirements import BUILT_IN


def _classes() -> list[type[Check]]:
    modules = [
        import_module(f"{room.__name__}.{module.name}")
        for room in (connection, current, power, quality)
        for module in iter_modules(room.__path__)
    ]
    found = [x for module in modules for x in vars(module).values() if isinstance(x, type) and issubclass(x, Check)]
    order = list(BUILT_IN)
    return sorted({x for x in found if hasattr(x, "kind")}, key=lambda check: order.index(check.kind))


CHECKS: tuple[type[Check], ...] = tuple(_classes())
"""In the order of a report."""
