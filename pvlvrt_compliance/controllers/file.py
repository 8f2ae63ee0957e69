"""The file that a controller is: whether it is there, and what is in it."""

from pathlib import Path

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.texts import shortened

_SHOWN = 200  # characters of a name


def check_there(file: Path) -> None:
    """Refuse what is no file.

    Raises
    ------
    DoorError
        With the reason, where it is not simply absent.
    """
    try:
        found = file.is_file()
    except OSError as error:  # a name that is too long, a folder that may not be looked into
        raise DoorError(f"there is no file {_shown(file)}: {error.strerror or error}") from None
    if not found:
        raise DoorError(f"there is no file {_shown(file)}")


def content_of(file: Path) -> bytes:
    """All of a file.

    Raises
    ------
    DoorError
        When there is none, or it cannot be read.
    """
    check_there(file)
    try:
        return file.read_bytes()
    except OSError as error:
        raise DoorError(f"{_shown(file)} cannot be read: {error.strerror or error}") from None


def _shown(file: Path) -> str:
    return shortened(str(file), _SHOWN)
