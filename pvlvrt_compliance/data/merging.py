"""A profile and all that it includes as one table, knowing which file each part comes from."""

from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, NamedTuple

from pvlvrt_compliance.data.positions import Location
from pvlvrt_compliance.data.reader import Kind, Source
from pvlvrt_compliance.data.search_path import SUFFIX, find_profile, is_path, known_profiles, origin_of
from pvlvrt_compliance.data.syntax import Table
from pvlvrt_compliance.errors import ProfileError, did_you_mean

PROFILE = Kind("a profile", "profiles", ProfileError)


class Row(NamedTuple):
    """A row of the test table, with the files that say something of it and its place in each."""

    content: Any
    parts: tuple[tuple[Source, int], ...]

    @property
    def id(self) -> Any:
        """Its id; None where it has none."""
        return self.content.get("id") if isinstance(self.content, dict) else None


class Merged(NamedTuple):
    """The files of a profile, deepest include first, and what they say together."""

    sources: tuple[Source, ...]
    head: Table  # everything but the test table
    rows: tuple[Row, ...]
    problems: tuple[str, ...]

    @property
    def table(self) -> Table:
        """The resolved profile as one table."""
        tests = {"tests": [row.content for row in self.rows]} if self.rows else {}
        return {key: value for key, value in self.head.items() if key not in {"include", "drop_tests"}} | tests

    def describe(self, location: Location, text: str) -> str:
        """A problem of the resolved profile, told at the file, line and key that it comes from."""
        source, place = max(reversed(self._places(location)), key=lambda found: _depth(*_within(*found)))
        return source.problem(place, text)

    def _places(self, location: Location) -> list[tuple[Source, Location]]:
        """The same location as each file has it, the file that wins last."""
        match location:
            case ("tests", int(index), *rest) if index < len(self.rows):
                return [(source, ("tests", own, *rest)) for source, own in self.rows[index].parts]
        return [(source, location) for source in self.sources]


def merge_file(path: Path, version: int, chain: tuple[Path, ...] = ()) -> Merged:
    """Read a file and what it includes.

    Parameters
    ----------
    path : Path
    version : int
        The ``schema_version`` that each file must state.
    chain : tuple of Path
        The files that led here by their includes.

    Raises
    ------
    ProfileError
        When a file cannot be read or is not TOML, or an include leads nowhere or back.
    """
    source = Source(path, PROFILE, origin_of(path))
    here = path.resolve()
    merged = Merged((), {}, (), ())
    for index, name in enumerate(_includes_of(source)):
        included = _included(name, source, index)
        if included.resolve() in (*chain, here):
            raise source.refusal((("include", index), _loop((*chain, here), included.resolve())))
        merged = _joined(merged, merge_file(included, version, (*chain, here)))
    return _joined(*_without_dropped(merged, source, version))


def _loop(chain: tuple[Path, ...], back: Path) -> str:
    way = " includes ".join(file.name for file in (*chain[chain.index(back) :], back))
    return f"files include one another without end: {way}"


def _includes_of(source: Source) -> list[str]:
    include = source.table.get("include", [])
    if not isinstance(include, list) or not all(isinstance(name, str) for name in include):
        raise source.refusal((("include",), "must be a list of names or paths"))
    return include


def _included(name: str, including: Source, index: int) -> Path:
    """File of an include: a bare name beside the including file or known, a path relative to the including file."""
    beside = including.path.parent / (name if is_path(name) else f"{name}{SUFFIX}")
    try:
        found = beside if beside.is_file() else None if is_path(name) else find_profile(name)
    except (OSError, ValueError):
        found = None
    if found is None:
        hint = did_you_mean(name, known_profiles())
        raise including.refusal((("include", index), f"there is no profile {name!r}{hint}"))
    return found


def _without_dropped(merged: Merged, source: Source, version: int) -> tuple[Merged, Merged]:
    """What a file includes without the rows that it drops, and what the file says itself."""
    problems = list(_head_problems(source, version))
    dropped = source.table.get("drop_tests", [])
    if not isinstance(dropped, list) or not all(isinstance(pattern, str) for pattern in dropped):
        problems.append(source.problem(("drop_tests",), 'must be a list of patterns: ["VD5*"]'))
        dropped = []
    for index, pattern in enumerate(dropped):
        if not any(_fits(row, pattern) for row in merged.rows):
            problems.append(source.problem(("drop_tests", index), f"{pattern!r} drops no test that is included"))
    kept = tuple(row for row in merged.rows if not any(_fits(row, pattern) for pattern in dropped))
    tests = source.table.get("tests", [])
    if not isinstance(tests, list):
        problems.append(source.problem(("tests",), f"must be a list of tables, [[tests]], not {tests!r:.60}"))
        tests = []
    rows = tuple(Row(content, ((source, index),)) for index, content in enumerate(tests))
    head = {key: value for key, value in source.table.items() if key != "tests"}
    return merged._replace(rows=kept), Merged((source,), head, rows, tuple(problems))


def _fits(row: Row, pattern: str) -> bool:
    return isinstance(row.id, str) and fnmatchcase(row.id, pattern)


def _head_problems(source: Source, version: int) -> Iterator[str]:
    """What each file must say for itself, since a merge would hide it."""
    stated = source.table.get("schema_version")
    reads = f"this version of the program reads {version}"
    if stated is None:
        yield source.problem(("schema_version",), f"missing; {reads}")
    elif isinstance(stated, bool) or stated != version:
        yield source.problem(("schema_version",), f"{stated!r:.60} is not known; {reads}")


def _joined(base: Merged, over: Merged) -> Merged:
    return Merged(
        base.sources + over.sources,
        _merge(base.head, over.head),
        _joined_rows(base.rows, over.rows),
        base.problems + over.problems,
    )


def _joined_rows(base: tuple[Row, ...], over: tuple[Row, ...]) -> tuple[Row, ...]:
    """Rows of the base, each overridden by the row of its id; all others follow. An id overrides once."""
    rows = list(base)
    places = {row.id: index for index, row in enumerate(base) if isinstance(row.id, str)}
    for row in over:
        index = places.pop(row.id, None) if isinstance(row.id, str) else None
        if index is None:
            rows.append(row)
        else:
            rows[index] = Row(_merge(rows[index].content, row.content), rows[index].parts + row.parts)
    return tuple(rows)


def _merge(base: Table, over: Table) -> Table:
    both_tables = {k for k in base.keys() & over.keys() if isinstance(base[k], dict) and isinstance(over[k], dict)}
    return base | over | {key: _merge(base[key], over[key]) for key in both_tables}


def _within(source: Source, location: Location) -> tuple[Any, Location]:
    """What a location is of: a row of the test table, or the file."""
    match location:
        case ("tests", int(index), *rest):
            return source.table["tests"][index], tuple(rest)
    return source.table, location


def _depth(content: Any, location: Location) -> int:
    """How many steps of a location a file decides: those that it has; all, once it has something that is no table."""
    for depth, part in enumerate(location):
        if not isinstance(content, dict):
            break
        if part not in content:
            return depth
        content = content[part]
    return len(location)
