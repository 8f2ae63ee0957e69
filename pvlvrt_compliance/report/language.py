"""The texts of a report in the language that was asked for: one catalogue of whole sentences a language.

A catalogue is a TOML file under ``reports/texts/``: tables of texts with places for values, ``"{count} tests"``. A text
that depends on a number is a table with ``one`` and ``other``; ``count`` decides. Another language is another file.
"""

import string
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from pvlvrt_compliance.data.reader import Kind, Source
from pvlvrt_compliance.errors import PvlvrtError, UsageError, did_you_mean, listed
from pvlvrt_compliance.resources import resource_folder

BASE = "en"
"""The language that has every text; what another lacks is told in it."""

_SUFFIX = ".toml"
_Text = str | Mapping[str, str]


def _damaged(origin: str, problems: Sequence[str]) -> PvlvrtError:
    return PvlvrtError(listed(origin, problems))


_KIND = Kind("a catalogue of texts", "catalogues of texts", _damaged)


def languages() -> tuple[str, ...]:
    """Names of the languages that there are, by their files."""
    return tuple(sorted(path.stem for path in _folder().glob(f"*{_SUFFIX}")))


def check_language(name: str, spelled: str = "--language") -> str:
    """Return the name of a language.

    Raises
    ------
    UsageError
        When there is none of the name; names those that there are.
    """
    known = languages()
    if name not in known:
        hint = did_you_mean(name, known) or f"; there are: {', '.join(known)}"
        raise UsageError(f"{spelled}: no language {name!r}{hint}")
    return name


class Texts:
    """The texts of one language: ``texts("matrix.tests", count=3)``.

    Parameters
    ----------
    language : str
        Its name, as of `languages`; it stands in the page as the language of its text.

    Raises
    ------
    UsageError
        When there is no language of the name.
    """

    def __init__(self, language: str = BASE) -> None:
        self.language = check_language(language)
        self._texts = catalogue(BASE) | catalogue(language)

    def __call__(self, key: str, **values: Any) -> str:
        """The text of a key with values in their places.

        Raises
        ------
        KeyError
            When there is no such text, or it has a place for what is not given: both are faults of the program.
        """
        return _filled(self._texts[key], values)

    def named(self, table: str, name: str) -> str:
        """What a name of the data (``reactive_support``) is called; one that the table lacks in its own words."""
        found = self._texts.get(f"{table}.{name}")
        return name.replace("_", " ") if found is None else _filled(found, {})

    def __contains__(self, key: str) -> bool:
        return key in self._texts


def places_in(text: _Text) -> set[str]:
    """Names of the values that a text has places for."""
    forms = [text] if isinstance(text, str) else list(text.values())
    return {name for form in forms for _, name, _, _ in string.Formatter().parse(form) if name}


@cache
def catalogue(language: str) -> dict[str, _Text]:
    """Every text of a language by its key, names of nested tables joined by dots."""
    return dict(_flat(Source(_folder() / f"{language}{_SUFFIX}", _KIND).table, ""))


def _flat(table: Mapping[str, Any], prefix: str) -> list[tuple[str, _Text]]:
    found: list[tuple[str, _Text]] = []
    for name, value in table.items():
        if isinstance(value, Mapping) and "other" not in value:
            found += _flat(value, f"{prefix}{name}.")
        else:
            found.append((f"{prefix}{name}", value))
    return found


def _filled(text: _Text, values: Mapping[str, Any]) -> str:
    if not isinstance(text, str):
        text = text["one" if values["count"] == 1 and "one" in text else "other"]
    return text.format_map(values)


def _folder() -> Path:
    return resource_folder("reports") / "texts"
