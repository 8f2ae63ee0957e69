"""Functions that are compiled when compiled code first comes to them: until then nothing imports numba."""

import functools
import os
import sys
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import Any, cast

_COMPILED_BY_DEFAULT = ("", "0")  # values of numba's own NUMBA_DISABLE_JIT


def is_interpreted() -> bool:
    """Whether compilation is turned off, by numba's own settings."""
    usual = os.environ.get("NUMBA_DISABLE_JIT", "") in _COMPILED_BY_DEFAULT
    if usual and "numba" not in sys.modules and not Path(".numba_config.yaml").exists():
        return False
    import numba

    config: Any = numba.config
    return bool(config.DISABLE_JIT)


class Block:
    """A function for compiled code, which takes it for what numba makes of it; Python cannot call it."""

    def __init__(self, function: Callable[..., Any], **options: Any) -> None:
        functools.update_wrapper(cast(Any, self), function)
        self.py_func = function
        self.targetoptions = options

    @cached_property
    def dispatcher(self) -> Any:
        """What numba makes of it."""
        import numba

        from pvlvrt_compliance.compiled.parts import PartCompiler

        njit: Any = numba.njit
        return njit(self.py_func, pipeline_class=PartCompiler, **self.targetoptions)

    @property
    def _numba_type_(self) -> Any:
        """Type of a global of this name in compiled code: numba asks for it."""
        return self.dispatcher._numba_type_

    def __reduce__(self) -> str:
        return self.py_func.__qualname__

    def __getattr__(self, name: str) -> Any:
        """Everything else that numba's own have, such as ``signatures``; nothing that only Python looks for."""
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.dispatcher, name)


class Instructions:
    """An intrinsic of compiled code; ``function`` is what `numba.extending.intrinsic` takes."""

    def __init__(self, function: Callable[..., Any]) -> None:
        functools.update_wrapper(cast(Any, self), function)

    @cached_property
    def _numba_type_(self) -> Any:
        from numba.core.registry import cpu_target
        from numba.extending import intrinsic

        context: Any = cpu_target.typing_context
        made = intrinsic(self.__wrapped__)  # type: ignore[attr-defined]
        context.refresh()
        return context.resolve_value_type(made)
