"""The numbers of a requirement as text, each with its unit."""

from collections.abc import Iterator
from typing import Any, NamedTuple

from pydantic import BaseModel

from pvlvrt_compliance.data.marks import Choice, Flag, Marked, Number, Numbers, marks_in
from pvlvrt_compliance.profile.regions import LinearTime

_UNITS = (
    ("_s_per_pu", "s/pu"),
    ("_hz_s", "Hz/s"),
    ("_percent", "%"),
    ("_cycles", "cycles"),
    ("_hz", "Hz"),
    ("_pu", "pu"),
    ("_deg", "deg"),
    ("_s", "s"),
)


class Told(NamedTuple):
    """A number as a page tells it."""

    key: str
    value: str
    confidence: str
    source: str


def unit_of(key: str) -> str:
    """Unit that the ending of a key says."""
    name = key.rpartition(".")[2]
    return next((unit for ending, unit in _UNITS if name.endswith(ending)), "")


def told(requirement: BaseModel) -> Iterator[Told]:
    """Every marked item of a requirement but the rows of its tables, which are told with the table."""
    for key, item in marks_in(requirement):
        if "[" not in key and "rows" not in key.split("."):
            yield Told(key, value_of(key, item), item.confidence, item.source)


def value_of(key: str, item: Any) -> str:
    """A number with its unit; of a curve its points, of a table how many rows it has."""
    unit = unit_of(key)
    match item:
        case Number() | Choice():
            return f"{_plain(item.value)} {unit}".rstrip()
        case Flag():
            return "yes" if item.value else "no"
        case Numbers():
            return f"{', '.join(map(_plain, item.values))} {unit}".rstrip()
        case Marked() if hasattr(item, "points"):
            return ", ".join(_point(point) for point in item.points)
        case Marked() if hasattr(item, "rows"):
            return "; ".join(map(_row, item.rows))
    return ""


def _row(row: BaseModel) -> str:
    """A row of a table: each key that it has, with its value and unit."""
    content = row.model_dump(exclude_none=True, exclude={"confidence", "source"})
    told = []
    for key, value in content.items():
        whole = getattr(row, key)
        text = whole.in_words() if isinstance(whole, LinearTime) else f"{_content(value)} {unit_of(key)}".rstrip()
        told.append(f"{_words(key)} {text}")
    return ", ".join(told)


def _words(key: str) -> str:
    ending = next((ending for ending, _ in _UNITS if key.endswith(ending)), "")
    return key.removesuffix(ending).replace("_", " ")


def _content(value: Any) -> str:
    if isinstance(value, dict):
        return (
            "("
            + ", ".join(f"{_words(key)} {_content(part)} {unit_of(key)}".rstrip() for key, part in value.items())
            + ")"
        )
    if isinstance(value, (tuple, list)):
        return " to ".join(map(_plain, value)) if len(value) == 2 else ", ".join(map(_plain, value))
    return _plain(value).replace("_", " ")


def _point(point: Any) -> str:
    x, y = (point.t_s, point.u_pu) if hasattr(point, "t_s") else point
    return f"({x:g}, {y:g})"


def _plain(value: Any) -> str:
    return f"{value:g}" if isinstance(value, (int, float)) else str(value)
