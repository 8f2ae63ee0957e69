"""What is to be run: what somebody asks for, checked and turned into tests and parameters.

Nothing is written or simulated here.
"""

import math
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
from pvlvrt_compliance.controllers.bundled import BUNDLED
from pvlvrt_compliance.data.search_path import is_path, known_profiles
from pvlvrt_compliance.errors import UsageError, spelled_of
from pvlvrt_compliance.profile.loading import load_profile
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results.baseline import TOLERANCE
from pvlvrt_compliance.scenario.events import Event
from pvlvrt_compliance.scenario.files import load_events
from pvlvrt_compliance.scenario.quantities import in_units_of
from pvlvrt_compliance.simulation.parameters import Parameters, own_parameters, parameters_from
from pvlvrt_compliance.study.baseline.applying import Held
from pvlvrt_compliance.study.baseline.reading import read_baseline
from pvlvrt_compliance.study.choosing import choose
from pvlvrt_compliance.study.own_sag import sag_tests
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.units import parse_fraction

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

_OF_PROFILES = ("tests", "skip", "last_failed", "failed_first")
"""Fields that select from the tests of profiles."""

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
_SET = re.compile(r"--set ([^\s:]*)")
"""How a message begins that is about a parameter."""

_OVERRIDES = ("frequency", "temperature", "scr", "xr", "transformer")


@dataclass(frozen=True, kw_only=True)
class Asked:
    """What somebody asks for, as he has given it; the command has an option for each.

    Parameters
    ----------
    profiles : sequence of str or Profile
        Names, files, `ALL`, or profiles that are loaded already.
    controller : str, class or function, optional
        A controller of one's own: its specification (``my_ctrl.py:MyController``), or in Python itself; `BUNDLED` is
        none, as without.
    mapping : str, optional
        File that ties its ports to the plant.
    sag : str or float, optional
        Depth of a sag of one's own (``90%`` or 0.9), in place of the profiles' tests.
    phases, two_phase, sag_type, duration, point_on_wave, irradiance : optional
        Of that sag: what `scenario.sag.Sag` and `Scenario` have; with units (``500ms``, ``90deg``, ``800W/m2``) or
        in s, degrees, W/m2.
    frequency, temperature, scr, xr, transformer : optional
        Of every test: ``50Hz`` or Hz, ``45C`` or degrees C, a ratio, a ratio, a vector group.
    events : str or sequence, optional
        What happens besides: a file, or the events.
    settings : sequence of str
        Parameters, ``controller.pr_integral_gain=0.2``.
    fidelity : str, optional
        Of the inverter.
    tests, skip : sequence of str
        Patterns of the ids of tests, or of their rows: those that are run, and those of them that are not.
    checks : sequence of str
        Names of the checks that are judged; without, all.
    last_failed, failed_first : bool
        Whether only tests are run that were not passed the last time, or whether these are run first.
    fail_fast : bool
        Whether the run ends at the first test that is not passed.
    include_long : bool
        Whether tests of half an hour are run.
    waveforms : str
        Which are kept, of `WAVEFORMS_KEPT`.
    baseline : str, optional
        File of known failures.
    baseline_tolerance : str or float, optional
        By what share a margin may be lost against it, ``1%`` or 0.01; by default `TOLERANCE`.
    """

    profiles: Sequence[str | Profile] = ()
    controller: str | Factory | None = None
    mapping: str | None = None
    sag: str | float | None = None
    phases: str | None = None
    two_phase: bool = False
    sag_type: str | None = None
    duration: str | float | None = None
    point_on_wave: str | float | None = None
    irradiance: str | float | None = None
    frequency: str | float | None = None
    temperature: str | float | None = None
    scr: str | float | None = None
    xr: str | float | None = None
    transformer: str | None = None
    events: str | Sequence[Event] | None = None
    settings: Sequence[str] = ()
    fidelity: str | None = None
    tests: Sequence[str] = ()
    skip: Sequence[str] = ()
    checks: Sequence[str] = ()
    last_failed: bool = False
    failed_first: bool = False
    fail_fast: bool = False
    include_long: bool = False
    waveforms: str = KEEP_ALL
    baseline: str | None = None
    baseline_tolerance: str | float | None = None


@dataclass(frozen=True, kw_only=True)
class Job:
    """What is to be run."""

    profiles: tuple[Profile, ...]
    tests: tuple[Assignment, ...]
    left_out: tuple[Assignment, ...] = ()  # long tests that nobody asked for
    not_selected: tuple[Assignment, ...] = ()  # all other tests of the profiles
    first: Collection[str] = ()  # keys of those that are run before the others
    checks: Sequence[str] = ()  # those that are judged; none: all
    fail_fast: bool = False  # whether the run ends at the first test that is not passed
    notes: Sequence[str] = ()  # what there is to know of the selection
    parameters: Parameters
    controller: str | Factory | None = None  # of the user's own
    given: Mapping[str, float | int | bool | str]  # its parameters, as far as they are set
    mapping: str | None = None  # file that ties its ports to the plant
    waveforms: str = KEEP_ALL
    profile_files: Mapping[str, str] = field(default_factory=dict)  # by id, as far as they were named by their file
    baseline: Held | None = None  # what is known, read before anything is run


def make_job(asked: Asked, spell: Spell = str, *, last_run: str | None = None) -> Job:
    """Check everything that can be checked before the first simulation.

    Parameters
    ----------
    asked : Asked
        What somebody asks for.
    spell : callable
        How a message names a field of it.
    last_run : str, optional
        Folder of the files of the last run, which says what was not passed then.

    Raises
    ------
    PvlvrtError
        When a profile, a value or the selection cannot be used.
    """
    if asked.controller == BUNDLED:
        asked = replace(asked, controller=None)
    _check_together(asked, spell)
    profiles = _profiles(asked.profiles, spell)
    parameters, given = _parameters(asked, spell)
    try:
        everything = _tests(profiles, asked, spell)
    except UsageError as error:
        field, colon, rest = str(error).partition(":")
        raise UsageError(_spelled_field(field, spell) + colon + rest) from None
    choice = choose(everything, profiles, asked, spell, last_run)
    if not choice.tests:
        names = ", ".join(profile.id for profile in profiles)
        raise UsageError(f"{names}: the profile has no tests of its own; give one, for instance {spell('sag')} 90%")
    return Job(
        profiles=profiles,
        tests=choice.tests,
        left_out=choice.left_out,
        not_selected=choice.not_selected,
        first=choice.first,
        checks=asked.checks,
        fail_fast=asked.fail_fast,
        notes=choice.notes,
        parameters=parameters,
        controller=asked.controller,
        given=given,
        mapping=asked.mapping,
        waveforms=asked.waveforms,
        profile_files=_named_by_file(asked.profiles, profiles),
        baseline=_baseline(asked, spell),
    )


def _check_together(asked: Asked, spell: Spell) -> None:
    """Refuse what does not go together, and what is none of a few words."""
    if asked.sag is None and any(_is_given(getattr(asked, name)) for name in _SAG_FIELDS):
        *others, last = map(spell, _SAG_FIELDS)
        raise UsageError(f"{', '.join(others)} and {last} need {spell('sag')}")
    if asked.sag is not None and (given := next((name for name in _OF_PROFILES if getattr(asked, name)), None)):
        own = "selects from the profile's own tests; it does not go with"
        raise UsageError(f"{spell(given)} {own} {spell('sag')}")
    if asked.mapping is not None and asked.controller is None:
        own = "is for the ports of a controller of your own; it needs"
        raise UsageError(f"{spell('mapping')} {own} {spell('controller')}")
    if asked.mapping is not None and not isinstance(asked.controller, str):
        raise UsageError(f"{spell('mapping')}: a Python class takes its measurements by their names, without a file")
    if asked.waveforms not in WAVEFORMS_KEPT:
        raise UsageError(f"{spell('waveforms')} {asked.waveforms}: allowed are {', '.join(WAVEFORMS_KEPT)}")


def _baseline(asked: Asked, spell: Spell) -> Held | None:
    if asked.baseline is None:
        if asked.baseline_tolerance is not None:
            raise UsageError(f"{spell('baseline_tolerance')} needs {spell('baseline')}")
        return None
    given = TOLERANCE if asked.baseline_tolerance is None else asked.baseline_tolerance
    tolerance = parse_fraction(str(given), spell("baseline_tolerance"))
    return Held(read_baseline(asked.baseline, spell("baseline")), tolerance)


def _is_given(value: object) -> bool:
    return value is not None and value is not False


def _spelled_field(field: str, spell: Spell) -> str:
    """A field of the scenario as whoever asks has written it; anything else as it is."""
    return next((spell(name) for name, of_scenario in _SCENARIO.items() if of_scenario == field), field)


def _profiles(given: Sequence[str | Profile], spell: Spell) -> tuple[Profile, ...]:
    if not any(given):
        known = ", ".join(known_profiles())
        raise UsageError(f"{spell('profiles')} is missing; known profiles: {known} ({spell('help')} has an example)")
    profiles = [name if isinstance(name, Profile) else load_profile(name, INSTALLED_KINDS) for name in _wanted(given)]
    for profile in profiles:
        if [other.id for other in profiles].count(profile.id) > 1:
            said = f"two profiles have the id {profile.id!r}; a report could not tell them apart"
            raise UsageError(f"{spell('profiles')}: {said}")
    return tuple(profiles)


def _named_by_file(given: Sequence[str | Profile], profiles: Sequence[Profile]) -> dict[str, str]:
    named = zip(_wanted(given), profiles, strict=True)
    return {profile.id: name for name, profile in named if isinstance(name, str) and is_path(name)}


def _wanted(given: Sequence[str | Profile]) -> list[str | Profile]:
    """Each that is asked for once, in their order; a loaded one is only itself, for it may hold what has no hash."""
    wanted = [name for item in given for name in (known_profiles() if item == ALL else (item,))]
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
        raise UsageError(_SET.sub(lambda set: f"{spelled_of(spell, 'settings', set[1])} {set[1]}", text)) from None


def _tests(profiles: tuple[Profile, ...], asked: Asked, spell: Spell) -> tuple[Assignment, ...]:
    overrides: dict[str, Any] = _given(asked, _OVERRIDES)
    if asked.events is not None:
        overrides["events"] = load_events(asked.events) if isinstance(asked.events, str) else tuple(asked.events)
    if asked.sag is not None:
        fields = overrides | _given(asked, ("point_on_wave", "irradiance"))
        return sag_tests(profiles, asked, asked.sag, fields, spell)
    return tuple(Assignment(profile, test) for profile in profiles for test in profile.tests(**overrides))


def _given(asked: Asked, names: Sequence[str]) -> dict[str, float | str]:
    """Fields of the scenario that are given."""
    fields = {_SCENARIO[name]: in_units_of(_SCENARIO[name], getattr(asked, name)) for name in names}
    for name, value in fields.items():
        if isinstance(value, float) and not math.isfinite(value):
            raise UsageError(f"{name}: {value} is not a number that can be used")
    return {name: value for name, value in fields.items() if value is not None}
