"""What is to be run: what somebody asks for, checked and turned into tests and parameters.

Nothing is written or simulated here.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, get_args

from pydantic import ValidationError

from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
from pvlvrt_compliance.data.search_path import known_profiles
from pvlvrt_compliance.errors import UsageError, did_you_mean
from pvlvrt_compliance.profile.loading import load_profile
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.scenario.events import Event
from pvlvrt_compliance.scenario.files import load_events
from pvlvrt_compliance.scenario.sag import PAIRS, Sag, Type
from pvlvrt_compliance.simulation.parameters import Parameters, own_parameters, parameters_from
from pvlvrt_compliance.study.selection import Assignment, keep_short, select
from pvlvrt_compliance.units import parse_duration, parse_fraction

ALL = "all"
"""In place of a name: every profile that ships or is found."""

KEEP_ALL, KEEP_FAILED = "all", "failed"
WAVEFORMS_KEPT = (KEEP_ALL, KEEP_FAILED, "none")

Spell = Callable[[str], str]
"""How whoever asks writes the name of a field of `Asked`: a message names what he has typed."""

Factory = Callable[..., Any]
"""A controller's class, or a function that makes one."""

_SAG_FIELDS = ("phases", "two_phase", "sag_type", "duration", "point_on_wave", "irradiance")
"""Fields that describe a sag of one's own."""

# Fields of the scenario by the name that they have here.
_SCENARIO = {
    "frequency": "frequency_hz",
    "temperature": "cell_temperature_c",
    "scr": "scr",
    "xr": "xr",
    "transformer": "vector_group",
    "events": "events",
    "irradiance": "irradiance_w_m2",
    "point_on_wave": "point_on_wave_deg",
    "duration": "duration_s",
}
_OVERRIDES = ("frequency", "temperature", "scr", "xr", "transformer")

_PHASES = ("abc", "a", "b", "c", *PAIRS)
_TYPES = get_args(Type)


@dataclass(frozen=True, kw_only=True)
class Asked:
    """What somebody asks for, as he has given it; the command has an option for each.

    Parameters
    ----------
    profiles : sequence of str or Profile
        Names, files, `ALL`, or profiles that are loaded already.
    controller : str, class or function, optional
        A controller of one's own: its specification (``my_ctrl.py:MyController``), or in Python itself.
    mapping : str, optional
        File that ties its ports to the plant.
    sag : str or float, optional
        Depth of a sag of one's own (``90%`` or 0.9), in place of the profiles' tests.
    phases, two_phase, sag_type, duration, point_on_wave, irradiance : optional
        Of that sag: what `scenario.sag.Sag` and `Scenario` have; a duration is ``500ms``, ``0.5s`` or seconds.
    frequency, temperature, scr, xr, transformer : optional
        Of every test: Hz, degrees C, a ratio, a ratio, a vector group.
    events : str or sequence, optional
        What happens besides: a file, or the events.
    settings : sequence of str
        Parameters, ``controller.pr_integral_gain=0.2``.
    fidelity : str, optional
        Of the inverter.
    tests : sequence of str
        Patterns of the ids of tests.
    include_long : bool
        Whether tests of half an hour are run.
    waveforms : str
        Which are kept, of `WAVEFORMS_KEPT`.
    """

    profiles: Sequence[str | Profile] = ()
    controller: str | Factory | None = None
    mapping: str | None = None
    sag: str | float | None = None
    phases: str | None = None
    two_phase: bool = False
    sag_type: str | None = None
    duration: str | float | None = None
    point_on_wave: float | None = None
    irradiance: float | None = None
    frequency: float | None = None
    temperature: float | None = None
    scr: float | None = None
    xr: float | None = None
    transformer: str | None = None
    events: str | Sequence[Event] | None = None
    settings: Sequence[str] = ()
    fidelity: str | None = None
    tests: Sequence[str] = ()
    include_long: bool = False
    waveforms: str = KEEP_ALL


@dataclass(frozen=True, kw_only=True)
class Job:
    """What is to be run."""

    profiles: tuple[Profile, ...]
    tests: tuple[Assignment, ...]
    left_out: tuple[Assignment, ...] = ()  # long tests that nobody asked for
    parameters: Parameters
    controller: str | Factory | None = None  # of the user's own
    given: Mapping[str, float | int | bool | str]  # its parameters, as far as they are set
    mapping: str | None = None  # file that ties its ports to the plant
    waveforms: str = KEEP_ALL


def make_job(asked: Asked, spell: Spell = str) -> Job:
    """Check everything that can be checked before the first simulation.

    Parameters
    ----------
    asked : Asked
        What somebody asks for.
    spell : callable
        How a message names a field of it.

    Raises
    ------
    PvlvrtError
        When a profile, a value or the selection cannot be used.
    """
    _check_together(asked, spell)
    profiles = _profiles(asked.profiles, spell)
    parameters, given = _parameters(asked, spell)
    try:
        found = _tests(profiles, asked, spell)
    except UsageError as error:
        field, colon, rest = str(error).partition(":")
        raise UsageError(_spelled_field(field, spell) + colon + rest) from None
    tests = found if asked.include_long else keep_short(found, asked.tests)
    if found and not tests:
        raise UsageError(f"all {len(found)} tests selected are long ones; they run with {spell('include_long')}")
    if not tests:
        names = ", ".join(profile.id for profile in profiles)
        raise UsageError(f"{names}: the profile has no tests of its own; give one, for instance {spell('sag')} 90%")
    return Job(
        profiles=profiles,
        tests=tests,
        left_out=tuple(item for item in found if item not in tests),
        parameters=parameters,
        controller=asked.controller,
        given=given,
        mapping=asked.mapping,
        waveforms=asked.waveforms,
    )


def _check_together(asked: Asked, spell: Spell) -> None:
    """Refuse what does not go together, and what is none of a few words."""
    if asked.sag is None and any(_is_given(getattr(asked, name)) for name in _SAG_FIELDS):
        *others, last = map(spell, _SAG_FIELDS)
        raise UsageError(f"{', '.join(others)} and {last} need {spell('sag')}")
    if asked.sag is not None and asked.tests:
        own = "selects from the profile's own tests; it does not go with"
        raise UsageError(f"{spell('tests')} {own} {spell('sag')}")
    if asked.mapping is not None and asked.controller is None:
        own = "is for the ports of a controller of your own; it needs"
        raise UsageError(f"{spell('mapping')} {own} {spell('controller')}")
    if asked.mapping is not None and not isinstance(asked.controller, str):
        raise UsageError(f"{spell('mapping')}: a Python class takes its measurements by their names, without a file")
    if asked.waveforms not in WAVEFORMS_KEPT:
        raise UsageError(f"{spell('waveforms')} {asked.waveforms}: allowed are {', '.join(WAVEFORMS_KEPT)}")


def _is_given(value: object) -> bool:
    return value is not None and value is not False


def _spelled_field(field: str, spell: Spell) -> str:
    """A field of the scenario as whoever asks has written it; anything else as it is."""
    return next((spell(name) for name, of_scenario in _SCENARIO.items() if of_scenario == field), field)


def _profiles(given: Sequence[str | Profile], spell: Spell) -> tuple[Profile, ...]:
    if not any(given):
        known = ", ".join(known_profiles())
        raise UsageError(f"{spell('profiles')} is missing; known profiles: {known} ({spell('help')} has an example)")
    wanted = [name for item in given for name in (known_profiles() if item == ALL else (item,))]
    profiles = [
        name if isinstance(name, Profile) else load_profile(name, INSTALLED_KINDS) for name in _without_copies(wanted)
    ]
    for profile in profiles:
        if [other.id for other in profiles].count(profile.id) > 1:
            said = f"two profiles have the id {profile.id!r}; a report could not tell them apart"
            raise UsageError(f"{spell('profiles')}: {said}")
    return tuple(profiles)


def _without_copies(wanted: Sequence[str | Profile]) -> list[str | Profile]:
    """Each once, in their order; a loaded profile is only itself, for it may hold what has no hash."""
    return list({item if isinstance(item, str) else id(item): item for item in wanted}.values())


def _parameters(asked: Asked, spell: Spell) -> tuple[Parameters, dict[str, float | int | bool | str]]:
    """Parameters of plant and simulation with the bundled controller's, and those of the user's own."""
    try:
        own, others = own_parameters(asked.settings) if asked.controller is not None else ({}, tuple(asked.settings))
        if asked.fidelity is not None:
            others = (*others, f"simulation.fidelity={asked.fidelity}")
        return parameters_from(others), own
    except UsageError as error:
        text = str(error)
        if asked.fidelity is not None:
            text = text.replace("--set simulation.fidelity:", f"{spell('fidelity')}:")
        raise UsageError(text.replace("--set ", f"{spell('settings')} ")) from None


def _tests(profiles: tuple[Profile, ...], asked: Asked, spell: Spell) -> tuple[Assignment, ...]:
    overrides: dict[str, Any] = _given(asked, _OVERRIDES)
    if asked.events is not None:
        overrides["events"] = load_events(asked.events) if isinstance(asked.events, str) else tuple(asked.events)
    if asked.sag is not None:
        return _sag_tests(profiles, asked, asked.sag, overrides, spell)
    found = [Assignment(profile, test) for profile in profiles for test in profile.tests(**overrides)]
    return select(found, asked.tests, spell)


def _given(asked: Asked, names: Sequence[str]) -> dict[str, float | str]:
    """Fields of the scenario that are given."""
    fields = {_SCENARIO[name]: getattr(asked, name) for name in names}
    for name, value in fields.items():
        if isinstance(value, float) and not math.isfinite(value):
            raise UsageError(f"{name}: {value} is not a number that can be used")
    return {name: value for name, value in fields.items() if value is not None}


def _sag_tests(
    profiles: tuple[Profile, ...], asked: Asked, depth: str | float, overrides: dict[str, Any], spell: Spell
) -> tuple[Assignment, ...]:
    """One test, the same for every profile: as long as the most demanding of them asks for."""
    fields: dict[str, Any] = overrides | _given(asked, ("point_on_wave", "irradiance"))
    sag = _sag(asked, depth, spell)
    if asked.duration is not None:
        duration_s = parse_duration(_text(asked.duration, "s"), spell("duration"))
    else:
        duration_s = max(profile.sag_duration_s(sag) for profile in profiles)
    times = {
        "before_s": max(profile.procedure.before_s.value for profile in profiles),
        "after_s": max(profile.procedure.after_s.value for profile in profiles),
    }
    return tuple(Assignment(profile, profile.ad_hoc_test(sag, duration_s, **(times | fields))) for profile in profiles)


def _text(value: str | float, unit: str = "") -> str:
    """A value as the command takes it."""
    return value if isinstance(value, str) else f"{float(value)!r}{unit}"


def _sag(asked: Asked, depth: str | float, spell: Spell) -> Sag:
    two_phase = asked.two_phase
    phases = ("bc" if two_phase else "abc") if asked.phases is None else asked.phases
    if phases not in _PHASES:
        known = f"{', '.join(_PHASES)}{did_you_mean(phases, _PHASES)}"
        raise UsageError(f"{spell('phases')} {phases}: unknown; allowed are {known}")
    if asked.sag_type is not None and (asked.sag_type not in _TYPES or two_phase or len(phases) == 2):
        allowed = f"{', '.join(_TYPES)}, with one phase or none, without {spell('two_phase')}"
        raise UsageError(f"{spell('sag_type')} {asked.sag_type}: allowed are {allowed}")
    if two_phase and phases not in PAIRS:
        raise UsageError(f"{spell('two_phase')}: a pair of phases is needed, {', '.join(PAIRS)}; not {phases!r}")
    fields = {
        "depth": parse_fraction(_text(depth), spell("sag")),
        "phases": phases,
        "two_phase": two_phase,
        "type": asked.sag_type,
    }
    try:
        return Sag.model_validate(fields)
    except ValidationError as error:  # pragma: no cover - every field has been checked above
        raise UsageError(str(error)) from None
