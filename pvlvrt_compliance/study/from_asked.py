"""From what somebody asks for to profiles, parameters and tests."""

import math
import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
from pvlvrt_compliance.data.search_path import is_path, known_profiles
from pvlvrt_compliance.errors import UsageError, spelled_of
from pvlvrt_compliance.profile.loading import load_profile
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.scenario.files import load_events
from pvlvrt_compliance.scenario.quantities import in_units_of
from pvlvrt_compliance.simulation.parameters import OUT_OF_RANGE, Parameters, own_parameters, parameters_from
from pvlvrt_compliance.study.own_sag import sag_tests
from pvlvrt_compliance.study.selection import Assignment

if TYPE_CHECKING:
    from pvlvrt_compliance.study.job import Asked

Spell = Callable[[str], str]
"""How whoever asks writes the name of a field of `Asked`: a message names what he has typed."""

ALL = "all"
"""In place of a name: every profile that ships or is found."""

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


def profiles_of(given: Sequence[str | Profile], spell: Spell) -> tuple[Profile, ...]:
    """Profiles that are asked for, loaded.

    Raises
    ------
    PvlvrtError
        When there is none, one cannot be used, or two have the same id.
    """
    if not any(given):
        known = ", ".join(known_profiles())
        raise UsageError(f"{spell('profiles')} is missing; known profiles: {known} ({spell('help')} has an example)")
    profiles = [name if isinstance(name, Profile) else load_profile(name, INSTALLED_KINDS) for name in _wanted(given)]
    for profile in profiles:
        if [other.id for other in profiles].count(profile.id) > 1:
            said = f"two profiles have the id {profile.id!r}; a report could not tell them apart"
            raise UsageError(f"{spell('profiles')}: {said}")
    return tuple(profiles)


def named_by_file(given: Sequence[str | Profile], profiles: Sequence[Profile]) -> dict[str, str]:
    """Files of the profiles that were asked for by theirs, by the profile's id."""
    named = zip(_wanted(given), profiles, strict=True)
    return {profile.id: name for name, profile in named if isinstance(name, str) and is_path(name)}


def _wanted(given: Sequence[str | Profile]) -> list[str | Profile]:
    """Each that is asked for once, in their order; a loaded one is only itself, for it may hold what has no hash."""
    wanted = [name for item in given for name in (known_profiles() if item == ALL else (item,))]
    return list({item if isinstance(item, str) else id(item): item for item in wanted}.values())


def parameters_of(asked: "Asked", spell: Spell) -> tuple[Parameters, dict[str, float | int | bool | str]]:
    """Parameters of plant and simulation with the bundled controller's, and those of the user's own."""
    try:
        own, others = own_parameters(asked.settings) if asked.controller is not None else ({}, tuple(asked.settings))
        if asked.fidelity is not None:
            others = (*others, f"simulation.fidelity={asked.fidelity}")
        parameters = parameters_from(others)
        if asked.controller is not None:
            alone = parameters.protection.of_a_plant_alone()
            parameters = parameters.model_copy(update={"protection": alone})
        return parameters, own
    except UsageError as error:
        text = str(error)
        if asked.allow_out_of_range and OUT_OF_RANGE in text:
            text += f"; {spell('allow_out_of_range')} is for the parameters of a controller of your own"
        if asked.fidelity is not None:
            text = text.replace("--set simulation.fidelity:", f"{spell('fidelity')}:")
        raise UsageError(_SET.sub(lambda set: f"{spelled_of(spell, 'settings', set[1])} {set[1]}", text)) from None


def tests_of(profiles: tuple[Profile, ...], asked: "Asked", spell: Spell) -> tuple[Assignment, ...]:
    """All tests of the profiles, or a sag of one's own in their place.

    Raises
    ------
    UsageError
        When a field of the scenario cannot be used.
    """
    overrides: dict[str, Any] = _given(asked, _OVERRIDES)
    if asked.events is not None:
        overrides["events"] = load_events(asked.events) if isinstance(asked.events, str) else tuple(asked.events)
    if asked.sag is not None:
        fields = overrides | _given(asked, ("point_on_wave", "irradiance"))
        return sag_tests(profiles, asked, asked.sag, fields, spell)
    return tuple(Assignment(profile, test) for profile in profiles for test in profile.tests(**overrides))


def _given(asked: "Asked", names: Sequence[str]) -> dict[str, float | str]:
    """Fields of the scenario that are given."""
    fields = {_SCENARIO[name]: in_units_of(_SCENARIO[name], getattr(asked, name)) for name in names}
    for name, value in fields.items():
        if isinstance(value, float) and not math.isfinite(value):
            raise UsageError(f"{name}: {value} is not a number that can be used")
    return {name: value for name, value in fields.items() if value is not None}


def spelled_field(field: str, spell: Spell) -> str:
    """A field of the scenario as whoever asks has written it; anything else as it is."""
    return next((spell(name) for name, of_scenario in _SCENARIO.items() if of_scenario == field), field)
