"""The file that ties a controller's ports to the plant: its tables, and how it is read."""

from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    FiniteFloat,
    PrivateAttr,
    model_validator,
)

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.mapping.port_units import Bases
from pvlvrt_compliance.data.models import validated
from pvlvrt_compliance.data.positions import Location, Places
from pvlvrt_compliance.data.reader import Kind, Source
from pvlvrt_compliance.data.syntax import Table
from pvlvrt_compliance.errors import listed
from pvlvrt_compliance.ordinary_file import is_there, real
from pvlvrt_compliance.texts import shortened

Sign = Literal[1, -1]
Direction = Literal["out_of_inverter", "into_inverter"]
OutputKind = Literal["modulating", "voltage", "dq"]

LARGEST_LISTED_BYTES = 256 << 20
"""Of a listed file (chosen): libraries and tables have less, and each is read to know whether it has changed."""

_SHOWN = 200  # characters of a name

ENDING = ".mapping.toml"
"""What the name of a mapping file ends in that is found beside its controller."""


def _as_tuple(value: Any) -> Any:
    if isinstance(value, str):
        return (value,)
    return tuple(value) if isinstance(value, list) else value


Names = Annotated[tuple[str, ...], BeforeValidator(_as_tuple)]
"""A name, or one for every element of a wide port."""


class _Table(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class InputEntry(_Table):
    """What an input is given; in a file also a signal's name, a list of them, or a number alone."""

    signal: Names | None = None
    constant: FiniteFloat | None = Field(default=None, description="in the port's unit")
    unit: str | None = Field(default=None, description="none: as the controller says")
    base: FiniteFloat | None = Field(default=None, gt=0, description="1 pu in the signal's unit")
    sign: Sign = 1
    direction: Direction = Field(default="out_of_inverter", description="of a positive current")

    @model_validator(mode="before")
    @classmethod
    def _from_short(cls, value: Any) -> Any:
        if isinstance(value, (str, list, tuple)):
            return {"signal": value}
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            return {"constant": value}
        return value

    @model_validator(mode="after")
    def _one_source(self) -> "InputEntry":
        if (self.signal is None) == (self.constant is None):
            raise ValueError("give a signal or a constant")
        return self


class OutputEntry(_Table):
    """What an output gives; in a file also a command's name or a list of them alone."""

    command: Names | None = None
    record: Names | None = Field(default=None, description="channel of the record")
    unit: str | None = Field(default=None, description="none: as the controller says; with record, none: as it is")
    base: FiniteFloat | None = Field(default=None, gt=0, description="1 pu in the command's or the channel's unit")
    sign: Sign = 1
    inverted: bool = Field(default=False, description="of a switch: 1 is off, as of an enable that is tied to block")

    @model_validator(mode="before")
    @classmethod
    def _from_short(cls, value: Any) -> Any:
        return {"command": value} if isinstance(value, (str, list, tuple)) else value

    @model_validator(mode="after")
    def _one_target(self) -> "OutputEntry":
        if (self.command is None) == (self.record is None):
            raise ValueError("give a command, or a name to record it under")
        return self


class MappingFile(_Table):
    """A mapping file: entries by the port's name, of one element of a wide port by ``name[index]``, from 0."""

    inputs: dict[str, InputEntry] = {}
    outputs: dict[str, OutputEntry] = {}
    bases: Bases = Bases()
    currents: Direction = Field(default="out_of_inverter", description="positive phase currents that name no direction")
    output_kind: OutputKind | None = Field(default=None, description="of several kinds of commands that are complete")
    files: tuple[str, ...] = Field(
        default=(),
        description="all that the controller is made of and reads besides its own file, by names or patterns",
    )

    _places: Places = PrivateAttr(default=Places("mapping", {}))
    _listed: tuple[Path, ...] = PrivateAttr(default=())
    _mistakes: tuple[str, ...] = PrivateAttr(default=())
    _left_out: frozenset[Location] = PrivateAttr(default=frozenset())

    @property
    def mistakes(self) -> tuple[str, ...]:
        """What is wrong with the file by itself, each in words, where it was read by `read_mapping`."""
        return self._mistakes

    def left_out(self, *location: int | str) -> bool:
        """Whether a key has been left out because of a mistake in it."""
        return location in self._left_out

    @property
    def listed(self) -> tuple[Path, ...]:
        """The files that it lists, each once, in the order of their names."""
        return self._listed

    def problem(self, location: Location, text: str) -> str:
        """A problem in words: file, line, key, what is wrong."""
        return self._places.problem(location, text)


def load_mapping(path: str | Path | None) -> MappingFile | None:
    """Read a mapping file; None without one.

    Raises
    ------
    DoorError
        When it cannot be read or has keys or values that are not known; all problems with line and key.
    """
    mapping = read_mapping(path)
    check_alone(mapping)
    return mapping


def check_alone(mapping: MappingFile | None) -> None:
    """Refuse a file for what is wrong with it by itself, where no ports are known that it could be held against.

    Raises
    ------
    DoorError
        With all of it.
    """
    if mapping is not None and mapping.mistakes:
        raise refusal(mapping._places.origin, mapping.mistakes)


def read_mapping(path: str | Path | None) -> MappingFile | None:
    """Read a mapping file that ports are to be tied by; None without one.

    What is wrong with the file by itself is kept as its `mistakes` and left out, so that it is told together with
    what does not fit the ports: see `sides.map_ports`.

    Raises
    ------
    DoorError
        When it cannot be read or is not TOML.
    """
    if path is None:
        return None
    source = Source(Path(path), MAPPING)
    mapping, problems = _sound_part(source.table)
    mapping._places = source.places
    mapping._listed, unlisted = _listed_in(Path(path).parent, mapping)
    mapping._mistakes = tuple(mapping.problem(location, text) for location, text in (*problems, *unlisted))
    mapping._left_out = frozenset(_entry_at(location) for location, _ in problems)
    return mapping


_ANY_BASES = {name: 1.0 for name, field in Bases.model_fields.items() if field.default is None}
"""In place of bases that have a mistake, so that none of them is called missing."""


def _sound_part(table: Table) -> tuple[MappingFile, list[tuple[Location, str]]]:
    """A file without what is wrong in it, and what that is."""
    problems: list[tuple[Location, str]] = []
    while True:
        found, wrong = validated(MappingFile, table)
        if found is not None:
            return found, problems
        problems += wrong
        table = _without(table, {_entry_at(location) for location, _ in wrong})
        if any(location[:1] == ("bases",) for location, _ in wrong):
            table["bases"] = _ANY_BASES


def _entry_at(location: Location) -> Location:
    """What is left out for a mistake there: an entry of a port, else what stands at the top of the file."""
    return location[: 2 if location[:1] in (("inputs",), ("outputs",)) else 1]


def _without(table: Table, entries: Collection[Location]) -> Table:
    kept: Table = {}
    for key, value in table.items():
        if (key,) in entries or () in entries:
            continue
        kept[key] = {k: v for k, v in value.items() if (key, k) not in entries} if isinstance(value, dict) else value
    return kept


def _listed_in(folder: Path, mapping: MappingFile) -> tuple[tuple[Path, ...], list[tuple[Location, str]]]:
    """Files of a folder that a mapping lists, and what is wrong with others: not there, or outside of the folder."""
    found: set[Path] = set()
    problems: list[tuple[Location, str]] = []
    for k, name in enumerate(mapping.files):
        try:
            files = _in_folder(folder, name)
        except ValueError as error:
            problems.append((("files", k), str(error)))
        else:
            found.update(files)
    return tuple(sorted(found)), problems


def _in_folder(folder: Path, name: str) -> list[Path]:
    if not name or Path(name).is_absolute() or ".." in Path(name).parts:
        raise ValueError(f"{name!r} must be the name of a file in the folder of the mapping, or a pattern (src/*.py)")
    try:
        files = [file for file in folder.glob(name) if file.is_file()]
    except OSError as error:  # a name that is too long
        raise ValueError(f"{shortened(name, _SHOWN)} cannot be looked for: {error.strerror or error}") from None
    outside = [file for file in files if not real(file).is_relative_to(folder.resolve())]
    if outside:
        raise ValueError(f"{outside[0].relative_to(folder)} is a link to a file outside of the folder of the mapping")
    if not files:
        raise ValueError(f"there is no file {name} in the folder of the mapping")
    large = next((file for file in files if file.stat().st_size > LARGEST_LISTED_BYTES), None)
    if large is not None:
        raise ValueError(f"{large.relative_to(folder)} is larger than {LARGEST_LISTED_BYTES >> 20} MiB")
    return files


def refusal(origin: str, problems: Sequence[str]) -> DoorError:
    """All problems of a mapping as one error."""
    return DoorError(listed(origin, problems))


MAPPING = Kind("a mapping file", "mapping files", refusal)


def mapping_path(spec: str, named: str | None) -> str | None:
    """Mapping file of a controller that is a file: the one named, else ``<stem>.mapping.toml`` beside it, if any."""
    if named is not None:
        return named
    file = Path(spec)
    found = file.with_name(file.stem + ENDING)
    return str(found) if is_there(found) else None
