"""Whether what a library does is decided by its file alone: it brings all that it runs, and reads nothing else."""

import ctypes
import re
from collections.abc import Iterable
from contextlib import suppress

from pvlvrt_compliance.controllers.library.imports import Imports, imports_of

_SYSTEM = re.compile(
    r"lib(c|m|pthread|rt|dl|gcc_s|stdc\+\+)\.so\.\d+|ld-(linux[\w-]*|musl[\w-]*)\.so\.\d+"
    r"|(kernel32|ntdll|msvcrt|ucrtbase|vcruntime\d+(_\d+)?|msvcp\d+|api-ms-win-[\w-]+)\.dll",
    re.IGNORECASE,
)
"""Libraries of the system and of the compiler: a stored record goes by the system's version (chosen)."""

_LOADING = re.compile(r"_?_?(dlopen|dlmopen|LoadLibrary(Ex)?[AW]|LoadPackagedLibrary)")
_READING = re.compile(
    r"_?_?(w?f?open(64|_s)?|openat(64)?|freopen(64)?|creat(64)?|CreateFile[AW2]?|shm_open|mq_open|popen|system|fork|vfork"
    r"|exec[lv]p?e?|posix_spawnp?|socket|connect|WSASocket[AW]|CreateProcess[AW]|_?w?getenv(_s)?|secure_getenv)"
)
_CHANGING = re.compile(
    r"_?_?(time(32|64)?|_time(32|64)|clock|clock_gettime(64)?|gettimeofday|ftime(64)?|timespec_get|GetTickCount(64)?"
    r"|GetSystemTime|GetLocalTime|s?rand|rand_r|s?random|[djlmn]rand48|getrandom|getentropy|arc4random\w*|rand_s"
    r"|BCryptGenRandom|getpid)"
)
"""Functions by which a library loads others, reaches files, programs and the environment, or gives something new."""

_MOST_NAMED = 3


def besides_of_library(content: bytes) -> str:
    """What decides what a library does besides its file, in words; empty where nothing does that can be seen.

    Seen are the libraries that it needs and the functions that it imports; not what it might do by the instructions of
    the processor alone.
    """
    found = imports_of(content)
    if found is None:
        return "what it takes from elsewhere cannot be told from its file"
    return _elsewhere(found, ()) or _named("calls", found.functions, (_LOADING, _READING, _CHANGING))


def besides_of_archive(content: bytes, beside: Iterable[str]) -> str:
    """The same of a library in an archive, by whose standard all that it reads is there, too; ``beside`` lies there."""
    found = imports_of(content)
    if found is None:
        return "what it takes from elsewhere cannot be told from its binary"
    return _elsewhere(found, beside) or _named("calls", found.functions, (_LOADING,))


def further_missing(content: bytes, error: str) -> str:
    """Functions that a library needs and nothing has, besides the one at which its loading has ended; in words.

    Empty where it needs libraries other than the system's, which may have them.

    Parameters
    ----------
    content : bytes
        Of its file.
    error : str
        What the system has said.
    """
    found = imports_of(content)
    if "undefined symbol" not in error or found is None or not all(map(_SYSTEM.fullmatch, found.libraries)):
        return ""
    named = set(re.findall(r"\w+", error))
    missing = sorted(name for name in found.from_anywhere - named if not _is_of_the_system(name))
    return f"; likewise missing: {', '.join(missing)}" if missing else ""


def _elsewhere(found: Imports, beside: Iterable[str]) -> str:
    own = set(beside)
    others = [name for name in found.libraries if not _SYSTEM.fullmatch(name) and name not in own]
    if others:
        return f"it needs {_some(others)}"
    # A library that was linked without -lm takes its sine from whatever is there, which is the system's.
    loose = [name for name in found.from_anywhere if not _is_of_the_system(name)]
    return f"it takes {_some(sorted(loose))} from the program that loads it" if loose and not own else ""


def _named(verb: str, functions: Iterable[str], kinds: Iterable[re.Pattern[str]]) -> str:
    found = sorted(name for name in functions if any(kind.fullmatch(name) for kind in kinds))
    return f"it {verb} {_some(found)}" if found else ""


def _some(names: list[str]) -> str:
    more = len(names) - _MOST_NAMED
    return ", ".join(names[:_MOST_NAMED]) + (f" and {more} more" if more > 0 else "")


def _is_of_the_system(function: str) -> bool:
    for name in ("libm.so.6", "libc.so.6"):
        with suppress(OSError, AttributeError):
            getattr(ctypes.CDLL(name), function)
            return True
    return False
