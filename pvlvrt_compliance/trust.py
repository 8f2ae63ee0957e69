"""Whom a file or a folder belongs to: what somebody else may have written is not used unasked."""

import os
import stat
from pathlib import Path


def distrust(path: Path) -> str:
    """Why a file or folder may be of somebody whom the user does not trust; empty where nothing speaks against it.

    root could change what the command itself does, and is trusted. Windows has neither owners nor modes of this kind.
    """
    user = getattr(os, "getuid", None)
    if user is None:
        return ""
    try:
        owners = {path.lstat().st_uid, path.stat().st_uid}
        mode = path.stat().st_mode
    except OSError as error:
        return f"it cannot be looked at ({error.strerror})"
    if owners - {user(), 0}:
        return "it belongs to somebody else"
    return "anybody may write it" if mode & stat.S_IWOTH else ""
