"""A file that one process holds: by `fcntl`, on Windows by `msvcrt`, which no other module knows of."""

import errno
import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.EINVAL, errno.EBADF)
_TRIES = 100
_FAR_BYTE = 1 << 30  # where Windows locks the file, so that what stands in it can be read


class Lock(NamedTuple):
    """A file that this process holds for as long as it lives, or until it is released."""

    path: Path
    descriptor: int
    is_certain: bool  # False where the file system has no locks: another process may believe it holds it, too

    def release(self) -> None:
        """Remove the file and let go of it."""
        if os.name != "nt":  # there a file that is open cannot be removed
            with suppress(OSError):
                self.path.unlink()
        self.close()
        if os.name == "nt":
            with suppress(OSError):  # somebody else has it by now
                self.path.unlink()

    def close(self) -> None:
        """Let go of the file and leave it where it is."""
        os.close(self.descriptor)


def take_lock(path: Path) -> Lock | None:
    """Make a file and hold it; None while another process, or another part of this one, does.

    A process that ends in any way lets go of it, so that a file nobody holds is one of a process that is gone.

    Raises
    ------
    OSError
        When the file cannot be made or written.
    """
    for _ in range(_TRIES):
        descriptor = _open_lock(path)
        try:
            held = _hold(descriptor)
            if held is False:
                os.close(descriptor)
                return None
            if _is_at(descriptor, path):
                return _signed(Lock(path, descriptor, held is True))
        except OSError:
            os.close(descriptor)
            raise
        os.close(descriptor)  # whoever held it has removed it meanwhile
    raise OSError(errno.EAGAIN, os.strerror(errno.EAGAIN), str(path))


def holder_of(path: Path) -> str:
    """The process that has signed a lock, as far as it can be read."""
    try:
        return path.read_text("ascii", "replace").strip()
    except OSError:
        return ""


def _open_lock(path: Path) -> int:
    follow_no_link = getattr(os, "O_NOFOLLOW", 0)
    try:
        return os.open(path, os.O_RDWR | os.O_CREAT | follow_no_link, 0o666)
    except PermissionError:
        if not path.is_file():
            raise
        return os.open(path, os.O_RDONLY | follow_no_link)  # another user's, which can be held all the same


def _hold(descriptor: int) -> bool | None:
    """Whether the file is held now; None where the file system cannot tell."""
    try:
        if sys.platform == "win32":
            import msvcrt

            os.lseek(descriptor, _FAR_BYTE, os.SEEK_SET)
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
            os.lseek(descriptor, 0, os.SEEK_SET)
        else:
            import fcntl

            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        return False
    except OSError as error:
        if error.errno in _NO_LOCKS:
            return None
        raise
    return True


def _is_at(descriptor: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(descriptor), path.stat(follow_symlinks=False))
    except FileNotFoundError:
        return False


def _signed(lock: Lock) -> Lock:
    try:
        os.ftruncate(lock.descriptor, 0)
        os.write(lock.descriptor, f"{os.getpid()}\n".encode())
    except OSError as error:
        if error.errno not in (errno.EBADF, errno.EINVAL):  # opened for reading alone
            lock.path.unlink()
            raise
    return lock


def is_mine(path: Path) -> bool:
    """Whether a file or folder, not what a link leads to, is of this user; where files have no users, always."""
    owner = getattr(os, "geteuid", None)
    return owner is None or path.stat(follow_symlinks=False).st_uid == owner()
