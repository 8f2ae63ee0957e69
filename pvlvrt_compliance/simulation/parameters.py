"""Every parameter of a run but its scenario, in words with units: what `--set` reaches.

Those of plant, hardware and controller stand in the room that they parametrise. No kernel is imported on the way: help,
profiles and the judging of records never pay for the compiler.
"""

import json
import math
import re
from collections.abc import Iterable, Sequence
from typing import Annotated, Any, Literal, Self, get_origin

from pydantic import Field, FiniteFloat, model_validator
from pydantic.fields import FieldInfo

from pvlvrt_compliance.control.parameters import ControllerParameters
from pvlvrt_compliance.data.models import validated
from pvlvrt_compliance.data.positions import Location
from pvlvrt_compliance.data.problems import dotted
from pvlvrt_compliance.errors import UsageError, did_you_mean, near_misses
from pvlvrt_compliance.hardware.parameters import SensorParameters
from pvlvrt_compliance.parameter_group import ParameterGroup, ranges_of
from pvlvrt_compliance.plant.parameters import PlantParameters, ProtectionParameters

Fidelity = Literal["averaged", "switched"]

LONGEST = 2000
"""Characters of a value: chosen, for the longest list of points that anybody types."""

SHORTEST_PERIOD_S, LONGEST_PERIOD_S = 1e-6, 0.1
"""Range of the control period, and of a controller's sample time: chosen."""

OUT_OF_RANGE = "is out of range"
"""In the message on a number that is."""

_BEYOND = re.compile(r"must be (?:greater|less) than(?: or equal to)? \S+, not (.+)")
"""How a number out of its range is told of one side alone."""


class SimulationParameters(ParameterGroup):
    """How closely the inverter is modelled, the two rates, and the unrecorded time before a record."""

    fidelity: Fidelity = Field(
        default="averaged", description="the mean over a carrier period, or every leg as it switches"
    )
    plant_step_us: FiniteFloat = Field(default=5.1196, ge=0.05, le=1000)
    control_ratio: int = Field(default=8, ge=1, le=1000, description="plant steps in a control period")
    settling_s: Annotated[FiniteFloat, Field(ge=0, le=60)] = Field(
        default=0.5, description="before a record, not judged; with a controller of the user's own 1 s unless set"
    )
    record_settling: bool = Field(
        default=False,
        description="write the settling into the waveforms, too, at times below 0; what is judged stays the same",
    )
    synchronising_s: Annotated[FiniteFloat, Field(ge=0, le=60)] = Field(
        default=0.2,
        description="before settling: a controller of the user's own sees the steady state, and does not act yet",
    )
    time_limit_s: FiniteFloat | None = Field(
        ge=0.001,
        le=1e6,
        default=None,
        description="of computing, for one run of a user's own controller; none: 60 s and 20 times the run's length",
    )
    opening_limit_s: FiniteFloat = Field(
        default=60.0, ge=0.001, le=1e6, description="of computing, to open a user's own controller"
    )
    memory_limit_mb: FiniteFloat = Field(
        default=2000.0,
        ge=1,
        le=1e6,
        description="of memory, for a user's own controller and all that it starts, the run's record too",
    )
    output_limit_mb: FiniteFloat = Field(
        default=64.0, ge=0.001, le=1e5, description="that a user's own controller may print in a run"
    )
    files_limit_mb: FiniteFloat = Field(
        default=1000.0,
        ge=0.001,
        le=1e6,
        description="of files in the temporary folder of a run, and that an FMU unpacks to",
    )
    files_limit: int = Field(default=10_000, ge=1, le=10_000_000, description="files in the same places")
    processes_limit: int = Field(
        default=100,
        ge=1,
        le=100_000,
        description="processes at once that a user's own controller may have, its own one counted",
    )

    @model_validator(mode="after")
    def _period_in_range(self) -> Self:
        period_s = 1e-6 * self.plant_step_us * self.control_ratio
        if not SHORTEST_PERIOD_S <= period_s <= LONGEST_PERIOD_S:
            said = f"the control period is {period_s:g} s, plant_step_us times control_ratio"
            raise ValueError(f"{said}; {SHORTEST_PERIOD_S:g} s to {LONGEST_PERIOD_S:g} s is allowed")
        return self


class Parameters(ParameterGroup):
    """All parameters of a run but its scenario."""

    simulation: SimulationParameters = SimulationParameters()
    plant: PlantParameters = PlantParameters()
    protection: ProtectionParameters = ProtectionParameters()
    sensors: SensorParameters = SensorParameters()
    controller: ControllerParameters = ControllerParameters()


def parameter_names() -> list[str]:
    """All names that `--set` takes, as ``group.name``."""
    return [
        f"{group}.{name}"
        for group, field in Parameters.model_fields.items()
        for name in field.annotation.model_fields  # type: ignore[union-attr]
    ]


def parameters_from(assignments: Iterable[str]) -> Parameters:
    """Defaults with ``group.name=value`` applied; values are written as in JSON, words also without quotes.

    Raises
    ------
    UsageError
        When a name is unknown (with the near misses), given twice, or a value is not allowed.
    """
    known = parameter_names()
    groups: dict[str, dict[str, Any]] = {}
    for assignment in assignments:
        name, equals, text = _parted(assignment)
        if not equals:
            raise UsageError(f"--set {assignment}: write --set group.name=value")
        if name not in known:
            raise UsageError(f"--set {name}: unknown parameter{_meant(name, known)}")
        group, _, key = name.partition(".")
        if key in groups.setdefault(group, {}):
            raise UsageError(f"--set {name}: given twice")
        groups[group][key] = _value(name, text)
    found, problems = validated(Parameters, groups)
    if found is None:
        raise UsageError(
            "; ".join(f"--set {dotted(location)}: {_in_range(location, text)}" for location, text in problems)
        )
    return found


def _parted(assignment: str) -> tuple[str, str, str]:
    """Name, equals sign and value; what is longer than any of ours is refused before it is looked at."""
    name, equals, text = assignment.partition("=")
    name = name.strip()
    for what, part in (("name", name), ("value", text)):
        if len(part) > LONGEST:
            raise UsageError(f"--set {name:.40}: a {what} of {len(part)} characters; {LONGEST} are allowed")
    return name, equals, text


def _meant(name: str, known: Sequence[str]) -> str:
    """What a name may have been meant to be: one in the group that it has, or in the group nearest to what it has."""
    group, dot, key = name.partition(".")
    if not dot or group in Parameters.model_fields:
        return did_you_mean(name, known)
    keys_of = {each: list(field.annotation.model_fields) for each, field in Parameters.model_fields.items()}  # type: ignore[union-attr]
    groups = near_misses(group, keys_of)
    if not groups:
        return did_you_mean(name, known)
    nearest = groups[0]
    if near := near_misses(key, keys_of[nearest]):
        return did_you_mean(name, [f"{nearest}.{each}" for each in near])
    return f'; there is no group "{group}"; did you mean "{nearest}"?'


OF_THE_HOST = frozenset({"computation_delay_samples", "hold"})
"""Names in the group ``controller`` that say how any controller is run, also one of the user's own."""


def own_parameters(assignments: Iterable[str]) -> tuple[dict[str, float | int | bool | str], tuple[str, ...]]:
    """Split ``controller.NAME=value``, the parameters of a user's own controller, from the assignments that are not.

    Returns
    -------
    tuple of dict and tuple
        Values by name, a word where it is not JSON; the other assignments as they are.

    Raises
    ------
    UsageError
        When a name is given twice, or a value is not a number, a word or a switch.
    """
    own: dict[str, float | int | bool | str] = {}
    others = []
    for assignment in assignments:
        name, equals, text = _parted(assignment)
        group, _, key = name.partition(".")
        if not equals or group != "controller" or key in OF_THE_HOST:
            others.append(assignment)
            continue
        if key in own:
            raise UsageError(f"--set {name}: given twice")
        own[key] = _plain_value(name, text)
    return own, tuple(others)


def _plain_value(name: str, text: str) -> float | int | bool | str:
    try:
        value = json.loads(text, parse_constant=_refuse)
    except (ValueError, RecursionError):
        value = text.strip()
    if isinstance(value, float) and not math.isfinite(value):
        raise UsageError(f"--set {name}: {text} is not a number that can be used")
    if not isinstance(value, (bool, int, float, str)):
        raise UsageError(f"--set {name}: {text!r} is not a number, true, false or a word")
    return value


def _field(name: str) -> FieldInfo:
    group, _, key = name.partition(".")
    annotation: Any = Parameters.model_fields[group].annotation
    found: FieldInfo = annotation.model_fields[key]
    return found


def _takes_words(name: str) -> bool:
    return get_origin(_field(name).annotation) is Literal


def _value(name: str, text: str) -> Any:
    try:
        return json.loads(text, parse_constant=_refuse)
    except (ValueError, RecursionError):
        if _takes_words(name):
            return text.strip()
        raise UsageError(f"--set {name}: {text!r} is not a value; write a number, true, false, null or [..]") from None


def _refuse(constant: str) -> None:
    raise ValueError(f"{constant} is not a number that can be used")


def _in_range(location: Location, text: str) -> str:
    """A problem with the whole range of its parameter, where it is out of that."""
    beyond = _BEYOND.fullmatch(text)
    if beyond is None or len(location) < 2:
        return text
    ranges = ranges_of(_field(".".join(map(str, location[:2]))))
    low, high = ranges[location[-1] if len(ranges) > 1 and isinstance(location[-1], int) else 0]
    return f"{beyond[1]} {OUT_OF_RANGE}; {low:g} to {high:g} is allowed"
