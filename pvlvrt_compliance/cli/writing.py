"""Files that a command writes besides those of a run: all of them, or none."""

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from pvlvrt_compliance.errors import UsageError, unwritable


def write_new(files: Mapping[Path, bytes], *, with_folders: bool = False) -> None:
    """Write files that are not there yet; if wanted, make the folders that they stand in.

    Raises
    ------
    UsageError, OutputError
        When one is there or cannot be written; nothing of them is left then.
    """
    made: list[Path] = []
    try:
        for file, content in files.items():
            if with_folders:
                _make_folder(file.parent, made)
            with file.open("xb") as opened:
                made.append(file)
                opened.write(content)
    except FileExistsError as error:
        _take_away(made)
        raise UsageError(f"{error.filename} is there already and is left as it is") from None
    except OSError as error:
        _take_away(made)
        raise unwritable(f"{error.filename or file} cannot be written ({error.strerror})", error) from None
    except BaseException:
        _take_away(made)
        raise


def write_over(file: Path, content: bytes) -> None:
    """Write a file, in place of one that may be there.

    Raises
    ------
    OSError
        When it cannot be written; what was there is there still.
    """
    unfinished = file.with_name(f".{file.name}.part")
    try:
        unfinished.write_bytes(content)
        unfinished.replace(file)
    except BaseException:
        with suppress(OSError):
            unfinished.unlink()
        raise


def _make_folder(folder: Path, made: list[Path]) -> None:
    for place in [*reversed(folder.parents), folder]:
        if not place.exists():
            place.mkdir()
            made.append(place)


def _take_away(made: list[Path]) -> None:
    for place in reversed(made):
        with suppress(OSError):
            if place.is_dir():
                place.rmdir()
            else:
                place.unlink()
