"""An entry point: what Python calls, compiled when it is first called with arguments of such types, and kept."""

import functools
import inspect
import os
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from threading import RLock
from types import FunctionType
from typing import Any

from pvlvrt_compliance.compiled.flat import Flat, Kind, NotFlatError, flat, spelt
from pvlvrt_compliance.compiled.keeping import Keeping
from pvlvrt_compliance.compiled.sources import Sources

_FORM = "words 1"  # of what is kept; another one is another file
_OF_NO_ACCOUNT = frozenset({"NUMBA_CACHE_DIR", "NUMBA_DISABLE_JIT"})


class Entry:
    """A compiled function that Python calls with numbers, arrays, tuples of them, and none.

    The global interpreter lock is released while it runs. What it is called with else, or returns, is numba's affair.
    """

    def __init__(self, function: FunctionType, sources: Sources, root: Path | None, **options: Any) -> None:
        functools.update_wrapper(self, function)
        self.py_func = function
        self.targetoptions = options
        self.found_kept = 0  # kinds of arguments for which code was there
        self._keeping = Keeping(function, sources, root)
        self._known: dict[tuple[Kind, ...], Callable[[list[Any]], Any] | None] = {}
        self._lock = RLock()

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        """Call it."""
        if named or len(arguments) < self._count:
            bound = self._signature.bind(*arguments, **named)
            bound.apply_defaults()
            arguments = bound.args
        try:
            given = flat(arguments)
        except NotFlatError:
            return self.dispatcher(*arguments)
        if given.kinds not in self._known:
            with self._lock:
                if given.kinds not in self._known:
                    self._known[given.kinds] = self._found(given, arguments)
        found = self._known[given.kinds]
        return found(given.words) if found is not None else self.dispatcher(*arguments)

    def __reduce__(self) -> str:
        return self.py_func.__qualname__

    @cached_property
    def dispatcher(self) -> Any:
        """What numba makes of it, for whatever is no words."""
        import numba

        from pvlvrt_compliance.compiled.numba_cache import KernelCache

        njit: Any = numba.njit
        made = njit(self.py_func, nogil=True, no_cfunc_wrapper=True, **self.targetoptions)
        made._cache = KernelCache(self._keeping)
        return made

    def _found(self, given: Flat, arguments: tuple[Any, ...]) -> Callable[[list[Any]], Any] | None:
        """Code for such arguments: kept, or made and kept; none where numba has to do."""
        from pvlvrt_compliance.compiled.loading import Loaded, UnresolvedError, read

        file = self._keeping.file_for(f"{_FORM} {spelt(given.kinds)} {_settings()}", ".words")
        data = self._keeping.read(file)
        try:
            if data is not None:
                loaded = Loaded(read(data), given.kinds)
                self.found_kept += 1
                return loaded
            self._keeping.sources.refuse_old_bytecode()
            from pvlvrt_compliance.compiled.compiling import compiled

            code = compiled(self.py_func, arguments, self.targetoptions)
            loaded = Loaded(code, given.kinds)
        except (NotFlatError, UnresolvedError):
            return None
        self._keeping.write(file, code.written())
        return loaded

    @cached_property
    def _signature(self) -> inspect.Signature:
        return inspect.signature(self.py_func)

    @cached_property
    def _count(self) -> int:
        return self.py_func.__code__.co_argcount


def _settings() -> list[str]:
    """Settings of numba's own, any of which may change the code."""
    file = Path(".numba_config.yaml")
    given = [f"{name}={value}" for name, value in os.environ.items() if name.startswith("NUMBA_")]
    found = sorted(x for x in given if x.partition("=")[0] not in _OF_NO_ACCOUNT)
    return [*found, *([file.read_text("utf-8", "replace")] if file.is_file() else [])]
