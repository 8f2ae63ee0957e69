"""A function by its name, with options: what is to be made of every record of a run, wherever that is.

A record stays where it was made, in this process or another one, for it is large; the name of a function goes there
instead, and what comes back is only what the function returns.
"""

from collections.abc import Callable, Mapping
from functools import partial
from importlib import import_module
from typing import Any, NamedTuple

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.results import TestResult

Making = Callable[[Evidence, TestResult], Any]
"""Makes something of a judged record, ``(evidence, result) -> T``."""


class Named(NamedTuple):
    """A function ``(evidence, result, **options) -> T``.

    Parameters
    ----------
    name : str
        Module and function, ``package.module:function``.
    options : mapping
        Keyword arguments; plain values, so that they go to another process as they are.
    """

    name: str
    options: Mapping[str, Any] = {}

    def found(self) -> Making:
        """The function, with its options.

        Raises
        ------
        UsageError
            When there is no such module or function.
        """
        module, colon, function = self.name.partition(":")
        try:
            made: Making = partial(getattr(import_module(module), function), **self.options)
        except (ImportError, AttributeError, TypeError, ValueError) as error:
            said = f"{self.name}: there is no such function; write package.module:function"
            raise UsageError(f"{said} ({error})" if colon else said) from None
        return made
