"""What a setting is: an option of the command by another way."""

import json
import math
import shlex
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from pvlvrt_compliance.texts import shortened

PREFIX = "PVLVRT_"
"""How the names of variables begin that are settings."""

Located = tuple[tuple[int | str, ...], str]
"""Where within the value of a setting something is wrong, and what."""

_YES = ("1", "true", "yes", "on")
_NO = ("0", "false", "no", "off")


class Setting(NamedTuple):
    """A setting, by the option that does the same.

    Parameters
    ----------
    field : str
        What it sets, as the code calls it.
    option : str
        As it is typed: ``--report-field``. Key and variable are named after it.
    kind : type
        Of its value: bool, float, str or ``list[str]``.
    metavar : str
        What the help shows in place of the value; says which values are paths, and which a table may hold.
    is_how : bool
        Whether it says how a run is made, of which its results are the same: they do not carry it.
    """

    field: str
    option: str
    kind: Any
    metavar: str
    is_how: bool = False

    @property
    def key(self) -> str:
        """Its name in a file."""
        return self.option.removeprefix("--").replace("-", "_")

    @property
    def variable(self) -> str:
        """Its name in the environment."""
        return f"{PREFIX}{self.key.upper()}"

    @property
    def is_list(self) -> bool:
        """Whether its option is repeatable."""
        return bool(self.kind == list[str])

    @property
    def is_table(self) -> bool:
        """Whether a file may have a table for it: its option takes ``NAME=VALUE``."""
        return self.is_list and self.metavar == "NAME=VALUE"


class InvalidSettingError(Exception):
    """A value that a setting does not take, with every problem by its place within the value."""

    def __init__(self, *problems: Located) -> None:
        super().__init__("; ".join(text for _, text in problems))
        self.problems = problems


def from_file(setting: Setting, raw: Any) -> Any:
    """Value of a setting in a file, as its option would give it.

    Raises
    ------
    InvalidSettingError
        When it is of another kind.
    """
    if setting.is_table and isinstance(raw, dict):
        return _all_or_none(_pairs(raw))
    if setting.is_list:
        return _all_or_none(_texts(raw if isinstance(raw, list) else [raw], whole=not isinstance(raw, list)))
    if setting.kind is float:
        return _number(raw)
    if setting.kind is not bool:
        return _text(raw)
    if not isinstance(raw, bool):
        raise InvalidSettingError(((), f"must be true or false, not {_shown(raw)}"))
    return raw


def from_variable(setting: Setting, text: str) -> Any:
    """Value of a setting in a variable, as its option would give it.

    Raises
    ------
    InvalidSettingError
        When the text is none for it.
    """
    if setting.is_list:
        return _words(text)
    if setting.kind is bool:
        if text.lower() not in (*_YES, *_NO):
            raise InvalidSettingError(((), f"{text!r} is neither of {', '.join(_YES)} nor of {', '.join(_NO)}"))
        return text.lower() in _YES
    if setting.kind is float:
        try:
            return _number(float(text))
        except ValueError:
            raise InvalidSettingError(((), f"must be a number, not {text!r}")) from None
    return text


def _number(raw: Any) -> float:
    if isinstance(raw, bool) or not isinstance(raw, int | float) or not math.isfinite(raw):
        raise InvalidSettingError(((), f"must be a number, not {_shown(raw)}"))
    return float(raw)


def _text(raw: Any) -> str:
    """A text; a number is taken as it is written, for many options take either (``sag = 0.9``)."""
    if isinstance(raw, bool) or not isinstance(raw, str | int | float):
        raise InvalidSettingError(((), f"must be a text, not {_shown(raw)}"))
    if not str(raw):
        raise InvalidSettingError(((), "must not be empty; leave it out"))
    return str(raw)


def _texts(raw: list[Any], *, whole: bool) -> Iterator[str | Located]:
    for index, item in enumerate(raw):
        if isinstance(item, str) and item:
            yield item
        else:
            words = "a text or a list of texts" if whole else "a text" if item != "" else "a text that is not empty"
            yield () if whole else (index,), f"must be {words}, not {_shown(item)}"


def _pairs(table: Mapping[str, Any], before: tuple[str, ...] = ()) -> Iterator[str | Located]:
    """``NAME=VALUE`` of a table; tables in it are what stands before a dot of the name."""
    for name, value in table.items():
        here = (*before, name)
        if isinstance(value, dict):
            yield from _pairs(value, here)
        elif isinstance(value, bool | int | float | str):
            yield f"{'.'.join(here)}={value if isinstance(value, str) else json.dumps(value)}"
        else:
            yield here, f"must be a number, true, false or a text, not {_shown(value)}"


def _all_or_none(found: Iterator[str | Located]) -> list[str]:
    items = list(found)
    if problems := [item for item in items if not isinstance(item, str)]:
        raise InvalidSettingError(*problems)
    return [item for item in items if isinstance(item, str)]


def _words(text: str) -> list[str]:
    """Words as a shell has them, but that a backslash, which paths on Windows have, is itself."""
    lexer = shlex.shlex(text, posix=True, punctuation_chars=False)
    lexer.whitespace_split, lexer.escape, lexer.commenters = True, "", ""
    try:
        return list(lexer)
    except ValueError:
        raise InvalidSettingError(((), f"{text!r} has a quotation mark without its second")) from None


def _shown(raw: Any) -> str:
    return shortened(json.dumps(raw, default=str, ensure_ascii=False), _LONGEST)


_LONGEST = 60
