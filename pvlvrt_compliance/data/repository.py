"""Where a repository begins: one answer for the search for settings, and for where files lie in a report."""

import os
from pathlib import Path


def begins_repository(folder: Path) -> bool:
    """Whether a folder is the root of a repository: it has a ``.git``, in a work tree or a submodule a file."""
    return os.path.lexists(folder / ".git")
