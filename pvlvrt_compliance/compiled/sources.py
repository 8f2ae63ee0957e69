"""The files that decide what a compiled function does, and their digest."""

import hashlib
import importlib.machinery
import importlib.metadata
import importlib.util
import json
import platform
from contextlib import suppress
from functools import cache, cached_property
from pathlib import Path
from types import FunctionType
from typing import Any

import llvmlite  # type: ignore[import-untyped]
import llvmlite.binding  # type: ignore[import-untyped]
import numpy as np

from pvlvrt_compliance.compiled.checked_file import DamagedError, read_checked, write_checked
from pvlvrt_compliance.compiled.contents import Contents, contents_of
from pvlvrt_compliance.compiled.notes import discard
from pvlvrt_compliance.compiled.origins import file_of, origins_of
from pvlvrt_compliance.errors import UsageError

_PURPOSE = "sources"


class Sources:
    """Sources of one function that Python calls; ``maker`` is the module that has it compiled.

    Which files constants come from is noted in a folder, if there is one: to find it takes longer than to see that
    none of the files has changed.
    """

    def __init__(self, function: FunctionType, maker: str, folder: Path | None) -> None:
        self._function = function
        self._maker = maker
        self._folder = folder

    @cached_property
    def contents(self) -> Contents:
        """What the function consists of, in this process."""
        return contents_of(self._function)

    @cached_property
    def texts(self) -> dict[str, str]:
        """Digests of the files (hexadecimal) by module, in alphabetical order; of no text for what is no file."""
        noted = self._noted()
        if noted is not None:
            return noted
        files = {**self._near, **origins_of(self.contents.constants, self.contents.files)}
        texts = {module: _digest_of_file(files[module]) for module in sorted(files)}
        if self._note is not None:
            with suppress(OSError):  # it is found again next time
                write_checked(self._note, _PURPOSE, json.dumps([self.contents.digest, texts]).encode())
        return texts

    @property
    def digest(self) -> str:
        """Digest of the files (16 hexadecimal digits): the same on every machine."""
        return _digest_of(json.dumps(self.texts))

    @property
    def key(self) -> str:
        """Digest of everything that decides the machine code (16 hexadecimal digits).

        Besides the files it goes by what Python has made of them, which may be another text's (see
        `refuse_old_bytecode`) or come from anywhere else, by versions, and by the processor.
        """
        return _digest_of("\0".join([self.digest, self.contents.digest, *_compilers()]))

    def file_of(self, module: str) -> str:
        """File of one of the modules; empty where there is none."""
        return self._near.get(module) or file_of(module) or ""

    def refuse_old_bytecode(self) -> None:
        """Compare what Python runs of each file with its text.

        Raises
        ------
        UsageError
            When Python takes bytecode of another text for that of the file: of the same size, and of the same time.
        """
        for module in self.texts:
            file = self.file_of(module)
            if file.endswith(".py") and _is_old(module, file):
                kept = importlib.util.cache_from_source(file)
                raise UsageError(
                    f"{file}: Python runs {kept}, made of an earlier text of the same size and time; remove it"
                )

    @cached_property
    def _near(self) -> dict[str, str]:
        return {**self.contents.files, self._maker: file_of(self._maker) or ""}

    def _noted(self) -> dict[str, str] | None:
        """Digests as noted, if the function and all the files are what they were then."""
        if self._note is None:
            return None
        try:
            data = read_checked(self._note, _PURPOSE)
        except DamagedError as error:
            discard(self._note, error)
            return None
        except OSError:
            return None
        contents, texts = json.loads(data) if data is not None else ("", {})
        same = contents == self.contents.digest and all(_digest_of_file(self.file_of(x)) == texts[x] for x in texts)
        return texts if same else None

    @property
    def _note(self) -> Path | None:
        code = self._function.__code__
        return self._folder and self._folder / f"sources-{_digest_of(f'{code.co_filename} {code.co_qualname}')}"


def _digest_of_file(file: str) -> str:
    try:
        return hashlib.sha256(Path(file).read_bytes()).hexdigest()
    except OSError:  # in an archive, or typed in: what Python has made of it has to do
        return ""


def _digest_of(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _compilers() -> list[str]:
    """Versions, and the processor: a cache may be carried to another machine."""
    target: Any = llvmlite.binding
    try:
        features = target.get_host_cpu_features().flatten()
    except RuntimeError:  # not known for every kind of processor
        features = ""
    versions = [platform.python_version(), numbas_release(), llvmlite.__version__, np.__version__]
    return [*versions, target.get_process_triple(), target.get_host_cpu_name(), features]


@cache
def numbas_release() -> str:
    """Which numba this is, by its own file: to import all of it takes longer than to load what it has made."""
    spec = importlib.util.find_spec("numba")
    file = Path((spec and spec.origin) or "").with_name("_version.py")
    try:
        return file.read_text("utf-8")
    except OSError:
        return importlib.metadata.version("numba")


def _is_old(module: str, file: str) -> bool:
    try:
        text = Path(file).read_bytes()
        runs = importlib.machinery.SourceFileLoader(module, file).get_code(module)
    except (OSError, ImportError):
        return False
    return runs != compile(text, file, "exec", dont_inherit=True)
