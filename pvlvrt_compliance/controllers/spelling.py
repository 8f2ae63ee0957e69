"""How the class of a controller in Python is written: by its file, or by its module. Imports nothing."""

import re

SUFFIX = ".py"
"""Of a file of Python."""

_NAME = r"[^\W\d]\w*"
MODULE_AND_CLASS = re.compile(rf"{_NAME}(\.{_NAME})*:{_NAME}")
"""``pkg.module:Class``; what ends like a file is one."""


def names_module(spec: str) -> bool:
    """Whether a specification names a module and a class in it."""
    return MODULE_AND_CLASS.fullmatch(spec) is not None and not spec.rpartition(":")[0].endswith(SUFFIX)
