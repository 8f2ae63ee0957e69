"""What a profile of one's own begins with: a commented file that is a valid profile, and what of it is still there."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from pvlvrt_compliance.data.merging import merge_file
from pvlvrt_compliance.data.positions import Location
from pvlvrt_compliance.data.search_path import SUFFIX
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile.ids import is_id
from pvlvrt_compliance.profile.loading import profile_path
from pvlvrt_compliance.profile.profile import SCHEMA_VERSION
from pvlvrt_compliance.resources import resource_folder

_TEMPLATE = "new-profile.toml"
_ID_OF_TEMPLATE = "my-code"

PLACEHOLDER = "placeholder"
"""A text of a profile that begins so is still to be replaced, and with it what it stands beside."""

_OF_A_MARK = ("clause", "source")
_MARKED = ("value", "values", "points")  # what such a source is of, and is to be replaced with it


class Beginning(NamedTuple):
    """A profile to go on from: its text, and the file for it, none where no name was given."""

    text: str
    file: Path | None


def begin_profile(name: str = "") -> Beginning:
    """Begin a profile.

    Parameters
    ----------
    name : str
        Id of the profile, or a path of its file, with or without ``.toml``; without, the id is the template's.

    Raises
    ------
    UsageError
        When the name gives no id.
    """
    text = (resource_folder("reports") / _TEMPLATE).read_text("utf-8")
    if not name:
        return Beginning(text, None)
    identity = Path(name).name.removesuffix(SUFFIX)
    if not is_id(identity):
        raise UsageError(f"{name!r}: an id has letters, digits, dots, dashes and underscores")
    return Beginning(text.replace(_ID_OF_TEMPLATE, identity), Path(name).with_name(f"{identity}{SUFFIX}"))


def placeholders(name_or_path: str) -> tuple[str, ...]:
    """What a profile, or one that it includes, still has of its beginning: file, line, key, and what of it.

    Parameters
    ----------
    name_or_path : str
        Of a valid profile, as of `load_profile`.
    """
    merged = merge_file(profile_path(name_or_path), SCHEMA_VERSION)
    return tuple(merged.describe(place, text) for place, text in _placeholders_in(merged.table))


def _placeholders_in(content: Any, place: Location = ()) -> Iterator[tuple[Location, str]]:
    """Location of each, with a number or a table that has no clause or source as one."""
    if _is_one(content):
        yield place, PLACEHOLDER
    elif isinstance(content, dict):
        if left := [key for key in _OF_A_MARK if _is_one(content.get(key))]:
            yield place, f"{PLACEHOLDER} ({', '.join([*(key for key in _MARKED if key in content), *left])})"
        for key, part in content.items():
            if key not in _OF_A_MARK:
                yield from _placeholders_in(part, (*place, key))
    elif isinstance(content, list):
        for index, part in enumerate(content):
            yield from _placeholders_in(part, (*place, index))


def _is_one(content: Any) -> bool:
    return isinstance(content, str) and content.casefold().startswith(PLACEHOLDER)
