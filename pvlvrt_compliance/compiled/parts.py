"""How blocks are compiled: to code that is not finished, as nothing but what they are inlined into is ever run.

numba by itself optimises each, with all that it calls, and makes machine code of it: once for every level of calls.
"""

from collections.abc import Callable
from typing import Any

from numba.core import compiler
from numba.core.codegen import JITCodeLibrary


class Part(JITCodeLibrary):
    """Code that others link. Numba's own optimisation of single functions is all it gets by itself."""

    @property
    def codegen(self) -> Any:
        """Where it belongs."""
        return _Unfinished(self._codegen)

    def finalize(self) -> None:
        """Have it complete, with all that it calls."""
        for library in dict.fromkeys(self._linking_libraries):
            self._reload_init.update(library._reload_init)
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        self._finalize_dynamic_globals()  # type: ignore[no-untyped-call]
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Address of what cannot be called yet: none."""
        del name
        self._ensure_finalized()  # type: ignore[no-untyped-call]
        return 0


class _Unfinished:
    """A target of numba's for which there is no function yet whose surroundings could be set."""

    def __init__(self, codegen: Any) -> None:
        self._codegen = codegen

    def set_env(self, env_name: str, env: Any) -> None:
        """Nothing has a place to keep them; what numbers are computed by has no use for them."""

    def __getattr__(self, name: str) -> Any:
        return getattr(self._codegen, name)


class PartCompiler(compiler.Compiler):
    """numba's compiler, for parts."""

    def compile_extra(self, func: Callable[..., Any]) -> Any:
        """Compile a function."""
        part: Any = Part
        self.state.library = part(self.state.targetctx.codegen(), func.__qualname__)
        return super().compile_extra(func)  # type: ignore[no-untyped-call]
