"""The one reader of the TOML files that people write: profiles, events, mappings of a controller's ports."""

from collections.abc import Callable, Sequence
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.data.content import too_deep, unusable
from pvlvrt_compliance.data.kept_tables import keep_table, table_kept
from pvlvrt_compliance.data.models import Model, validated
from pvlvrt_compliance.data.positions import Location, Places, key_lines
from pvlvrt_compliance.data.problems import dotted
from pvlvrt_compliance.data.syntax import TOO_DEEP, Table, parse
from pvlvrt_compliance.data.text import UnreadableError, read_text
from pvlvrt_compliance.errors import PvlvrtError


class Kind(NamedTuple):
    """A kind of file."""

    one: str  # "a profile"
    many: str  # "profiles"
    error: Callable[[str, Sequence[str]], PvlvrtError]  # made of the file as it is shown, and a line a problem


class Source:
    """A TOML file: its path, its table, and where its keys stand.

    Parameters
    ----------
    path : Path
    kind : Kind
    origin : str, optional
        The file as its problems name it; by default its path.

    Raises
    ------
    PvlvrtError
        That of its kind: the file cannot be read (`text`), is not TOML (`syntax`), or has what no file of ours has
        (`content`); with line and key where there is one.
    """

    def __init__(self, path: Path, kind: Kind, origin: str | None = None) -> None:
        self.path, self.kind = path, kind
        self.origin = str(path) if origin is None else origin
        try:
            self.text = read_text(path, kind.one)
            self.table = table_kept(self.text) or self._checked(parse(self.text, kind.many))
        except UnreadableError as error:
            place = self.origin if error.line is None else f"{self.origin}:{error.line}"
            raise kind.error(self.origin, [f"{place}: {error}"]) from None

    @cached_property
    def places(self) -> Places:
        """Where its keys stand."""
        return Places(self.origin, key_lines(self.text))

    def problem(self, location: Location, text: str) -> str:
        """A problem in words: file, line, key, what is wrong."""
        return self.places.problem(location, text)

    def refusal(self, *problems: tuple[Location, str]) -> PvlvrtError:
        """The error of this kind of file, with problems given by their location and text."""
        return self.kind.error(self.origin, [self.problem(location, text) for location, text in problems])

    def _checked(self, table: Table) -> Table:
        deep = too_deep(table)
        if deep is not None:
            raise UnreadableError(f"{dotted(deep[:1])}: {TOO_DEEP}", self.places.line_of(deep))
        problems = list(unusable(table))
        if problems:
            raise self.refusal(*problems)
        keep_table(self.text, table)
        return table


def read_model(source: Source, model: type[Model]) -> Model:
    """A file as the model of its kind.

    Raises
    ------
    PvlvrtError
        That of its kind, with every problem: its line and key, what is wrong and what is allowed.
    """
    found, problems = validated(model, source.table)
    if found is None:
        raise source.refusal(*problems)
    return found
