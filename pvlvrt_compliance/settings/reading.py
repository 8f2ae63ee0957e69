"""Values of settings, out of a file and out of the environment."""

from collections.abc import Callable, Collection, Iterator, Mapping
from enum import IntEnum
from typing import Any, NamedTuple

from pvlvrt_compliance.data.positions import Location
from pvlvrt_compliance.data.search_path import VARIABLE
from pvlvrt_compliance.errors import UsageError, did_you_mean, listed
from pvlvrt_compliance.settings.finding import Taken
from pvlvrt_compliance.settings.places import placed
from pvlvrt_compliance.settings.setting import PREFIX, InvalidSettingError, Setting, from_file, from_variable

CONFIG = f"{PREFIX}CONFIG"
"""Variable that names the file of settings, as ``--config`` does."""

_NO_SETTINGS = {VARIABLE, CONFIG}
"""Variables of ours that are something else."""


class Level(IntEnum):
    """How near to the command a value was given: the nearest counts."""

    FILE = 1
    ENVIRONMENT = 2
    COMMAND_LINE = 3


class Value(NamedTuple):
    """Value of a setting, as its option gives it."""

    value: Any
    level: Level
    origin: str  # the line of a file, a variable or the command line, as a reader knows it
    spelled: str  # the setting as it was written there, to be named in a message
    lines: Mapping[str, str] = {}

    def of_item(self, item: str) -> str:
        """Where an item of a list was written, by itself or by its name before an equals sign; else as `spelled`."""
        found = [line for text, line in self.lines.items() if item in (text, text.partition("=")[0].strip())]
        return found[-1] if found else self.spelled


def values_of_file(taken: Taken, settings: Collection[Setting]) -> dict[str, Value]:
    """Values that a file gives, by field.

    Raises
    ------
    UsageError
        With every key that is unknown and every value of another kind: its line, and what is allowed.
    """
    by_key = {setting.key: setting for setting in settings}
    found: dict[str, Value] = {}
    problems: list[tuple[Location, str]] = []
    for key, raw in taken.table.items():
        here = (*taken.place, key)
        if key not in by_key:
            hint = _known(key, by_key, lambda setting: setting.key)
            problems.append((here, f"there is no such setting{hint}"))
            continue
        setting = by_key[key]
        try:
            value = placed(setting, from_file(setting, raw), taken.folder)
        except InvalidSettingError as error:
            problems += [((*here, *inner), text) for inner, text in error.problems]
            continue
        places = taken.source.places
        origin = f"{taken.source.origin}:{places.line_of(here)}"
        items = [f"{taken.source.origin}:{places.line_of(each)} {key}" for each in _items(raw, here)]
        lines = dict(zip(value, items, strict=True)) if setting.is_list else {}
        found[setting.field] = Value(value, Level.FILE, origin, f"{origin} {key}", lines)
    if problems:
        raise taken.source.refusal(*problems)
    return found


def _items(raw: Any, here: Location) -> Iterator[Location]:
    """Where the items of a list stand, in the order in which `from_file` gives them."""
    inner = raw.items() if isinstance(raw, dict) else enumerate(raw) if isinstance(raw, list) else None
    if inner is None:
        yield here
        return
    for key, value in inner:
        yield from _items(value, (*here, key))


def values_of_environment(
    environment: Mapping[str, str], settings: Collection[Setting]
) -> tuple[dict[str, Value], list[str]]:
    """Values that variables give, by field, and what is to be told of variables that are none of ours.

    A variable without content is not given.

    Raises
    ------
    UsageError
        With every variable whose text cannot be used.
    """
    by_variable = {setting.variable: setting for setting in settings}
    found: dict[str, Value] = {}
    problems, told = [], []
    for name in sorted(name for name in environment if name.startswith(PREFIX)):
        text = environment[name]
        if name in _NO_SETTINGS or not text.strip():
            continue
        if name not in by_variable:
            told.append(f"{name}: there is no setting of this name{did_you_mean(name, by_variable)}")
            continue
        setting = by_variable[name]
        try:
            found[setting.field] = Value(from_variable(setting, text), Level.ENVIRONMENT, name, name)
        except InvalidSettingError as error:
            problems.append(f"{name}: {error}")
    if problems:
        raise UsageError(listed("environment", problems))
    return found, told


def _known(key: str, by_key: Mapping[str, Setting], written: Callable[[Setting], str]) -> str:
    """What was meant by a key: a setting by its field, by its option, or by a near miss."""
    same = next((s for s in by_key.values() if key in (s.field, s.option, s.option.removeprefix("--"))), None)
    if same is not None:
        return f'; it is written "{written(same)}"'
    return did_you_mean(key, by_key) or f"; there are: {', '.join(by_key)}"
