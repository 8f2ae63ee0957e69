"""Validation errors in words: the dotted key, what is wrong and what is allowed."""

import types
import typing
from collections.abc import Iterable, Sequence
from typing import Any

from pydantic import BaseModel, ValidationError

from pvlvrt_compliance.errors import did_you_mean

Location = Sequence[int | str]

_WORDS = {
    "missing": "missing",
    "float_type": "must be a number",
    "float_parsing": "must be a number",
    "finite_number": "must be a finite number",
    "int_type": "must be a whole number",
    "bool_type": "must be true or false",
    "string_type": "must be a text",
    "string_too_short": "must not be empty",
    "tuple_type": "must be a list",
    "model_type": "must be a table",
    "model_attributes_type": "must be a table",
    "dict_type": "must be a table",
}
_SHOW_INPUT = frozenset(_WORDS) - {"missing", "string_too_short"}
_LONGEST_INPUT = 60


def dotted(location: Location) -> str:
    """Spell a location as ``tests[2].sag.depth``."""
    text = ""
    for part in location:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else part
    return text


def problem_lines(error: ValidationError, model: type[BaseModel]) -> list[tuple[Location, str]]:
    """Location and text of every problem that validation against ``model`` found."""
    problems = error.errors(include_url=False)
    return [_at_its_key(problem["loc"], _in_words(problem, model), model) for problem in problems]


def _at_its_key(location: Location, text: str, model: type[BaseModel]) -> tuple[Location, str]:
    """Move the key that a check on a whole table names first (``key: what is wrong``) into the location."""
    key, colon, rest = text.partition(": ")
    if colon and key.split(".")[0] in known_keys(model, location):
        return (*location, *key.split(".")), rest
    return location, text


def _in_words(problem: Any, model: type[BaseModel]) -> str:
    kind, location = problem["type"], problem["loc"]
    if kind == "extra_forbidden":
        return _unknown_key(str(location[-1]), known_keys(model, location[:-1]))
    if kind == "value_error":
        return str(problem["ctx"]["error"])
    words = _WORDS.get(kind) or problem["msg"].removeprefix("Input ").replace("should", "must", 1)
    return f"{words}, not {_shown(problem['input'])}" if kind not in _WORDS or kind in _SHOW_INPUT else words


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= _LONGEST_INPUT else f"{text[:_LONGEST_INPUT]}..."


def _unknown_key(key: str, known: Iterable[str]) -> str:
    known = list(known)
    return f"unknown key{did_you_mean(key, known) or '; allowed: ' + ', '.join(known)}"


def known_keys(model: type[BaseModel], location: Location) -> list[str]:
    """Keys that a table at a location may have."""
    found: Any = model
    for part in location:
        found = _member(found, part)
    fields = found.model_fields if _is_model(found) else {}
    return [field.alias or name for name, field in fields.items()]


def _member(annotation: Any, part: int | str) -> Any:
    """Type of one member of a model, a tuple or a mapping."""
    if _is_model(annotation):
        by_key = {field.alias or name: field.annotation for name, field in annotation.model_fields.items()}
        return _without_none(by_key.get(str(part)))
    arguments = typing.get_args(annotation)
    if typing.get_origin(annotation) is dict:
        return _without_none(arguments[1])
    return _without_none(arguments[0]) if arguments else None


def _without_none(annotation: Any) -> Any:
    if typing.get_origin(annotation) is typing.Annotated:
        return _without_none(typing.get_args(annotation)[0])
    if typing.get_origin(annotation) in (typing.Union, types.UnionType):
        return _without_none(next(a for a in typing.get_args(annotation) if a is not type(None)))
    return annotation


def _is_model(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)
