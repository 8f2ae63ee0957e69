"""Validation errors in words: the dotted key, what is wrong and what is allowed."""

import types
import typing
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pydantic import BaseModel, ValidationError

from pvlvrt_compliance.errors import did_you_mean
from pvlvrt_compliance.texts import one_line, shortened

Location = Sequence[int | str]

_WORDS = {
    "missing": "missing",
    "float_type": "must be a number",
    "float_parsing": "must be a number",
    "finite_number": "must be a finite number",
    "int_type": "must be a whole number",
    "int_from_float": "must be a whole number",
    "int_parsing": "must be a whole number",
    "int_parsing_size": "must be a whole number of a usual size",
    "bool_type": "must be true or false",
    "bool_parsing": "must be true or false",
    "date_type": "must be a date",
    "date_parsing": "must be a date",
    "date_from_datetime_parsing": "must be a date",
    "json_invalid": "not JSON",
    "string_type": "must be a text",
    "string_too_short": "must not be empty",
    "tuple_type": "must be a list",
    "model_type": "must be a table",
    "model_attributes_type": "must be a table",
    "dict_type": "must be a table",
}
_SHOW_INPUT = frozenset(_WORDS) - {"missing", "string_too_short", "json_invalid"}
_OF_PYDANTIC = ("Input ", "String ")
_LONGEST_INPUT = 60
_LONGEST_KEY = 200

A_NUMBER, A_LIST, A_TABLE = "a number", "a list", "a table"
FORMS = frozenset({A_NUMBER, A_LIST, A_TABLE})
"""Names of the forms of a value that is one or the other; blanks keep them apart from keys."""

_UNITS = {
    "s": "seconds",
    "pu": "per unit",
    "hz": "hertz",
    "hz_s": "hertz per second",
    "deg": "degrees",
    "percent": "percent",
    "fraction": "a fraction, 0 to 1",
    "w_m2": "watts per square metre",
}
_OTHER_UNITS = frozenset(
    {"ms", "us", "min", "h", "cycles", "periods", "v", "kv", "a", "ka", "w", "kw", "mhz", "rad", "hz_ms", "rad_s"}
) | frozenset(_UNITS)


def dotted(location: Location) -> str:
    """Spell a location as ``tests[2].sag.depth``."""
    text = ""
    for part in location:
        key = part if isinstance(part, int) else one_line(part, _LONGEST_KEY)
        text += f"[{key}]" if isinstance(part, int) else f".{key}" if text else str(key)
    return text


def problem_lines(
    error: ValidationError, model: type[BaseModel], data: Any = None
) -> list[tuple[tuple[int | str, ...], str]]:
    """Location and text of every problem that validation of ``data`` against ``model`` found."""
    found = []
    for problem in error.errors(include_url=False):
        if not _is_echo(problem):
            location, text = _at_its_key(problem["loc"], _in_words(problem, model), model)
            found.append((_as_written(location, data), text))
    return found


def _is_echo(problem: Any) -> bool:
    """Whether a list is only called too short because its elements have problems of their own."""
    return problem["type"] == "too_short" and bool(len(problem["input"]) >= problem["ctx"]["min_length"])


def _as_written(location: Location, data: Any) -> tuple[int | str, ...]:
    """A location without the names that pydantic puts between a key and one of several forms of its value."""
    written: list[int | str] = []
    at_form = False
    for part in location:
        is_form = part in FORMS or (isinstance(data, dict) and data.get("kind") == part)
        at_form = is_form and not at_form
        if not at_form:
            written.append(part)
            data = _content(data, part)
    return tuple(written)


def _content(data: Any, part: int | str) -> Any:
    if isinstance(data, dict):
        return data.get(part)
    return data[part] if isinstance(data, list) and isinstance(part, int) and part < len(data) else None


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
    if kind in {"union_tag_invalid", "union_tag_not_found"}:
        return _unknown_kind(**problem["ctx"], known=known_kinds(model, location))
    if kind in {"too_short", "too_long"} and "actual_length" in problem["ctx"]:
        return _length(**problem["ctx"])
    words = _WORDS.get(kind) or _own_words(problem["msg"])
    return f"{words}, not {_shown(problem['input'])}" if kind not in _WORDS or kind in _SHOW_INPUT else words


def _own_words(message: str) -> str:
    """What pydantic says, as the rest is said."""
    for subject in _OF_PYDANTIC:
        message = message.removeprefix(subject)
    return message.replace("should", "must", 1)


def _length(actual_length: int | None, min_length: int = 0, max_length: int | None = None, **_: Any) -> str:
    bound = f"at least {min_length}" if max_length is None else f"at most {max_length}"
    return f"must have {bound} elements, not {actual_length}"


def _shown(value: Any) -> str:
    return shortened(repr(value), _LONGEST_INPUT)


def _unknown_key(key: str, known: Iterable[str]) -> str:
    known = list(known)
    expected = next((name for name in known if _differs_in_unit(key, name)), None)
    if expected is not None:
        return f'unknown key; did you mean "{expected}"? It is in {_UNITS[_unit_of(expected)]}'
    return f"unknown key{did_you_mean(key, known) or '; allowed: ' + ', '.join(known)}"


def _unknown_kind(discriminator: str, known: Sequence[str], tag: str | None = None, **_: Any) -> str:
    """What is wrong with the key that says which of several forms a table has."""
    key = discriminator.strip("'")
    allowed = f"allowed: {', '.join(known)}"
    if tag is None:
        return f"{key} is missing; {allowed}"
    return f"{key} {_shown(tag)} is unknown{did_you_mean(tag, known)}; {allowed}".replace("?; a", "? A")


def _differs_in_unit(key: str, known: str) -> bool:
    """Whether a key is a known one with another unit, or with none."""
    unit = _unit_of(known)
    stem = known.removesuffix(unit).removesuffix("_")
    return bool(unit and stem) and (
        key == stem or (key.startswith(f"{stem}_") and key[len(stem) + 1 :] in _OTHER_UNITS)
    )


def _unit_of(key: str) -> str:
    """Unit that a key ends with; the longest, as hz_s also ends with s."""
    return max((unit for unit in _UNITS if key == unit or key.endswith(f"_{unit}")), key=len, default="")


def known_keys(model: type[BaseModel], location: Location) -> list[str]:
    """Keys that a table at a location may have."""
    found = _annotation_at(model, location)
    fields = found.model_fields if _is_model(found) else {}
    return [field.alias or name for name, field in fields.items()]


def known_kinds(model: type[BaseModel], location: Location) -> list[str]:
    """Kinds that a table at a location may have, where its ``kind`` says which form it has."""
    return [form.model_fields["kind"].default for form in typing.get_args(_annotation_at(model, location))]


def _annotation_at(model: type[BaseModel], location: Location) -> Any:
    found: Any = model
    for part in location:
        found = _member(found, part)
    return found


def _member(annotation: Any, part: int | str) -> Any:
    """Type of one member of a model, a tuple or a mapping."""
    if _is_model(annotation):
        by_key = {field.alias or name: field.annotation for name, field in annotation.model_fields.items()}
        return _without_none(by_key.get(str(part)))
    arguments = typing.get_args(annotation)
    if part in FORMS or typing.get_origin(annotation) in (typing.Union, types.UnionType):
        return _form(arguments, str(part))
    if typing.get_origin(annotation) in (dict, Mapping):
        return _without_none(arguments[1])
    return _without_none(arguments[0]) if arguments else None


def _form(forms: Iterable[Any], name: str) -> Any:
    """The form of a value that pydantic calls by a name: that of the model whose ``kind`` it is, or of a table."""
    models = [form for form in map(_without_none, forms) if _is_model(form)]
    by_kind = (form for form in models if "kind" in form.model_fields and form.model_fields["kind"].default == name)
    return next(by_kind, models[0] if models and name == A_TABLE else None)


def _without_none(annotation: Any) -> Any:
    """What an annotation holds besides its metadata and None."""
    if typing.get_origin(annotation) is typing.Annotated:
        return _without_none(typing.get_args(annotation)[0])
    if typing.get_origin(annotation) in (typing.Union, types.UnionType):
        others = [a for a in typing.get_args(annotation) if a is not type(None)]
        return _without_none(others[0]) if len(others) == 1 else annotation
    return annotation


def _is_model(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)
