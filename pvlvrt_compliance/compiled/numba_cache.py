"""Machine code that numba loads, for what only numba can call: kept as all other code is.

numba's own cache goes by the one file of the function, takes another folder where it cannot have the one it is given,
and unpickles whatever lies there. This one takes its place in a compiled function.
"""

import pickle
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numba
from numba.core import caching, compiler, serialize

from pvlvrt_compliance.compiled.keeping import Keeping

_SUFFIX = ".nbi"  # numba's own
_dumps: Any = serialize.dumps
_rebuild: Any = compiler.CompileResult._rebuild


class KernelCache(caching._Cache):
    """Cache of one compiled function."""

    def __init__(self, keeping: Keeping) -> None:
        self._keeping = keeping
        self._enabled = True

    @property
    def cache_path(self) -> str | None:
        """Folder of the code, as numba asks for it; none where no folder is known."""
        folder = self._keeping.folder
        return str(folder) if folder is not None else None

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Machine code for arguments of these types; none if there is none.

        Raises
        ------
        UsageError
            When it is to be compiled from another text than that of its files.
        """
        target_context.refresh()
        found = self._load(sig, target_context) if self._enabled else None
        if found is None:
            self._keeping.sources.refuse_old_bytecode()
        return found

    def _load(self, sig: Any, target_context: Any) -> Any:
        data = self._keeping.read(self._file_for(sig, target_context.codegen()))
        return _rebuilt(data, sig, target_context) if data is not None else None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep machine code that has just been made, if that is possible."""
        if self._enabled and not data.lifted and not data.library.has_dynamic_globals:  # those hold in this process
            self._keeping.write(self._file_for(sig, data.codegen), _dumps((sig, data._reduce())))

    def enable(self) -> None:
        """Use it."""
        self._enabled = True

    def disable(self) -> None:
        """Neither read nor write."""
        self._enabled = False

    def flush(self) -> None:
        """Forget what is kept of this version."""
        self._keeping.flush(_SUFFIX)

    def _file_for(self, sig: Any, codegen: Any) -> Path | None:
        """File for a signature and a target of the compiler, which options of numba's may change."""
        return self._keeping.file_for(f"{sig} {_fields_in(sig)} {codegen.magic_tuple()}", _SUFFIX)


def _fields_in(types: Iterable[Any]) -> list[Any]:
    """Names of the fields of all tuples among types, which those do not tell: code knows a field by its place."""
    tuples: Iterable[Any] = (x for x in types if isinstance(x, numba.types.BaseTuple))
    return [(getattr(x, "fields", ()), _fields_in(x)) for x in tuples]


def _rebuilt(data: bytes, sig: Any, target_context: Any) -> Any:
    """Code from the content of a file, none if it is for other types of the same names."""
    kept, reduced = pickle.loads(data)
    return _rebuild(target_context, *reduced) if kept == sig else None
