"""Profiles by name or from files, with all problems at once."""

from collections.abc import Callable
from pathlib import Path

from pvlvrt_compliance.data.merging import Merged, merge_file
from pvlvrt_compliance.data.models import validated
from pvlvrt_compliance.data.positions import Location
from pvlvrt_compliance.data.reader import Source
from pvlvrt_compliance.data.search_path import find_profile, is_path, known_profiles, origin_of
from pvlvrt_compliance.errors import ProfileError, UsageError, did_you_mean
from pvlvrt_compliance.ordinary_file import kind_of
from pvlvrt_compliance.profile.profile import SCHEMA_VERSION, Profile, profile_of
from pvlvrt_compliance.profile.requirements import BUILT_IN, Kinds
from pvlvrt_compliance.scenario.events import recordings_named


def load_profile(name_or_path: str, kinds: Kinds = BUILT_IN) -> Profile:
    """Read a profile and everything it includes.

    Tables merge key by key and the including file wins. A test with the id of an included one overrides it key by key,
    all others follow the included ones; ``drop_tests`` leaves included ones out.

    Parameters
    ----------
    name_or_path : str
        A name that `known_profiles` has, or a path: ends in ``.toml`` or has a path separator.
    kinds : mapping
        Kinds of requirements that it may have, with their models (`checks.kinds` knows those of other packages).

    Raises
    ------
    UsageError
        When no profile has that name; names the known ones.
    ProfileError
        When a file cannot be read or is not a valid profile; lists every problem with file, line and key.
    """
    path = profile_path(name_or_path)
    merged = merge_file(path, SCHEMA_VERSION)
    profile, problems = _validate(merged, profile_of(_named(merged, kinds)))
    problems = [*merged.problems, *problems]
    if problems or profile is None:
        raise ProfileError(origin_of(path), problems)
    return profile


def profile_path(name_or_path: str) -> Path:
    """File that a name or path stands for.

    Raises
    ------
    UsageError
        When there is none; names the known profiles.
    """
    if is_path(name_or_path):
        return _as_path(name_or_path)
    path = find_profile(name_or_path)
    if path is None:
        known = known_profiles()
        hint = did_you_mean(name_or_path, known)
        raise UsageError(f"unknown profile {name_or_path!r}{hint}; known: {', '.join(known)}")
    return path


def _as_path(text: str) -> Path:
    path = Path(text)
    try:
        kind = kind_of(path.stat().st_mode)
    except (OSError, ValueError):
        raise UsageError(f"no profile file at {text!r}; known profiles: {', '.join(known_profiles())}") from None
    if kind is not None:
        raise UsageError(f"no profile file at {text!r}: it is {kind}")
    return path


def _named(merged: Merged, kinds: Kinds) -> Kinds:
    """The built-in kinds, and of the others those that the profile names; where it names an unknown one, all."""
    demands = merged.table.get("requirements")
    named = [kind for kind in demands if kind not in BUILT_IN and kind != "custom"] if isinstance(demands, dict) else []
    if all(kind in kinds for kind in named):
        return {**BUILT_IN, **{kind: kinds[kind] for kind in named}}
    return {**kinds}


def _validate(merged: Merged, model: type[Profile]) -> tuple[Profile | None, list[str]]:
    """The profile, or None and its problems."""
    table = merged.table | {"schema_version": SCHEMA_VERSION}
    profile, problems = validated(model, table)
    if profile is not None:
        profile = _with_recordings_named(profile, merged)
        problems = profile.inconsistencies()
    return profile, [merged.describe(where, text) for where, text in problems]


def _with_recordings_named(profile: Profile, merged: Merged) -> Profile:
    """A profile whose recordings are named by the files that their rows come from."""
    rows = list(profile.rows)
    for index, row in enumerate(rows):
        if any(event.kind == "recording" for event in row.events):
            source, (*place, _) = merged.said_by(("tests", index, "events", 0))
            events = recordings_named(row.events, source.path.parent, _places(source, tuple(place)))
            rows[index] = row.model_copy(update={"events": events})
    return profile.model_copy(update={"rows": tuple(rows)})


def _places(source: Source, events: Location) -> Callable[[int], str]:
    return lambda index: source.problem((*events, index, "file"), "")
