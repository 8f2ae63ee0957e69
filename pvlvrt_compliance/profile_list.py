"""What there is to say of each profile that can be named, kept from one process to the next.

Each has to be read and checked as a whole for it, which takes as long as all else that listing them does.
"""

import json
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from pvlvrt_compliance.cache import keep, look_up, named, sources
from pvlvrt_compliance.data.search_path import SUFFIX, Known, known_profiles

Entry = dict[str, Any]

_MADE_BY = (
    "profile_list.py",
    "data",
    "profile",
    "scenario",
    "checks/kinds.py",
    "errors.py",
    "units.py",
    "texts.py",
)
"""What decides an entry, beside the files."""


def listed_profiles() -> list[Entry]:
    """An entry a profile, for programs; keys are only added to. Of one that cannot be read, what is wrong with it.

    Raises
    ------
    UsageError
        As `known_profiles`.
    """
    known = known_profiles()
    name = _name_of(known)
    found = look_up(name) if name else None
    if found is not None:
        kept: list[Entry] = json.loads(found)
        return kept
    entries = [_entry(name, each) for name, each in known.items()]
    if name and all(_stays(entry, known) for entry in entries):
        keep(name, json.dumps(entries).encode())
    return entries


def _name_of(known: Mapping[str, Known]) -> str:
    """Name by all files of all folders: what one includes may lie beside it. Empty where one cannot be read."""
    places = [part for name, each in known.items() for part in (name, str(each.path), each.origin)]
    try:
        texts = [part for file in _files(known) for part in (str(file), file.read_bytes())]
        return named("profiles", *places, *texts, sources(*_MADE_BY), _pydantic())
    except OSError:
        return ""


def _files(known: Mapping[str, Known]) -> list[Path]:
    folders = dict.fromkeys(each.path.parent for each in known.values())
    return [file for folder in folders for file in sorted(folder.glob(f"*{SUFFIX}"))]


def _pydantic() -> bytes:
    """Which pydantic it is, in its own words; importing it, or asking the metadata, takes as long as the whole list."""
    found = find_spec("pydantic")
    return Path(found.origin).with_name("version.py").read_bytes() if found and found.origin else b""


def _stays(entry: Entry, known: Mapping[str, Known]) -> bool:
    """Whether nothing but what the name goes by can change an entry: no other file, and no check of another package."""
    from pvlvrt_compliance.data.merging import merge_file
    from pvlvrt_compliance.profile.profile import SCHEMA_VERSION
    from pvlvrt_compliance.profile.requirements import BUILT_IN

    if entry["problems"] or not set(entry["checks"]) <= set(BUILT_IN):
        return False
    read = {source.path.resolve() for source in merge_file(Path(entry["file"]), SCHEMA_VERSION).sources}
    return read <= {file.resolve() for file in _files(known)}


def _entry(name: str, known: Known) -> Entry:
    from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
    from pvlvrt_compliance.errors import ProfileError
    from pvlvrt_compliance.profile.loading import load_profile

    of_file = {"name": name, "origin": known.origin, "file": str(known.path)}
    try:
        profile = load_profile(str(known.path), INSTALLED_KINDS)
    except ProfileError as error:
        return {**of_file, "problems": list(error.problems)}
    cases = profile.tests()
    return {
        **of_file,
        "id": profile.id,
        "title": profile.title,
        "tests": len(cases),
        "frequencies_hz": sorted({case.scenario.nominal_frequency_hz for case in cases}),
        "checks": [kind for kind, _ in profile.requirements.by_kind()],
        "weakest": profile.weakest_mark,
        "digest": profile.digest,
        "problems": [],
    }
