"""Tables of files that were read before: Python reads two kilobytes of TOML in a millisecond.

A table goes by the text of its file and by what has read it. It is kept as JSON, with the dates, which JSON lacks,
apart from it.
"""

import json
from collections.abc import Iterator
from datetime import date, datetime, time
from typing import Any

from pvlvrt_compliance.cache import keep, look_up, named, sources
from pvlvrt_compliance.data.positions import Location
from pvlvrt_compliance.data.syntax import Table

_SHORT = 2000
"""Characters that take less time to read than a file to find."""

_CLASSES: dict[str, type[Any]] = {kind.__name__: kind for kind in (datetime, date, time)}


def table_kept(text: str) -> Table | None:
    """The table of a text that `keep_table` was given before; None where there is none."""
    found = look_up(_name_of(text)) if len(text) > _SHORT else None
    return _unpacked(found) if found is not None else None


def keep_table(text: str, table: Table) -> None:
    """Keep the table of a text: of a whole file, in which nothing is wrong."""
    if len(text) > _SHORT:
        keep(_name_of(text), _packed(table))


def _name_of(text: str) -> str:
    return named("table", text, sources("data"))


def _packed(table: Table) -> bytes:
    dates = [(location, type(value).__name__, value.isoformat()) for location, value in _dates_in(table, ())]
    return json.dumps([table, dates], default=str, separators=(",", ":")).encode()


def _unpacked(content: bytes) -> Table:
    table: Table
    table, dates = json.loads(content)
    for (*path, last), kind, spelled in dates:
        place: Any = table
        for part in path:
            place = place[part]
        place[last] = _CLASSES[kind].fromisoformat(spelled)
    return table


def _dates_in(content: Any, location: Location) -> Iterator[tuple[Location, date | time]]:
    if isinstance(content, date | time):
        yield location, content
    elif isinstance(content, dict | list):
        for key, value in content.items() if isinstance(content, dict) else enumerate(content):
            yield from _dates_in(value, (*location, key))
