"""What was made of records, as a file: plain JSON that makes nothing but data when it is read.

Whoever has written it may have written anything: what becomes markup of a report is looked at.
"""

import base64
import json
import re
from collections.abc import Mapping
from types import ModuleType
from typing import Any

import numpy as np

from pvlvrt_compliance.report.drawing import in_page, model
from pvlvrt_compliance.report.drawing.model import BLACK
from pvlvrt_compliance.report.page import section
from pvlvrt_compliance.report.page.received import checked


def _tuples_of(*modules: ModuleType) -> dict[str, type[Any]]:
    return {
        f"{module.__name__.rpartition('.')[2]}.{name}": made
        for module in modules
        for name, made in vars(module).items()
        if isinstance(made, type) and issubclass(made, tuple) and made.__module__ == module.__name__
    }


_TUPLES = _tuples_of(model, in_page, section)
"""The tuples with names that may stand in it, by theirs."""

_COLOURS = ("colour", "words_colour")
_COLOUR = re.compile("#[0-9A-Fa-f]{6}")

_NAMES = {made: name for name, made in _TUPLES.items()}


def pack(made: Mapping[str, Any]) -> bytes:
    """What was made, by the key of the test (`drawing.of_record`), as bytes."""
    return json.dumps({key: _plain(of_test) for key, of_test in made.items()}, separators=(",", ":")).encode()


def unpack(data: bytes) -> dict[str, Any]:
    """The same from these bytes.

    Raises
    ------
    ValueError, KeyError, TypeError
        When they are none.
    """
    found = {key: _made(of_test) for key, of_test in json.loads(data).items()}
    if wrong := [key for key, of_test in found.items() if not isinstance(of_test, Mapping)]:
        raise TypeError(f"{wrong[0]}: is nothing that is made of a record")
    return found


def _plain(item: Any) -> Any:
    if isinstance(item, np.generic):
        return item.item()
    if isinstance(item, list):
        return [_plain(part) for part in item]
    kind, parts = _taken_apart(item)
    return {"of": kind, "is": parts} if kind else item


def _taken_apart(item: Any) -> tuple[str, list[Any]]:
    """What kind of thing it is, and its parts; no kind of what JSON has itself."""
    if isinstance(item, np.ndarray):
        data = base64.b64encode(np.ascontiguousarray(item).tobytes()).decode()
        return "array", [item.dtype.str, list(item.shape), data]
    if isinstance(item, Mapping):
        return "mapping", [[_plain(key), _plain(value)] for key, value in item.items()]
    if isinstance(item, section.Section):
        item = item.without_words()  # whoever reads it says himself what he has found: markup of others is not his
    if isinstance(item, tuple):
        return _NAMES.get(type(item), "tuple"), [_plain(part) for part in item]
    return "", []


def _made(item: Any) -> Any:
    if isinstance(item, list):
        return [_made(part) for part in item]
    if not isinstance(item, dict):
        return item
    kind, parts = item["of"], item["is"]
    if kind == "array":
        dtype, shape, data = parts
        return np.frombuffer(base64.b64decode(data), dtype=np.dtype(dtype)).reshape(shape)
    if kind == "mapping":
        return {_made(key): _made(value) for key, value in parts}
    made = [_made(part) for part in parts]
    return tuple(made) if kind == "tuple" else _looked_at(_TUPLES[kind](*made))


def _looked_at(made: Any) -> Any:
    """A tuple with names, unless it has what would be markup of somebody else's."""
    for name in _COLOURS:
        if not _COLOUR.fullmatch(getattr(made, name, BLACK)):
            raise ValueError(f"{name} is {getattr(made, name)[:40]!r}")
    return checked(made) if isinstance(made, section.Section) else made
