"""What a profile of one's own begins with: a commented file that is a valid profile."""

from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.data.search_path import SUFFIX
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile.ids import is_id
from pvlvrt_compliance.resources import resource_folder

_TEMPLATE = "new-profile.toml"
_ID_OF_TEMPLATE = "my-code"


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
