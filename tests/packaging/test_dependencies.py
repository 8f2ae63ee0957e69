"""What the package imports, and what pyproject.toml says that an installation brings."""

import ast
import sys
from importlib.metadata import packages_distributions, requires
from pathlib import Path

from packaging.requirements import Requirement

import pvlvrt_compliance
from declared import always, extras

_PACKAGE = Path(pvlvrt_compliance.__file__).parent
_OUTSIDE = {"pytest"}
"""What brings itself: the plugin is imported by pytest alone."""


def _imports(tree):
    """Names of packages that are imported, each with whether somebody waits for an ImportError there or behind."""
    waits = {
        inner
        for each in ast.walk(tree)
        if isinstance(each, ast.Try)
        and any(
            one.type and {"ImportError", "ModuleNotFoundError"} & set(ast.unparse(one.type).split())
            for one in each.handlers
        )
        for inner in ast.walk(each)
    }
    for each in ast.walk(tree):
        if isinstance(each, ast.Import):
            yield from ((one.name.partition(".")[0], each in waits) for one in each.names)
        elif isinstance(each, ast.ImportFrom) and not each.level:
            yield each.module.partition(".")[0], each in waits


def _brought(names):
    """Distributions with what they bring themselves."""
    found, left = set(), list(names)
    while left:
        name = left.pop()
        if name not in found:
            found.add(name)
            asked = map(Requirement, requires(name) or ())
            now = (one for one in asked if one.marker is None or one.marker.evaluate({"extra": ""}))
            left += [one.name.lower().replace("_", "-") for one in now]
    return found


def test_what_is_imported_is_brought_or_its_extra_named():
    """What is no dependency is of an extra; the file that imports it says which where it is not there."""
    of = {name: {one.lower().replace("_", "-") for one in found} for name, found in packages_distributions().items()}
    own = sys.stdlib_module_names | {_PACKAGE.name} | _OUTSIDE
    brought, wanted = _brought(always()), {extra: _brought(names) for extra, names in extras().items()}
    for path in _PACKAGE.rglob("*.py"):
        if "templates" in path.parts:
            continue  # projects of users
        text = path.read_text("utf-8")
        found = list(_imports(ast.parse(text)))
        for name in {name for name, _ in found if name not in own and not of[name] & brought}:
            named = {extra for extra, names in wanted.items() if of[name] & names}
            answered = {each for each, waits in found if waits and each not in own}
            assert answered, f"{path}: {name} need not be there"
            assert any(f"pvlvrt-compliance[{extra}]" in text for extra in named), f"{path}: {name} is of {named}"
