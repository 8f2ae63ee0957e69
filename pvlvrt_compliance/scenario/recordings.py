"""Where a recording lies: a file of others may name one, and no file that is not meant for it."""

from dataclasses import dataclass, field, replace
from pathlib import Path

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.ordinary_file import is_within


@dataclass(frozen=True)
class Named:
    """By which file a recording is named. Two are the same where they are looked for in the same folders."""

    folders: tuple[Path, ...]  # in this order; what is found lies in or below the one that it is found in
    place: str = field(default="", compare=False)  # file, line and key, for messages

    def also_in(self, folder: Path) -> "Named":
        """The same, looked for in a folder of recordings, too."""
        return replace(self, folders=(*self.folders, folder))

    def find(self, file: str) -> tuple[Path, Path]:
        """A recording, and the folder that it lies in or below; the last that may have it where it is in none.

        Raises
        ------
        UsageError
            When it leads out of all of them, whether or not there is a file.
        """
        allowed = [(folder / file, folder) for folder in self.folders if is_within(folder / file, folder)]
        if not allowed:
            given = " or in the folder of recordings" if len(self.folders) > 1 else ""
            said = f"a recording lies in the folder of the file that names it or below{given}"
            raise UsageError(f"{file}: {said}; --recordings FOLDER (recordings) names another")
        return next((found for found in allowed if _is_there(found[0])), allowed[-1])


def _is_there(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):
        return False
