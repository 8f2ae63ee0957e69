"""What another program answers when it is greeted: the data model of its hello."""

import json
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, FiniteFloat, ValidationError

from pvlvrt_compliance.controllers.description import Description, ParameterInfo
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.mapping.port_units import UNITS, spelled
from pvlvrt_compliance.controllers.mapping.units_of_names import unit_of_name
from pvlvrt_compliance.data.problems import dotted, problem_lines
from pvlvrt_compliance.errors import listed
from pvlvrt_compliance.simulation.door.blocks import MODULATING
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, RAREST, SIGNALS
from pvlvrt_compliance.texts import shortened

PROTOCOL, VERSION = "pvlvrt-check", 1
_SHOWN = 200  # characters of what is not understood
_MOST_NUMBERS = 4096  # in a message


class _Strict(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class PortAnswer(_Strict):
    """A port; written as its name alone where that says everything."""

    name: str = Field(min_length=1)
    unit: str = ""
    width: int = Field(default=1, ge=1, le=1000)
    description: str = ""


class ParameterAnswer(_Strict):
    """A parameter; written as its default alone where that says everything."""

    value: bool | int | FiniteFloat | str
    unit: str = ""
    description: str = ""
    minimum: FiniteFloat | None = None
    maximum: FiniteFloat | None = None

    @property
    def default(self) -> bool | int | float | str:
        """The default, as a number where it is not meant as a whole one: there are languages that write 1.0 as 1."""
        if type(self.value) is not int:
            return self.value
        of_quantity = self.unit.strip() and spelled(self.unit) not in UNITS["number"]
        in_fractions = any(not end.is_integer() for end in (self.minimum, self.maximum) if end is not None)
        return float(self.value) if of_quantity or in_fractions else self.value


def _as_table(key: str) -> BeforeValidator:
    return BeforeValidator(lambda given: given if isinstance(given, (dict, BaseModel)) else {key: given})


AnyPort = Annotated[PortAnswer, _as_table("name")]
AnyParameter = Annotated[ParameterAnswer, _as_table("value")]


class Hello(_Strict):
    """Answer to the host's hello."""

    version: Literal[1]
    name: str = "program"
    sample_time_s: FiniteFloat = Field(gt=0)
    mode: Literal["json", "binary"] = "json"
    every: int = Field(default=1, ge=1, le=RAREST, description="samples from one run of a slow task to the next")
    inputs: tuple[AnyPort, ...] = tuple(PortAnswer(name=name) for name in SIGNALS)
    outputs: tuple[AnyPort, ...] = tuple(PortAnswer(name=name) for name in MODULATING)
    parameters: Mapping[str, AnyParameter] = {}

    def parameter_infos(self) -> tuple[ParameterInfo, ...]:
        """Parameters as every door has them."""
        return tuple(
            ParameterInfo(name, p.default, p.unit, p.description, p.minimum, p.maximum)
            for name, p in self.parameters.items()
        )

    def description(self, digest: str) -> Description:
        """What is known without the ports."""
        return Description("program", self.name, digest, self.sample_time_s, parameters=self.parameter_infos())


def greeting(given: Mapping[str, Any]) -> bytes:
    """First message of the host; ``given`` are the parameters that the user has set."""
    units = {name: unit_of_name(name) for name in SIGNALS}
    commands = {name: unit_of_name(name) for name in COMMANDS}
    return as_line(
        {"protocol": PROTOCOL, "version": VERSION, "signals": units, "commands": commands, "parameters": dict(given)}
    )


def as_line(message: Mapping[str, Any]) -> bytes:
    """Message in one line."""
    return json.dumps(message).encode() + b"\n"


def table_in(line: bytes) -> dict[str, Any]:
    """Read a message of a program.

    Raises
    ------
    DoorError
        When it is no table of JSON, or says that the program gives up.
    """
    try:
        message = json.loads(line)
    except (ValueError, RecursionError):
        message = None
    if not isinstance(message, dict):
        raise DoorError(f"the program sent {shown(line)}, which is not a JSON object in one line")
    if "error" in message:
        raise DoorError(f"the program gave up: {message['error']}")
    return message


def shown(data: bytes) -> str:
    """Bytes for a person to read, not too many."""
    return shortened(repr(data.decode("utf-8", "backslashreplace")), _SHOWN)


def hello_in(line: bytes) -> Hello:
    """Read a program's answer to the greeting.

    Raises
    ------
    DoorError
        With everything in it that cannot be used.
    """
    message = table_in(line)
    try:
        hello = Hello.model_validate(message)
    except ValidationError as error:
        problems = [f"{dotted(location)}: {text}" for location, text in problem_lines(error, Hello, message)]
        raise DoorError(listed("its answer to the hello cannot be used", problems)) from None
    for what, ports in (("inputs", hello.inputs), ("outputs", hello.outputs)):
        names = [port.name for port in ports]
        if twice := sorted({name for name in names if names.count(name) > 1}):
            raise DoorError(f"its answer to the hello: {what} has {', '.join(twice)} twice")
        if not 0 < sum(port.width for port in ports) <= _MOST_NUMBERS:
            raise DoorError(f"its answer to the hello: {what} must have 1 to {_MOST_NUMBERS} numbers")
    return hello


_NOTHING: Mapping[str, Any] = {"name": "program", "sample_time_s": 0.0, "inputs": (), "outputs": (), "parameters": {}}


def usable_of(line: bytes) -> Hello | None:
    """What can be used of an answer that cannot be used as a whole; None where it is no table, or gives up.

    A time that cannot be used is 0; of ports those are left out.
    """
    try:
        message = table_in(line)
    except DoorError:
        return None
    parts = {key: _usable_part(key, message) for key in _NOTHING}
    return Hello.model_construct(version=1, mode="json", every=1, **parts)


def _usable_part(key: str, message: Mapping[str, Any]) -> Any:
    if key in ("inputs", "outputs") and isinstance(message.get(key), list):
        found = [port for given in message[key] for port in _validated(key, [given])]
        return tuple({port.name: port for port in found}.values())
    if key not in message and key != "sample_time_s":
        return Hello.model_fields[key].default
    return _validated(key, message.get(key))


def _validated(key: str, given: Any) -> Any:
    try:
        return getattr(Hello.model_validate({"version": VERSION, "sample_time_s": 1.0, key: given}), key)
    except ValidationError:
        return _NOTHING[key]
