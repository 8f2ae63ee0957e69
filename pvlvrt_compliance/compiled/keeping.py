"""Machine code kept from one process to the next, in a folder of its own or not at all.

numba's own cache goes by the one file of the function, takes another folder where it cannot have the one it is given,
and unpickles whatever lies there. This one takes its place in a compiled function.
"""

import hashlib
import pickle
from collections.abc import Iterable
from functools import cached_property
from pathlib import Path
from types import FunctionType
from typing import Any

import numba
from numba.core import caching, compiler, serialize

from pvlvrt_compliance.compiled.checked_file import DamagedError, read_checked, write_checked
from pvlvrt_compliance.compiled.notes import discard, say_not_kept
from pvlvrt_compliance.compiled.sources import Sources

_dumps: Any = serialize.dumps
_rebuild: Any = compiler.CompileResult._rebuild


class KernelCache(caching._Cache):
    """Cache of one compiled function: a file for each signature, in a folder named after the key of its sources."""

    def __init__(self, function: FunctionType, sources: Sources, root: Path | None) -> None:
        self._module = function.__module__
        self._name = function.__qualname__.replace("<", "").replace(">", "")  # no part of a file's name everywhere
        self._sources = sources
        self._root = root
        self._enabled = True

    @cached_property
    def folder(self) -> Path | None:
        """Where the code is kept; none where no folder is known."""
        return self._root / f"kernels-{self._sources.key}" / self._module if self._root is not None else None

    @property
    def cache_path(self) -> str | None:
        """The same, as numba asks for it."""
        return str(self.folder) if self.folder is not None else None

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
            self._sources.refuse_old_bytecode()
        return found

    def _load(self, sig: Any, target_context: Any) -> Any:
        file = self._file_for(sig, target_context.codegen())
        if file is None:
            return None
        try:
            data = read_checked(file, _purpose(file))
            return _rebuilt(data, sig, target_context) if data is not None else None
        except DamagedError as error:
            discard(file, error)
        except OSError:  # if it cannot be replaced either, that is said then
            pass
        return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep machine code that has just been made, if that is possible."""
        file = self._file_for(sig, data.codegen) if self._enabled else None
        if file is None:
            say_not_kept("there is no home folder; NUMBA_CACHE_DIR names another")
        elif not data.lifted and not data.library.has_dynamic_globals:  # neither holds in another process
            try:
                write_checked(file, _purpose(file), _dumps((sig, data._reduce())))
            except OSError as error:
                say_not_kept(f"{self._root}: {error.strerror or error}; NUMBA_CACHE_DIR names another folder")

    def enable(self) -> None:
        """Use it."""
        self._enabled = True

    def disable(self) -> None:
        """Neither read nor write."""
        self._enabled = False

    def flush(self) -> None:
        """Forget what is kept of this version."""
        for file in self.folder.glob(f"{self._name}-*.nbi") if self.folder is not None else ():
            file.unlink(missing_ok=True)

    def _file_for(self, sig: Any, codegen: Any) -> Path | None:
        """File for a signature and a target of the compiler, which options of numba's may change."""
        which = hashlib.sha256(f"{sig} {_fields_in(sig)} {codegen.magic_tuple()}".encode()).hexdigest()[:16]
        return self.folder / f"{self._name}-{which}.nbi" if self.folder is not None else None  # a suffix of numba's own


def _fields_in(types: Iterable[Any]) -> list[Any]:
    """Names of the fields of all tuples among types, which those do not tell: code knows a field by its place."""
    tuples: Iterable[Any] = (x for x in types if isinstance(x, numba.types.BaseTuple))
    return [(getattr(x, "fields", ()), _fields_in(x)) for x in tuples]


def _purpose(file: Path) -> str:
    """What the head of a file confirms besides its content: a file in another's place is none."""
    return "/".join(file.parts[-3:])


def _rebuilt(data: bytes, sig: Any, target_context: Any) -> Any:
    """Code from the content of a file, none if it is for other types of the same names."""
    kept, reduced = pickle.loads(data)
    return _rebuild(target_context, *reduced) if kept == sig else None
