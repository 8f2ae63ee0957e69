"""The file of a controller in C: whether this computer can load it, and loading it."""

import ctypes
import hashlib
import os
import platform
import shutil
import struct
import sys
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Any

from pvlvrt_compliance.controllers.debugging import is_debugged
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.faults import RAISED, Faults
from pvlvrt_compliance.controllers.file import content_of
from pvlvrt_compliance.controllers.library.besides import besides_of_library, further_missing

SUFFIXES = (".so", ".dylib", ".dll")
"""Names of shared libraries end so, whatever the system."""

_SYSTEMS = {"linux": "ELF", "darwin": "Mach-O", "win32": "PE"}
_OF_SYSTEM = {"ELF": "Linux", "Mach-O": "macOS", "PE": "Windows"}
_MACHINES = {
    "ELF": {62: "x86-64", 183: "arm64", 3: "x86, 32 bits", 40: "arm, 32 bits", 243: "RISC-V"},
    "PE": {0x8664: "x86-64", 0xAA64: "arm64", 0x014C: "x86, 32 bits"},
    "Mach-O": {0x01000007: "x86-64", 0x0100000C: "arm64", 7: "x86, 32 bits"},
}
_THIS_MACHINE = {"x86_64": "x86-64", "amd64": "x86-64", "aarch64": "arm64", "arm64": "arm64", "riscv64": "RISC-V"}
_SHARED_OBJECT = 3  # e_type of ELF
_UNKNOWN = "its ports are not known, as they are asked for by Model_GetInfo, which cannot be called"


class Library:
    """A shared library in this process, with its own globals: a copy of the file is loaded, not the file.

    Parameters
    ----------
    file : Path
        The library.
    faults : Faults
        Where they are kept, one that needs functions which nothing has is loaded all the same: it can be asked what it
        is, and must not be run.

    Raises
    ------
    DoorError
        When there is no such file, or it cannot be loaded here, with the reason.
    """

    def __init__(self, file: Path, faults: Faults = RAISED) -> None:
        content = content_of(file)
        check_format(file.name, content)
        self.digest = hashlib.sha256(content).hexdigest()
        self._file = file
        self._folder = Path(tempfile.mkdtemp(prefix="pvlvrt-library-"))
        try:
            self._functions = self._load(file, content, faults)
        finally:
            # What is loaded stays loaded, and nothing stays behind if it crashes; a debugger and a sanitiser read the
            # lines of the source from the file.
            if os.name == "posix" and not is_debugged():
                shutil.rmtree(self._folder, ignore_errors=True)

    def function(self, name: str, result: Any = ctypes.c_int32, arguments: tuple[Any, ...] = ()) -> Any:
        """Exported function, or None."""
        function = getattr(self._functions, name, None)
        if function is not None:
            function.restype, function.argtypes = result, arguments
        return function

    def besides(self) -> str:
        """What decides what it does besides its file, in words (`besides_of_library`)."""
        return besides_of_library(content_of(self._file))

    def close(self) -> None:
        """Remove the copy, as far as the system lets go of it; the process ends soon after, or is debugged."""
        if is_debugged():
            return
        shutil.rmtree(self._folder, ignore_errors=True)

    def _load(self, file: Path, content: bytes, faults: Faults) -> ctypes.CDLL:
        copy = self._folder / file.name
        shutil.copyfile(file, copy)
        with suppress(OSError):
            return ctypes.CDLL(str(copy))
        try:
            return ctypes.CDLL(str(file.resolve()))  # it may need libraries that lie beside it
        except OSError as error:
            faults.tell(f"{file} cannot be loaded: {error}{further_missing(content, str(error))}")
        return _loaded_without(copy)


def _loaded_without(file: Path) -> ctypes.CDLL:
    """A library, loaded without the functions that it needs and nothing has, which ends the process where it calls one.

    Raises
    ------
    DoorError
        Where the system does not know of that, or the library does not allow it.
    """
    if sys.platform == "win32":
        raise DoorError(_UNKNOWN)
    open_library = ctypes.CDLL(None).dlopen
    open_library.restype, open_library.argtypes = ctypes.c_void_p, (ctypes.c_char_p, ctypes.c_int)
    handle = open_library(os.fsencode(file), os.RTLD_LAZY)
    if not handle:
        raise DoorError(_UNKNOWN)
    return ctypes.CDLL(str(file), handle=handle)


def check_format(name: str, content: bytes) -> None:
    """Refuse a file that is no shared library of this system and machine.

    Parameters
    ----------
    name : str
        Of the file, for the message.
    content : bytes

    Raises
    ------
    DoorError
        With what it is.
    """
    kind = _kind_of(content)
    here = _SYSTEMS.get(sys.platform, "ELF")
    if kind is None:
        raise DoorError(f"{name} is not a shared library")
    if kind != here:
        hint = "; build the same source here: gcc -shared -fPIC" if here != "PE" else "; build the same source here"
        raise DoorError(f"{name} is a library of {_OF_SYSTEM[kind]}; this is {_OF_SYSTEM[here]}{hint}")
    if kind == "ELF" and content[4] == 2 and struct.unpack_from("<H", content, 16)[0] != _SHARED_OBJECT:
        raise DoorError(f"{name} is not a shared library; link with -shared -fPIC")
    machines, own = _machines_of(kind, content), _THIS_MACHINE.get(platform.machine().lower(), platform.machine())
    if own not in machines:
        raise DoorError(f"{name} is made for {' and '.join(machines)}; this computer is {own}")


def _kind_of(content: bytes) -> str | None:
    if content[:4] == b"\x7fELF" and len(content) >= 64:
        return "ELF"
    if content[:2] == b"MZ" and len(content) >= 64:
        return "PE"
    if content[:4] in (b"\xcf\xfa\xed\xfe", b"\xce\xfa\xed\xfe", b"\xca\xfe\xba\xbe") and len(content) >= 32:
        return "Mach-O"
    return None


def _machines_of(kind: str, content: bytes) -> list[str]:
    names = _MACHINES[kind]
    return [names.get(code, f"machine {code:#x}") for code in _machine_codes(kind, content)]


def _machine_codes(kind: str, content: bytes) -> list[int]:
    try:
        if kind == "ELF":
            return [struct.unpack_from("<H", content, 18)[0]]
        if kind == "PE":
            return [struct.unpack_from("<H", content, struct.unpack_from("<I", content, 60)[0] + 4)[0]]
        if content[:4] == b"\xca\xfe\xba\xbe":
            count = min(struct.unpack_from(">I", content, 4)[0], 8)
            return [struct.unpack_from(">I", content, 8 + 20 * k)[0] for k in range(count)]
        return [struct.unpack_from("<I", content, 4)[0]]
    except struct.error:
        return []
