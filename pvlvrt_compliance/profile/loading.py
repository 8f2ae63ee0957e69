"""Profiles from TOML files: look-up by name, includes, and all problems of a file at once."""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from pvlvrt_compliance.errors import ProfileError, UsageError, did_you_mean
from pvlvrt_compliance.profile.problems import Location, dotted, problem_lines
from pvlvrt_compliance.profile.profile import SCHEMA_VERSION, Profile
from pvlvrt_compliance.resources import resource_folder

LARGEST_FILE_BYTES = 1 << 20
_SUFFIX = ".toml"

Table = dict[str, Any]
Source = tuple[Path, Table]


def known_profiles() -> tuple[str, ...]:
    """Names of the profiles that ship with the package, sorted."""
    return tuple(sorted(file.stem for file in resource_folder("profiles").glob(f"*{_SUFFIX}")))


def load_profile(name_or_path: str) -> Profile:
    """Read a profile and everything it includes.

    Tables merge key by key and the including file wins; the test tables follow one another, included ones first.

    Parameters
    ----------
    name_or_path : str
        The name of a profile that ships with the package, or a path: ends in ``.toml`` or has a path separator.

    Raises
    ------
    UsageError
        When no profile has that name; names the known ones.
    ProfileError
        When a file cannot be read or is not a valid profile; lists every problem.
    """
    path = _as_path(name_or_path) if _is_path(name_or_path) else _shipped(name_or_path)
    sources = list(_with_includes(path, chain=()))
    problems = [problem for file, table in sources for problem in _head_problems(file, table, path)]
    profile, more = _validate(_merge_all(sources), sources, path)
    if problems or more or profile is None:
        raise ProfileError(_origin(path), problems + more)
    return profile


def _is_path(text: str) -> bool:
    return text.endswith(_SUFFIX) or "/" in text or "\\" in text


def _as_path(text: str) -> Path:
    path = Path(text)
    try:
        found = path.is_file()
    except (OSError, ValueError):
        found = False
    if not found:
        raise UsageError(f"no profile file at {text!r}; shipped profiles: {', '.join(known_profiles())}")
    return path


def _shipped(name: str) -> Path:
    known = known_profiles()
    if name not in known:
        raise UsageError(f"unknown profile {name!r}{did_you_mean(name, known)}; known: {', '.join(known)}")
    return resource_folder("profiles") / f"{name}{_SUFFIX}"


def _origin(path: Path) -> str:
    """The file as a reader knows it: shipped ones by folder and name, others as written."""
    shipped = path.parent == resource_folder("profiles")
    return f"profiles/{path.name}" if shipped else str(path)


def _read(path: Path) -> Table:
    """One file as a table.

    Raises
    ------
    ProfileError
        When it is too large, cannot be read, is not UTF-8, or is not TOML (with line and column).
    """
    try:
        with path.open("rb") as file:
            content = file.read(LARGEST_FILE_BYTES + 1)
    except OSError as error:
        raise ProfileError(_origin(path), [f"cannot be read: {error.strerror}"]) from None
    if len(content) > LARGEST_FILE_BYTES:
        raise ProfileError(_origin(path), ["larger than 1 MiB; a profile is a few kilobytes"])
    try:
        return tomllib.loads(content.decode("utf-8"))
    except UnicodeDecodeError as error:
        raise ProfileError(_origin(path), [f"not UTF-8 text: byte {error.start} cannot be decoded"]) from None
    except RecursionError:
        raise ProfileError(_origin(path), ["not TOML: nested too deeply"]) from None
    except ValueError as error:
        raise ProfileError(_origin(path), [f"not TOML: {error}"]) from None


def _with_includes(path: Path, chain: tuple[Path, ...]) -> Iterator[Source]:
    """The file's includes, deepest first, then the file itself: the order in which they are merged."""
    here = path.resolve()
    if here in chain:
        loop = " includes ".join(file.name for file in (*chain[chain.index(here) :], here))
        raise ProfileError(_origin(path), [f"include: files include one another without end: {loop}"])
    table = _read(path)
    for name in _includes_of(table, path):
        yield from _with_includes(_included(name, path), (*chain, here))
    yield path, table


def _includes_of(table: Table, path: Path) -> list[str]:
    include = table.get("include", [])
    if not isinstance(include, list) or not all(isinstance(name, str) for name in include):
        raise ProfileError(_origin(path), ["include: must be a list of names or paths of profiles"])
    return include


def _included(name: str, including: Path) -> Path:
    """File of an include: a bare name beside the including file or shipped, a path relative to the including file."""
    places = [including.parent / name]
    if not _is_path(name):
        places = [including.parent / f"{name}{_SUFFIX}", resource_folder("profiles") / f"{name}{_SUFFIX}"]
    for place in places:
        if place.is_file():
            return place
    hint = did_you_mean(name, known_profiles())
    raise ProfileError(_origin(including), [f"include: there is no profile {name!r}{hint}"])


def _head_problems(file: Path, table: Table, root: Path) -> Iterator[str]:
    """What each file must say for itself, since a merge would hide it."""
    place = "" if file == root else f"{_origin(file)}: "
    version = table.get("schema_version")
    if version is None:
        yield f"{place}schema_version: missing; this version of the program reads {SCHEMA_VERSION}"
    elif isinstance(version, bool) or version != SCHEMA_VERSION:
        yield f"{place}schema_version: {version!r} is not known; this version of the program reads {SCHEMA_VERSION}"


def _merge_all(sources: list[Source]) -> Table:
    merged: Table = {}
    for _, table in sources:
        tests = _as_list(merged.get("tests")) + _as_list(table.get("tests"))
        merged = _merge(merged, table) | ({"tests": tests} if tests else {})
    merged.pop("include", None)
    return merged | {"schema_version": SCHEMA_VERSION}


def _as_list(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [] if value is None else [value]


def _merge(base: Table, over: Table) -> Table:
    both_tables = {k for k in base.keys() & over.keys() if isinstance(base[k], dict) and isinstance(over[k], dict)}
    return base | over | {key: _merge(base[key], over[key]) for key in both_tables}


def _validate(table: Table, sources: list[Source], root: Path) -> tuple[Profile | None, list[str]]:
    """The profile, or None and its problems."""
    try:
        # Strict JSON mode is strict about numbers and texts, yet takes a list for a tuple.
        profile = Profile.model_validate_json(json.dumps(table, default=str), strict=True)
    except ValidationError as error:
        return None, [_located(where, text, sources, root) for where, text in problem_lines(error, Profile)]
    return profile, profile.inconsistencies()


def _located(location: Location, text: str, sources: list[Source], root: Path) -> str:
    """A problem with its key, and with its file where that is not the one the user named."""
    file = max(reversed(sources), key=lambda source: _depth(source[1], location))[0]
    place = "" if file == root or location[0] == "tests" else f"{_origin(file)}: "
    return f"{place}{dotted(location)}: {text}"


def _depth(table: Any, location: Location) -> int:
    """How many steps of a location a table has."""
    depth = 0
    for part in location:
        if not isinstance(table, dict) or part not in table:
            break
        table, depth = table[part], depth + 1
    return depth
