"""A profile in words: every demand with its clause, every number with its unit, mark and source."""

import textwrap
from collections.abc import Iterable, Iterator
from inspect import getdoc
from typing import Any

from pydantic import BaseModel

from pvlvrt_compliance.data.marks import VERIFIED, Choice, Flag, Marked, Number, Numbers, own_mark
from pvlvrt_compliance.profile.curves import MarkedPoint
from pvlvrt_compliance.profile.procedure import TestRow
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.profile.regions import LinearTime

_UNITS = {
    "_s_per_pu": "s/pu",
    "_hz_s": "Hz/s",
    "_w_m2": "W/m2",
    "_percent": "%",
    "_hz": "Hz",
    "_pu": "pu",
    "_deg": "deg",
    "_s": "s",
}
_STEP = "  "
_FURTHER = 2 * _STEP  # what a line that goes on is indented by
_OWN_LINE = frozenset({"clause", "source", "confidence"})
_MOST_INLINE = 6


def render(profile: Profile, columns: int | None = None) -> str:
    """Return the profile as plain text, one number a line.

    Parameters
    ----------
    profile : Profile
    columns : int, optional
        Width at which lines are broken between words, each going on further to the right; without it, none is.
    """
    lines = [f"{profile.id}: {profile.title}", *_indented(_head(profile)), "", *_legend(profile), "", "REQUIREMENTS"]
    for kind, requirement in profile.requirements.by_kind():
        lines += ["", f"{kind} ({requirement.clause})", *_indented(_requirement(requirement))]
    for heading, part in (
        ("CONDITIONS: when a test counts", profile.conditions),
        ("WINDOWS: where a record is measured", profile.windows),
        ("DETECTION: what is an event in a record", profile.detection),
        ("THRESHOLDS: what is measured, and how exactly", profile.thresholds),
        ("PROCEDURE: what all tests share", profile.procedure),
    ):
        if part is not None:
            lines += ["", heading, *_indented(_content(part))]
    lines += ["", *_not_covered(profile), *_tests(profile, columns)]
    return "".join(f"{line}\n" for line in (lines if columns is None else _broken(lines, columns)))


def _broken(lines: Iterable[str], columns: int) -> Iterator[str]:
    """The same lines, none wider than this unless by a word that is."""
    for line in lines:
        further = line[: len(line) - len(line.lstrip())] + _FURTHER
        yield from textwrap.wrap(
            line, columns, subsequent_indent=further, break_long_words=False, break_on_hyphens=False
        ) or [""]


def _head(profile: Profile) -> Iterator[str]:
    """What the profile says of the text that it is made from."""
    plants = "; ".join(text for _, text in profile.applies_to if text)
    for name, text in (
        ("edition", profile.edition),
        ("in force in", profile.jurisdiction),
        ("applies to", plants),
        ("text", profile.address),
        ("read on", "" if profile.read_on is None else profile.read_on.isoformat()),
    ):
        if text:
            yield f"{name}: {text}"


def _not_covered(profile: Profile) -> list[str]:
    if not profile.not_covered:
        return []
    entries = (
        f"{entry.what}{f' ({entry.clause})' if entry.clause else ''}: {entry.why}" for entry in profile.not_covered
    )
    return ["NOT COVERED: what the text has and this profile does not judge", *_indented(entries), ""]


def _legend(profile: Profile) -> list[str]:
    verified = ", ".join(sorted(VERIFIED))
    weakest = profile.weakest_mark
    return [f"Marks in brackets say how far a number was verified; verified are: {verified}. Weakest here: {weakest}."]


def _requirement(requirement: BaseModel) -> Iterator[str]:
    document = (getdoc(type(requirement)) or "").replace("``", "").split("\n\n")
    yield " ".join(document[0].split())
    if len(document) > 1:
        yield " ".join(document[1].split())
    yield f"source: {getattr(requirement, 'source', '')}"
    yield from _content(requirement)


def _content(model: BaseModel) -> Iterator[str]:
    """Lines of everything in a model but where it comes from."""
    for name, field in type(model).model_fields.items():
        value = getattr(model, name)
        if name not in _OWN_LINE and value not in (None, (), {}):
            yield from _named(field.alias or name, value, field.description)


def _named(name: str, value: Any, description: str | None = None) -> Iterator[str]:
    words, unit = _words(name)
    note = f" ({description})" if description else ""
    match value:
        case Number() | Flag() | Choice():
            yield f"{words}: {_quantity(value.value, unit)}{note} {_provenance(value)}"
        case Numbers():
            yield f"{words}: {', '.join(_quantity(v, unit) for v in value.values)}{note} {_provenance(value)}"
        case Marked():
            yield f"{words}{note} {_provenance(value)}"
            yield from _indented(_content(value))
        case BaseModel():
            inline = _inline(value)
            yield f"{words}: {inline}" if inline is not None else f"{words}{note}:"
            if inline is None:
                yield from _indented(_content(value))
        case dict():
            yield f"{words}{note}:"
            yield from _indented(line for key, part in value.items() for line in _named_in_table(key, part, unit))
        case tuple() if name == "points":
            yield f"{words}{note}: {', '.join(map(_point, value))}"
        case tuple() if value and isinstance(value[0], BaseModel):
            yield f"{words}{note}:"
            yield from _indented(_inline(row, limit=False) or "" for row in value)
        case _:
            yield f"{words}: {_quantity(value, unit)}{note}"


def _named_in_table(key: str, value: Any, unit: str) -> Iterator[str]:
    """An entry of a table of the user's own: its name is no key and has no unit, the table's has."""
    if isinstance(value, Number):
        yield f"{key}: {_quantity(value.value, unit)} {_provenance(value)}"
    else:
        yield from (
            line.replace(_words(key)[0], key, 1) if not k else line for k, line in enumerate(_named(key, value))
        )


def _inline(model: BaseModel, limit: bool = True) -> str | None:
    """A small model on one line; None when it is larger, or holds marks."""
    parts = [(name, getattr(model, name)) for name in type(model).model_fields]
    parts = [(name, value) for name, value in parts if name not in _OWN_LINE and value not in (None, (), {})]
    if limit and (len(parts) > _MOST_INLINE or any(isinstance(value, Marked) for _, value in parts)):
        return None
    told = ", ".join(f"{_words(name)[0]} {_quantity(value, _words(name)[1])}" for name, value in parts)
    mark = own_mark(model)
    return told if mark is None else f"{told} {_provenance(mark)}"


def _point(point: Any) -> str:
    """A point of a line, with its mark where it has one of its own."""
    if isinstance(point, MarkedPoint):
        return f"({point.t_s:g}, {point.u_pu:g}) {_provenance(point)}"
    return f"({point[0]:g}, {point[1]:g})"


def _provenance(item: Marked) -> str:
    clause = getattr(item, "clause", "")
    return f"[{item.confidence}] {f'{clause}; ' if clause else ''}{item.source}"


def _words(name: str) -> tuple[str, str]:
    """Name of a key in words, and its unit."""
    ending = next((ending for ending in _UNITS if name.endswith(ending)), "")
    return (name.removesuffix(ending).replace("_", " ") or name), _UNITS.get(ending, "s" if name == "s" else "")


def _quantity(value: Any, unit: str) -> str:
    match value:
        case bool():
            return "yes" if value else "no"
        case int() | float():
            return f"{value:g} {unit}".rstrip()
        case tuple() if len(value) == 2 and unit:
            return f"{value[0]:g} to {value[1]:g} {unit}"
        case tuple():
            return " to ".join(map(str, value)) if len(value) == 2 else ", ".join(map(str, value))
        case BaseModel():
            return value.in_words() if isinstance(value, LinearTime) else f"({_inline(value, limit=False)})"
    return str(value).replace("_", " ")


def _tests(profile: Profile, columns: int | None) -> Iterator[str]:
    rows, runs = profile.all_rows, len(profile.tests())
    if not rows:
        yield "TESTS: none; the profile judges a sag given with --sag"
        return
    yield f"TESTS: {len(rows)} rows, {runs} runs"
    table = [("id", "what happens", "power", "demand", "mark", "clause"), *map(_row, rows)]
    widths = [max(len(line[k]) for line in table) for k in range(5)]
    lines = ["  ".join(text.ljust(width) for text, width in zip(line, [*widths, 0], strict=True)) for line in table]
    if columns is None or max(map(len, lines)) + len(_STEP) <= columns:
        yield from (f"{_STEP}{line.rstrip()}" for line in lines)
    else:
        yield from _one_below_the_other(table[1:])


def _one_below_the_other(rows: Iterable[tuple[str, str, str, str, str, str]]) -> Iterator[str]:
    """The test table where it is too wide: what happens, and below it the rest."""
    for name, what, power, demand, mark, clause in rows:
        yield f"{_STEP}{name}: {what.removeprefix(f'{name}: ')}"
        yield f"{_STEP}{_STEP}{power.replace(',', ', ')}; {demand} [{mark}] {clause}"


def _row(row: TestRow) -> tuple[str, str, str, str, str, str]:
    demand = row.expect.replace("_", " ") + ("" if row.by_s is None else f" by {row.by_s:g} s")
    return row.id, row.title or _what_happens(row), ",".join(row.powers), demand, row.confidence, row.clause


def _what_happens(row: TestRow) -> str:
    steps = f"steps {row.steps.order}" if row.steps else ""
    lasts = f"{row.duration_s:g} s" if isinstance(row.duration_s, float) else "as long as the envelope asks"
    sag = f"{row.sag.describe()}, {lasts}" if not steps else ""
    events = ", ".join(event.kind.replace("_", " ") for event in row.events)
    return "; ".join(part for part in (sag, steps, events) if part)


def _indented(lines: Iterable[str]) -> list[str]:
    return [_STEP + line for line in lines]
