"""Profiles by name or from files, with all problems at once."""

import json
import stat
from pathlib import Path

from pydantic import ValidationError

from pvlvrt_compliance.errors import ProfileError, UsageError, did_you_mean
from pvlvrt_compliance.problems import problem_lines
from pvlvrt_compliance.profile.merging import Merged, merge_file
from pvlvrt_compliance.profile.profile import SCHEMA_VERSION, Profile
from pvlvrt_compliance.profile.search_path import find_profile, is_path, known_profiles, origin_of


def load_profile(name_or_path: str) -> Profile:
    """Read a profile and everything it includes.

    Tables merge key by key and the including file wins. A test with the id of an included one overrides it key by key,
    all others follow the included ones; ``drop_tests`` leaves included ones out.

    Parameters
    ----------
    name_or_path : str
        A name that `known_profiles` has, or a path: ends in ``.toml`` or has a path separator.

    Raises
    ------
    UsageError
        When no profile has that name; names the known ones.
    ProfileError
        When a file cannot be read or is not a valid profile; lists every problem with file, line and key.
    """
    path = profile_path(name_or_path)
    merged = merge_file(path)
    profile, problems = _validate(merged)
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
        mode = path.stat().st_mode
    except (OSError, ValueError):
        raise UsageError(f"no profile file at {text!r}; known profiles: {', '.join(known_profiles())}") from None
    if not stat.S_ISREG(mode):
        kind = "a folder" if stat.S_ISDIR(mode) else "not an ordinary file"
        raise UsageError(f"no profile file at {text!r}: it is {kind}")
    return path


def _validate(merged: Merged) -> tuple[Profile | None, list[str]]:
    """The profile, or None and its problems."""
    table = merged.table | {"schema_version": SCHEMA_VERSION}
    try:
        # Strict JSON mode is strict about numbers and texts, yet takes a list for a tuple.
        profile = Profile.model_validate_json(json.dumps(table, default=str), strict=True)
    except ValidationError as error:
        return None, [merged.describe(where, text) for where, text in problem_lines(error, Profile, table)]
    return profile, [merged.describe(where, text) for where, text in profile.inconsistencies()]
