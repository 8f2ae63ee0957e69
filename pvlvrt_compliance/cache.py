"""The user's folder for what is made anew when it is lost, and what lies there beside compiled code.

What is kept goes by a digest of everything that it is made from, and its file is trusted no further than compiled code
is (`compiled.checked_file`). Without a folder, or where it cannot be written, everything is made each time.
"""

import hashlib
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path

from pvlvrt_compliance.compiled.checked_file import DamagedError, read_checked, write_checked
from pvlvrt_compliance.compiled.notes import discard

_MOST_OF_A_KIND = 100


def cache_root() -> Path | None:
    """Folder of all that is kept; ``NUMBA_CACHE_DIR`` moves it. None without either that or a home."""
    given = os.environ.get("NUMBA_CACHE_DIR")
    try:
        root = Path(given or _of_the_user())
    except RuntimeError:  # no HOME, and a user that the system does not know
        return None
    return root.absolute() if given or root.is_absolute() else None


def _of_the_user() -> str:
    import platformdirs

    return platformdirs.user_cache_dir("pvlvrt-compliance", appauthor=False)


def named(what: str, *made_from: str | bytes) -> str:
    """Name of a file by what is in it, and by everything that decides the content."""
    parts = [part.encode("utf-8", "surrogateescape") if isinstance(part, str) else part for part in made_from]
    digests = b"".join(hashlib.sha256(part).digest() for part in parts)
    return f"{what}-{hashlib.sha256(digests).hexdigest()[:16]}"


@cache
def sources(*places: str) -> str:
    """Digest of the sources of some folders and modules of this package, and of Python's version."""
    package = Path(__file__).parent
    files = [file for place in places for file in sorted((package / place).rglob("*.py")) or [package / place]]
    return named(sys.version, *(part for file in files for part in (str(file.relative_to(package)), file.read_bytes())))


def look_up(name: str) -> bytes | None:
    """What is kept under a name; None where there is nothing, or what is there is damaged, which is said."""
    root = cache_root()
    if root is None:
        return None
    file = root / name
    try:
        return read_checked(file, name)
    except DamagedError as error:
        discard(file, error)
    except OSError:  # made anew, as if there were nothing
        pass
    return None


def keep(name: str, content: bytes) -> None:
    """Keep something for later processes, if that is possible; of each kind the latest hundred."""
    root = cache_root()
    if root is not None:
        with suppress(OSError):  # it is made again next time
            write_checked(root / name, name, content)
            _make_room(root, name.rpartition("-")[0])


def _make_room(root: Path, what: str) -> None:
    """Remove the oldest files of a kind, beyond so many: each edit of what they are made from leaves one."""
    oldest_first = sorted(root.glob(f"{what}-*"), key=lambda file: file.stat().st_mtime)
    for file in oldest_first[:-_MOST_OF_A_KIND]:
        file.unlink()


def kept(name: str, make: Callable[[], bytes]) -> bytes:
    """What ``make`` gives, made once for all processes that ask for the name."""
    found = look_up(name)
    if found is None:
        found = make()
        keep(name, found)
    return found
