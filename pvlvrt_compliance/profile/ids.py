"""What an id of a profile or of a test is made of: it becomes part of names of files."""

import re

ID_PATTERN = r"^[A-Za-z0-9][A-Za-z0-9._-]*$"


def is_id(text: str) -> bool:
    """Whether a text, all of it, can be an id."""
    return re.fullmatch(ID_PATTERN, text) is not None
