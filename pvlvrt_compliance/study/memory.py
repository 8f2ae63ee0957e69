"""Freed memory stays with the process, for the next array of its size.

A record is measured with hundreds of arrays of a megabyte or so. The C library of Linux gives each back when it is
freed and fetches it anew, page by page, which takes a quarter of the time that judging takes.
"""

import ctypes
import sys
from functools import cache

_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3  # of mallopt, in malloc.h of glibc

_KEPT = 256 << 20
"""Bytes that are free at the end of the heap before any are given back."""

_MAPPED = 32 << 20
"""Bytes from which on an array is no part of the heap, and is given back at once."""


@cache
def keep_freed_memory() -> bool:
    """Have freed memory kept from now on, in this process; return whether its C library can do so."""
    if sys.platform != "linux":
        return False
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (AttributeError, OSError):  # not every C library has it
        return False
    mallopt.argtypes, mallopt.restype = (ctypes.c_int, ctypes.c_int), ctypes.c_int
    return bool(mallopt(_MMAP_THRESHOLD, _MAPPED) and mallopt(_TRIM_THRESHOLD, _KEPT))
