"""What holds for a run: the command line over the environment over a file."""

import hashlib
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.settings import PROJECT_FILE
from pvlvrt_compliance.settings.finding import Found, find_file, read_file
from pvlvrt_compliance.settings.reading import CONFIG, Level, Value, values_of_environment, values_of_file
from pvlvrt_compliance.settings.setting import Setting
from pvlvrt_compliance.settings.together import Together


@dataclass(frozen=True, kw_only=True)
class Effective:
    """What holds for a run, and where it comes from.

    Parameters
    ----------
    values : mapping
        By field; what is at its default is not there, but for what an empty text has taken back to it, whose value is
        None.
    found : Found
        The file of settings.
    put_aside : tuple of str
        What was given further from the command, and does not go with what was given nearer; in words.
    warnings : tuple of str
        What else is to be told.
    """

    values: Mapping[str, Value]
    found: Found
    put_aside: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    settings: Mapping[str, Setting] = field(default_factory=dict)

    @property
    def given(self) -> dict[str, Any]:
        """Values by field, as the options would give them."""
        return {name: value.value for name, value in self.values.items() if value.value is not None}

    def to_run_by(self) -> Self:
        """The same, where a run may go by it.

        Raises
        ------
        UsageError
            When the nearest file is refused: without it another controller would be judged than the one it names.
        """
        if self.found.refused:
            raise UsageError(self.found.refused)
        return self

    @property
    def written_down(self) -> dict[str, Value]:
        """Values by key that were not typed."""
        return {
            self.settings[name].key: value
            for name, value in self.values.items()
            if value.level is not Level.COMMAND_LINE
        }

    def spell(self, otherwise: Callable[[str], str]) -> "Spelling":
        """How messages name a field: where it was written, or as an option."""
        return Spelling(self.values, otherwise)

    @property
    def in_words(self) -> str:
        """Which file and variables hold, in a line; empty where none does."""
        keys = [key for key, value in self.written_down.items() if value.level is Level.FILE]
        variables = [value.origin for value in self.written_down.values() if value.level is Level.ENVIRONMENT]
        parts = []
        if self.found.file is not None:
            parts.append(f"{self.found.file.source.origin} ({', '.join(keys) or 'of which nothing is used'})")
        if variables:
            parts.append(f"the environment ({', '.join(variables)})")
        return f"settings of {' and of '.join(parts)}" if parts else ""

    @property
    def provenance(self) -> dict[str, Any]:
        """The same as results keep it; empty where everything was typed, or says nothing of them."""
        if not self._is_of_results:
            return {}
        file = self.found.file
        of_file = {} if file is None else {"file": file.source.origin, "digest": _digest(file.source.text)}
        hows = {setting.key for setting in self.settings.values() if setting.is_how}
        values = {
            key: {"value": value.value, "from": value.origin}
            for key, value in self.written_down.items()
            if key not in hows
        }
        return {**of_file, "values": values}

    @property
    def _is_of_results(self) -> bool:
        """Whether anything was written down that results carry."""
        hows = {setting.key for setting in self.settings.values() if setting.is_how}
        return self.found.file is not None or not hows.issuperset(self.written_down)

    def command(self, typed: Sequence[str]) -> tuple[str, ...]:
        """Words that make the run again without file and environment: those typed, where neither holds."""
        if self._is_of_results:
            return (typed[0], "--isolated", *self._options())
        return tuple(_without(typed, [setting for setting in self.settings.values() if setting.is_how]))

    def _options(self) -> Iterator[str]:
        for name, setting in self.settings.items():
            value = self.values[name].value if name in self.values and not setting.is_how else None
            if value is True:
                yield setting.option
            elif value is not None and value is not False:
                for item in value if isinstance(value, list) else [value]:
                    text = f"{item:.15g}" if isinstance(item, float) else str(item)
                    yield from (f"{setting.option}={text}",) if text.startswith("-") else (setting.option, text)


@dataclass(frozen=True)
class Spelling:
    """How messages name a field, or an item of one that is a list (`errors.spelled_of`)."""

    values: Mapping[str, Value]
    otherwise: Callable[[str], str]

    def __call__(self, name: str) -> str:
        """A field."""
        value = self._written(name)
        return self.otherwise(name) if value is None else value.spelled

    def of_item(self, name: str, item: str) -> str:
        """A field of which one item is meant."""
        value = self._written(name)
        return self.otherwise(name) if value is None else value.of_item(item)

    def _written(self, name: str) -> Value | None:
        value = self.values.get(name)
        return None if value is None or value.level is Level.COMMAND_LINE else value


def effective(
    settings: Collection[Setting],
    typed: Mapping[str, Any],
    environment: Mapping[str, str],
    *,
    start: Path,
    config: str | None = None,
    isolated: bool = False,
) -> Effective:
    """Work out what holds.

    Lists are not joined: that of the nearest counts. An empty text on the command line takes a value back that
    environment or file gives.

    Parameters
    ----------
    settings : collection of Setting
        That there are.
    typed : mapping
        What was given on the command line, by field; also what is no setting.
    environment : mapping
    start : Path
        The working directory, absolute.
    config : str, optional
        File of settings that was named: it is used whoever it belongs to.
    isolated : bool
        Whether neither file nor environment holds.

    Raises
    ------
    UsageError
        When a file or a variable cannot be used: all its problems at once.
    """
    by_field = {setting.field: setting for setting in settings}
    found = Found(None, "--isolated")
    warnings: list[str] = []
    layers: list[dict[str, Value]] = []
    if isolated and config is not None:
        raise UsageError("--config names a file of settings, and --isolated none; they do not go together")
    if not isolated:
        found = _found(start, config, environment)
        of_environment, warnings = values_of_environment(environment, settings)
        layers = [values_of_file(found.file, settings) if found.file else {}, of_environment]
    further = {name for layer in layers for name in layer}
    layers.append({name: _typed(name, given, further) for name, given in typed.items()})
    together = Together(layers, by_field)
    return Effective(
        values=together.values,
        found=found,
        put_aside=tuple(together.put_aside),
        warnings=tuple(warnings),
        settings=by_field,
    )


def _without(typed: Sequence[str], hows: Collection[Setting]) -> Iterator[str]:
    """Words without some options and their values; a flag has none, and a form that takes it back."""
    flags = {setting.option for setting in hows if setting.kind is bool}
    flags |= {f"--no-{option.removeprefix('--')}" for option in flags}
    with_value = {setting.option for setting in hows if setting.kind is not bool}
    words = iter(typed)
    for word in words:
        name, equals, _ = word.partition("=")
        if name in with_value:
            if not equals:
                next(words, None)
        elif word not in flags:
            yield word


def _typed(name: str, given: Any, further: Collection[str]) -> Value:
    """A value of the command line; an empty one takes back what was given further off.

    Where nothing was, it is what the option refuses: a script whose variable is empty says nothing by it.
    """
    is_back = given in ("", [""]) and name in further
    return Value(None if is_back else given, Level.COMMAND_LINE, "command line", name)


def _found(start: Path, config: str | None, environment: Mapping[str, str]) -> Found:
    named, by = (config, "--config") if config is not None else (environment.get(CONFIG), CONFIG)
    if not named:
        return find_file(start)
    file = read_file(Path(named))
    if file is None:
        raise UsageError(f"{by} {named}: a {PROJECT_FILE} without a table [tool.pvlvrt]")
    return Found(file)


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
