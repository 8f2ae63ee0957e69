"""What the user asked for, checked and turned into tests and parameters. Nothing is written or simulated here."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, get_args

from pydantic import ValidationError

from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
from pvlvrt_compliance.data.search_path import known_profiles
from pvlvrt_compliance.errors import UsageError, did_you_mean
from pvlvrt_compliance.profile.loading import load_profile
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.scenario.files import load_events
from pvlvrt_compliance.scenario.parameters import Parameters, own_parameters, parameters_from
from pvlvrt_compliance.scenario.sag import PAIRS, Sag, Type
from pvlvrt_compliance.study.selection import Assignment, keep_short, select
from pvlvrt_compliance.units import parse_duration, parse_fraction

# Options by the field of the scenario that they set: a message names what the user has typed.
_OPTIONS = {
    "frequency_hz": "--frequency",
    "cell_temperature_c": "--temperature",
    "scr": "--scr",
    "xr": "--xr",
    "vector_group": "--transformer",
    "events": "--events",
    "irradiance_w_m2": "--irradiance",
    "point_on_wave_deg": "--point-on-wave",
    "duration_s": "--duration",
}
ALL = "all"
"""In place of a name: every profile that ships or is found."""

KEEP_ALL, KEEP_FAILED = "all", "failed"
WAVEFORMS_KEPT = (KEEP_ALL, KEEP_FAILED, "none")

_PHASES = ("abc", "a", "b", "c", *PAIRS)
_TYPES = get_args(Type)


class SagRequest(NamedTuple):
    """The options that describe one sag, as typed."""

    depth: str
    phases: str | None
    two_phase: bool
    type: str | None
    duration: str | None
    point_on_wave_deg: float | None
    irradiance_w_m2: float | None


class Request(NamedTuple):
    """The whole command line."""

    profiles: tuple[str, ...]
    controller: str | None  # of the user's own
    mapping: str | None  # file that ties its ports to the plant
    sag: SagRequest | None
    overrides: dict[str, float | str | None]
    events: str | None
    assignments: tuple[str, ...]
    fidelity: str | None
    patterns: tuple[str, ...]
    include_long: bool
    output: str
    csv: bool
    waveforms: str
    allow_unjudged: bool
    exit_zero: bool
    quiet: bool
    command: tuple[str, ...]


class Job(NamedTuple):
    """What is to be run."""

    profiles: tuple[Profile, ...]
    tests: tuple[Assignment, ...]
    left_out: tuple[Assignment, ...]  # long tests that nobody asked for
    parameters: Parameters
    given: dict[str, float | int | bool | str]  # parameters of the user's own controller, as far as they are set


def prepare(request: Request) -> Job:
    """Check everything that can be checked before the first simulation.

    Raises
    ------
    PvlvrtError
        When a profile, an option or the selection cannot be used.
    """
    if request.waveforms not in WAVEFORMS_KEPT:
        raise UsageError(f"--waveforms {request.waveforms}: allowed are {', '.join(WAVEFORMS_KEPT)}")
    profiles = _profiles(request.profiles)
    parameters, given = _parameters(request)
    try:
        found = _tests(profiles, request)
    except UsageError as error:
        field, colon, rest = str(error).partition(":")
        raise UsageError(_OPTIONS.get(field, field) + colon + rest) from None
    tests = found if request.include_long else keep_short(found, request.patterns)
    if found and not tests:
        raise UsageError(f"all {len(found)} tests selected are long ones; they run with --include-long")
    if not tests:
        names = ", ".join(profile.id for profile in profiles)
        raise UsageError(f"{names}: the profile has no tests of its own; give one, for instance --sag 90%")
    return Job(profiles, tests, tuple(item for item in found if item not in tests), parameters, given)


def _profiles(names: Sequence[str]) -> tuple[Profile, ...]:
    known = known_profiles()
    if not any(names):
        raise UsageError(f"--profile is missing; known profiles: {', '.join(known)} (--help has an example)")
    wanted = [name for given in names for name in (known if given == ALL else (given,))]
    profiles = [load_profile(name, INSTALLED_KINDS) for name in dict.fromkeys(wanted)]
    for profile in profiles:
        if [other.id for other in profiles].count(profile.id) > 1:
            raise UsageError(f"--profile: two profiles have the id {profile.id!r}; a report could not tell them apart")
    return tuple(profiles)


def _parameters(request: Request) -> tuple[Parameters, dict[str, float | int | bool | str]]:
    """Parameters of plant and simulation with the bundled controller's, and those of the user's own."""
    own, others = own_parameters(request.assignments) if request.controller else ({}, request.assignments)
    if request.fidelity is None:
        return parameters_from(others), own
    try:
        return parameters_from((*others, f"simulation.fidelity={request.fidelity}")), own
    except UsageError as error:
        raise UsageError(str(error).replace("--set simulation.fidelity:", "--fidelity:")) from None


def _tests(profiles: tuple[Profile, ...], request: Request) -> tuple[Assignment, ...]:
    overrides: dict[str, Any] = _given(request.overrides)
    if request.events is not None:
        overrides["events"] = load_events(request.events)
    if request.sag is not None:
        return _sag_tests(profiles, request.sag, overrides)
    found = [Assignment(profile, test) for profile in profiles for test in profile.tests(**overrides)]
    return select(found, request.patterns)


def _given(fields: Mapping[str, float | str | None]) -> dict[str, float | str]:
    for name, value in fields.items():
        if isinstance(value, float) and not math.isfinite(value):
            raise UsageError(f"{name}: {value} is not a number that can be used")
    return {name: value for name, value in fields.items() if value is not None}


def _sag_tests(profiles: tuple[Profile, ...], asked: SagRequest, overrides: dict[str, Any]) -> tuple[Assignment, ...]:
    """One test, the same for every profile: as long as the most demanding of them asks for."""
    fields: dict[str, Any] = overrides | _given(
        {"point_on_wave_deg": asked.point_on_wave_deg, "irradiance_w_m2": asked.irradiance_w_m2}
    )
    sag = _sag(asked)
    if asked.duration is not None:
        duration_s = parse_duration(asked.duration, "--duration")
    else:
        duration_s = max(profile.sag_duration_s(sag) for profile in profiles)
    times = {
        "before_s": max(profile.procedure.before_s.value for profile in profiles),
        "after_s": max(profile.procedure.after_s.value for profile in profiles),
    }
    return tuple(Assignment(profile, profile.ad_hoc_test(sag, duration_s, **(times | fields))) for profile in profiles)


def _sag(asked: SagRequest) -> Sag:
    phases = ("bc" if asked.two_phase else "abc") if asked.phases is None else asked.phases
    if phases not in _PHASES:
        raise UsageError(f"--phases {phases}: unknown; allowed are {', '.join(_PHASES)}{did_you_mean(phases, _PHASES)}")
    if asked.type is not None and (asked.type not in _TYPES or asked.two_phase or len(phases) == 2):
        raise UsageError(
            f"--sag-type {asked.type}: allowed are {', '.join(_TYPES)}, with one phase or none, without --two-phase"
        )
    if asked.two_phase and phases not in PAIRS:
        raise UsageError(f"--two-phase: a pair of phases is needed, {', '.join(PAIRS)}; not {phases!r}")
    try:
        return Sag.model_validate(
            {
                "depth": parse_fraction(asked.depth, "--sag"),
                "phases": phases,
                "two_phase": asked.two_phase,
                "type": asked.type,
            }
        )
    except ValidationError as error:  # pragma: no cover - every field has been checked above
        raise UsageError(str(error)) from None
