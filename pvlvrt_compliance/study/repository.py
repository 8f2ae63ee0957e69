"""Where the files that a run was made of lie in the repository that it was made in."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pvlvrt_compliance.data.repository import begins_repository


def repository_of(folder: Path) -> Path | None:
    """Root of the repository that a folder lies in, by the nearest ``.git`` upwards; None where there is none."""
    absolute = folder.resolve()
    return next((place for place in (absolute, *absolute.parents) if begins_repository(place)), None)


def places_in_repository(named: Mapping[str, str]) -> dict[str, str]:
    """Where the files that are named lie, from the root of the repository of the working folder, with ``/``.

    Parameters
    ----------
    named : mapping
        Names as the user has given them, by what they name. Of ``FILE.py:CLASS`` the file counts; what is no file, or
        lies elsewhere, is left out.
    """
    root = repository_of(Path.cwd())
    if root is None:
        return {}
    files = {of: file for of, name in named.items() if (file := _file_of(name)) is not None}
    return {of: file.relative_to(root).as_posix() for of, file in files.items() if file.is_relative_to(root)}


def files_of(controller: object, profiles: Mapping[str, str]) -> dict[str, Any]:
    """Where the files are that a user has named: whoever reads a verdict in the repository looks into them.

    Parameters
    ----------
    controller : object
        Its specification, where it is one.
    profiles : mapping
        Files of profiles by their id.
    """
    of_controller = places_in_repository({"controller": controller} if isinstance(controller, str) else {})
    of_profiles = places_in_repository(profiles)
    return {**of_controller, **({"profiles": of_profiles} if of_profiles else {})}


def _file_of(name: str) -> Path | None:
    for candidate in (name, name.rpartition(":")[0]):
        try:
            if candidate and Path(candidate).is_file():
                return Path(candidate).resolve()
        except (OSError, ValueError):  # too long for a name of a file, or with a null character
            continue
    return None
