"""Files that are not trusted: a head with a digest, which is compared before anything of the content is looked at.

That finds damage, not malice: who may write in the folder may write a file with a right digest, too.
"""

import hashlib
import stat
from contextlib import suppress
from pathlib import Path

_MAGIC = b"pvlvrt-check compiled 1\n"
_DIGEST_BYTES = hashlib.sha256().digest_size


class DamagedError(Exception):
    """A file does not hold what was written."""


def read_checked(file: Path, purpose: str) -> bytes | None:
    """Content of a file, none where there is no file.

    Raises
    ------
    DamagedError
        When it is not what `write_checked` has written for this purpose.
    OSError
        When it cannot be read.
    """
    try:
        kind = file.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        if file.is_symlink():
            raise DamagedError("not a file") from None
        return None
    if not stat.S_ISREG(kind):
        raise DamagedError("not a file")
    head, content = _parted(file.read_bytes())
    if not head:
        raise DamagedError("empty" if not content else "not a file of compiled code")
    if head != _head(purpose, content):
        raise DamagedError("its content is not what was written")
    return content


def _parted(data: bytes) -> tuple[bytes, bytes]:
    if not data.startswith(_MAGIC):
        return b"", data
    end = len(_MAGIC) + _DIGEST_BYTES
    return data[:end], data[end:]


def _head(purpose: str, content: bytes) -> bytes:
    # The purpose is part of it: a file under another's name is none of this name's.
    return _MAGIC + hashlib.sha256(purpose.encode() + b"\0" + content).digest()


def write_checked(file: Path, purpose: str, content: bytes) -> None:
    """Write a file so that others see all of it or nothing.

    Raises
    ------
    OSError
        When it cannot be written; nothing of it is left then.
    """
    import uuid  # reading needs neither this nor shutil

    file.parent.mkdir(parents=True, exist_ok=True)
    unfinished = file.with_name(f".{uuid.uuid4().hex}.part")
    try:
        unfinished.write_bytes(_head(purpose, content) + content)
        unfinished.replace(file)
    except BaseException:
        with suppress(OSError):
            unfinished.unlink()
        raise


def throw_away(file: Path) -> None:
    """Remove whatever stands in a file's place, as far as that is allowed."""
    import shutil

    with suppress(OSError):
        if file.is_dir() and not file.is_symlink():
            shutil.rmtree(file)
        else:
            file.unlink()
