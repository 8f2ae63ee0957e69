"""Finds the folders that ship with the package, installed or in a checkout."""

from pathlib import Path

from pvlvrt_compliance.errors import PvlvrtError


def resource_folder(name: str) -> Path:
    """Return the folder ``profiles`` or ``reports``.

    A wheel carries both inside the package; an editable install has them beside it.

    Raises
    ------
    PvlvrtError
        When neither place has the folder: the installation is damaged.
    """
    package = Path(__file__).resolve().parent
    for place in (package / name, package.parent / name):
        if place.is_dir():
            return place
    raise PvlvrtError(f"the folder {name!r} is missing from the installation; install pvlvrt-compliance again")
