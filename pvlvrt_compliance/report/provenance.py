"""Provenance as tables, whatever depth it has."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from pvlvrt_compliance.report.language import Texts


class Group(NamedTuple):
    """A table of the provenance section."""

    title: str
    entries: tuple[tuple[str, str], ...]


def provenance_groups(provenance: Mapping[str, Any], texts: Texts) -> list[Group]:
    """Plain values first, by their names in words, then one group for each mapping, nested names joined by dots."""
    plain = tuple(
        (texts.named("provenance", name), _text(value))
        for name, value in provenance.items()
        if not isinstance(value, Mapping)
    )
    nested = [Group(name, tuple(_flatten(value))) for name, value in provenance.items() if isinstance(value, Mapping)]
    return [group for group in (Group("run", plain), *nested) if group.entries]


def out_of_range_in_words(provenance: Mapping[str, Any]) -> str:
    """Parameters of the controller that were allowed out of the range that it states; empty of none."""
    found = provenance.get("controller_out_of_range")
    return ", ".join(f"{name} = {said}" for name, said in found.items()) if isinstance(found, Mapping) else ""


def _flatten(values: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, str]]:
    for name, value in values.items():
        if isinstance(value, Mapping):
            yield from _flatten(value, f"{prefix}{name}.")
        else:
            yield prefix + str(name), _text(value)


def _text(value: object) -> str:
    if value is None:
        return "none"
    if isinstance(value, list | tuple):
        return ", ".join(f"({_text(item)})" if isinstance(item, list | tuple) else _text(item) for item in value)
    return f"{value:.10g}" if isinstance(value, float) else str(value)
