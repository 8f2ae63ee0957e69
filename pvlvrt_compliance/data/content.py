"""What no file of ours holds, whatever its kind: depth without end, control characters, numbers beyond TOML."""

import re
from collections.abc import Iterator
from typing import Any

from pvlvrt_compliance.data.positions import Location
from pvlvrt_compliance.data.syntax import DEEPEST, LARGEST_WHOLE_NUMBER, TOO_LARGE, Table
from pvlvrt_compliance.texts import CONTROL

_CONTROL_IN_A_TEXT = re.compile(rf"(?![\t\n]){CONTROL.pattern}")  # texts have lines, keys have not


def too_deep(table: Table) -> Location | None:
    """Location of something nested deeper than any file of ours is."""
    level: list[tuple[Location, Any]] = [((), table)]
    for _ in range(DEEPEST + 1):
        level = [
            ((*location, key), value)
            for location, content in level
            for key, value in (content.items() if isinstance(content, dict) else enumerate(content))
            if isinstance(value, (dict, list))
        ]
    return level[0][0] if level else None


def unusable(content: Any, location: Location = ()) -> Iterator[tuple[Location, str]]:
    """Where texts and keys have control characters and whole numbers are too large; of such a key, the table."""
    if isinstance(content, str):
        if _CONTROL_IN_A_TEXT.search(content):
            yield location, "a text must not have control characters"
    elif isinstance(content, int):
        if not -LARGEST_WHOLE_NUMBER - 1 <= content <= LARGEST_WHOLE_NUMBER:
            yield location, f"not TOML: {TOO_LARGE}"
    elif isinstance(content, dict):
        for key, value in content.items():
            if CONTROL.search(key):
                yield location, "a key must not have control characters"
            else:
                yield from unusable(value, (*location, key))
    elif isinstance(content, list):
        for index, value in enumerate(content):
            yield from unusable(value, (*location, index))
