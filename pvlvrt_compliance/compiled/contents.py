"""What a function that is to be compiled consists of: itself, what it calls, the constants and classes that it names.

Found from the living objects: these are what the compiler sees, whatever the files say by now.
"""

import enum
import hashlib
import sys
from collections.abc import Iterator, Mapping
from types import CodeType, FunctionType, GenericAlias, ModuleType, UnionType
from typing import Any, NamedTuple

import numpy as np

_LIBRARIES = frozenset({"llvmlite", "numba", "numpy", "scipy"})
_PLAIN = frozenset({bool, int, float, complex, str, bytes, type(None)})


class Contents(NamedTuple):
    """What a function consists of."""

    digest: str  # of bytecode, compiler's options, values of constants, fields of classes (hexadecimal)
    files: Mapping[str, str]  # by module: where its functions and classes are written
    constants: frozenset[tuple[str, str]]  # module that uses it, and its name there


def contents_of(function: Any) -> Contents:
    """Look through a function, compiled or not, and everything that it calls."""
    walk = _Walk()
    walk.describe(function)
    for kind in function.__annotations__.values():  # what comes in from Python; all others are built on the way
        walk.describe(kind)
    return Contents(walk.digest, walk.files, frozenset(walk.constants))


def is_library(module: str) -> bool:
    """Whether a module belongs to Python or to what compiles: those count by their versions."""
    top = module.partition(".")[0]
    return top in _LIBRARIES or top in sys.stdlib_module_names


def python_behind(x: Any) -> FunctionType | None:
    """Return the function of Python in a compiled function or an intrinsic of the compiler; none in anything else."""
    if isinstance(x, FunctionType):
        return x
    if isinstance(x, type):
        return None
    own: dict[str, Any] = getattr(x, "__dict__", {})
    inner = own.get("py_func", own.get("__wrapped__"))
    return inner if isinstance(inner, FunctionType) else None


class _Walk:
    """One walk through all that a function reaches, described in words that are the same in every process."""

    def __init__(self) -> None:
        self.files: dict[str, str] = {}
        self.constants: set[tuple[str, str]] = set()
        self._words: list[str] = []
        self._met: dict[int, tuple[int, Any]] = {}  # an identity is one only as long as its object lives
        self._looked_up: set[tuple[int, str]] = set()

    @property
    def digest(self) -> str:
        """Digest of all that has been described (hexadecimal)."""
        return hashlib.sha256("\0".join(self._words).encode("utf-8", "surrogatepass")).hexdigest()

    def describe(self, x: Any) -> None:
        """Describe anything."""
        if type(x) in _PLAIN:
            self._words.append(f"{type(x).__name__} {x!r}")
        elif (function := python_behind(x)) is not None:
            self._describe_function(x, function)
        elif isinstance(x, type):
            self._describe_class(x)
        elif isinstance(x, ModuleType):
            self._say("module", x.__name__)
        else:
            self._describe_value(x)

    def _say(self, *words: object) -> None:
        self._words += map(str, words)

    def _describe_function(self, x: Any, function: FunctionType) -> None:
        if not self._is_new(function):
            return
        module = function.__globals__.get("__name__", "")
        self._say(module, function.__qualname__)
        if is_library(module):
            return
        self._is_written_in(module, function.__globals__.get("__file__", function.__code__.co_filename))
        self._describe_code(function.__code__)
        cells = [cell.cell_contents for cell in function.__closure__ or ()]
        inside = (function.__defaults__, function.__kwdefaults__, cells, getattr(x, "targetoptions", {}))
        for part in inside:
            self.describe(part)
        names = [*_names_in(function.__code__)]
        self._look_up(function.__globals__, names)

    def _look_up(self, space: Mapping[str, Any], names: list[str]) -> None:
        """Describe what names stand for; of a module all that may be named."""
        for name in names:
            x = space.get(name)
            if (id(space), name) not in self._looked_up:
                self._looked_up.add((id(space), name))
                if name in space:
                    self._describe_named(space.get("__name__", ""), name, x)
            if isinstance(x, ModuleType) and not is_library(x.__name__):
                self._is_written_in(x.__name__, getattr(x, "__file__", None))
                self._look_up(vars(x), [part for part in names if (id(vars(x)), part) not in self._looked_up])

    def _describe_named(self, module: str, name: str, x: Any) -> None:
        if not isinstance(x, ModuleType | type) and python_behind(x) is None:
            self.constants.add((module, name))
        self._say(name, "is")
        self.describe(x)

    def _describe_code(self, code: CodeType) -> None:
        self._say(code.co_name, code.co_argcount, code.co_kwonlyargcount, code.co_posonlyargcount, code.co_flags)
        self._say(code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars)
        self._say(code.co_code.hex(), code.co_exceptiontable.hex())
        for x in code.co_consts:
            if isinstance(x, CodeType):
                self._describe_code(x)
            else:
                self.describe(x)

    def _describe_class(self, x: type) -> None:
        self._say("class", x.__module__, x.__qualname__)
        if is_library(x.__module__) or not self._is_new(x):
            return
        self._is_written_in(x.__module__, getattr(sys.modules.get(x.__module__), "__file__", None))
        annotations = getattr(x, "__annotations__", {})
        for field in getattr(x, "_fields", ()):  # compiled code knows a field by its place
            self._say(field)
            self.describe(annotations.get(field))
        for member in x if issubclass(x, enum.Enum) else ():
            self._say(member.name)
            self.describe(member.value)

    def _describe_value(self, x: Any) -> None:
        """Describe a constant by type and value; what the compiler cannot take as one by its type alone."""
        self._say(type(x).__module__, type(x).__qualname__)
        if isinstance(x, np.ndarray):
            self._say(x.dtype.str, x.shape, hashlib.sha256(x.tobytes()).hexdigest())
        elif isinstance(x, set | frozenset):
            self._say(sorted(map(repr, x)))
        elif isinstance(x, tuple | list | dict | UnionType | GenericAlias):
            self._say(len(parts := _parts_of(x)))
            for part in parts:
                self.describe(part)
        elif isinstance(x, int | float | complex | str | np.generic):  # and what is derived from these
            self._say(repr(x))
        else:
            self._say(getattr(x, "__name__", ""))

    def _is_new(self, x: Any) -> bool:
        """Whether something is met for the first time; from then on it is named by its number."""
        known = id(x) in self._met
        number, _ = self._met.setdefault(id(x), (len(self._met), x))
        self._say("#", number)
        return not known

    def _is_written_in(self, module: str, file: str | None) -> None:
        if file is not None:
            self.files[module] = file


def _parts_of(x: Any) -> list[Any]:
    if isinstance(x, dict):
        return [*x.items()]
    return [*(x.__args__ if isinstance(x, UnionType | GenericAlias) else x)]


def _names_in(code: CodeType) -> Iterator[str]:
    """Names of globals and attributes, of functions within, too."""
    yield from code.co_names
    for x in code.co_consts:
        if isinstance(x, CodeType):
            yield from _names_in(x)
