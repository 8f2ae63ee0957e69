"""What a controller says of itself: its ports, its parameters, its sample time."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from pvlvrt_compliance.texts import one_line, printable

Value = float | int | bool | str
"""Of a parameter."""


@dataclass(frozen=True)
class Port:
    """A place where a controller takes or gives numbers.

    Parameters
    ----------
    name, unit, description : str
        As the controller has them.
    mapped_to : str or None
        Signal that it is given, command that it gives, or the name it is recorded under; None: neither.
    width : int
        Numbers that it holds.
    note : str
        Why it is not mapped and what it could be, or that others are given the same, where that needs saying.
    """

    name: str
    unit: str = ""
    description: str = ""
    mapped_to: str | None = None
    width: int = 1
    note: str = ""

    @property
    def is_loose(self) -> bool:
        """Whether the port, or an element of it, is tied to nothing."""
        return self.mapped_to is None or "-" in self.mapped_to.split(", ")


@dataclass(frozen=True)
class ParameterInfo:
    """A parameter of a controller, as ``--set controller.NAME=`` reaches it."""

    name: str
    value: Value
    unit: str = ""
    description: str = ""
    minimum: float | None = None
    maximum: float | None = None


@dataclass(frozen=True)
class Description:
    """What a controller says of itself.

    Parameters
    ----------
    kind : str
        Kind of door.
    name : str
        Name and version of the controller.
    digest : str
        SHA-256 of its file, or of what names it (hexadecimal).
    sample_time_s : float
        From one call to the next (s); 0 where it is not known, of one that cannot be run.
    notes : tuple of str
        What else there is to know of it.
    mapping : str or None
        The mapping file that ties its ports or lists its files, if there is one.
    besides : str
        What decides what it does besides its file, parameters and mapping, in words; empty: nothing does. Asked for
        when it is opened, not for every run.
    may_be_listed : bool
        Whether that is made known by the files that a mapping lists.
    """

    kind: str
    name: str
    digest: str
    sample_time_s: float
    inputs: tuple[Port, ...] = ()
    outputs: tuple[Port, ...] = ()
    parameters: tuple[ParameterInfo, ...] = ()
    notes: tuple[str, ...] = ()
    mapping: str | None = None
    besides: str = ""
    may_be_listed: bool = True

    def to_json(self) -> dict[str, Any]:
        """As plain dictionaries."""
        return asdict(self)

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "Description":
        """Back from plain dictionaries, which the process of a controller has made: names are lines of text then."""
        return cls(
            **{
                **data,
                "name": one_line(data["name"]),
                "inputs": tuple(Port(**_in_lines(port)) for port in data["inputs"]),
                "outputs": tuple(Port(**_in_lines(port)) for port in data["outputs"]),
                "parameters": tuple(ParameterInfo(**_in_lines(parameter)) for parameter in data["parameters"]),
                "notes": tuple(map(printable, data["notes"])),
                "besides": printable(data["besides"] or ""),  # a door that has nothing to say may say so by None
            }
        )


def _in_lines(said: Mapping[str, Any]) -> dict[str, Any]:
    return {name: one_line(value) if isinstance(value, str) else value for name, value in said.items()}
