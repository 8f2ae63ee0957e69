"""A profile and all that it includes as one table, knowing which file each part comes from."""

from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, NamedTuple

from pvlvrt_compliance.data.positions import Location
from pvlvrt_compliance.data.reader import Kind, Source
from pvlvrt_compliance.data.search_path import (
    SUFFIX,
    VARIABLE,
    find_profile,
    has_suffix,
    is_path,
    known_profiles,
    origin_of,
)
from pvlvrt_compliance.data.syntax import Table
from pvlvrt_compliance.errors import ProfileError, did_you_mean
from pvlvrt_compliance.ordinary_file import real

PROFILE = Kind("a profile", "profiles", ProfileError)


MOST_FILES = 64
"""Files that a profile may be made of, each as often as it is included: chosen, ten times what any ships with."""

OWN = frozenset({"edition", "jurisdiction", "applies_to", "address", "read_on"})
"""What a file says of its own text alone: an including one is of another, and says it again or leaves it open."""


_OUTSIDE = (
    "is outside of the folder of the file that includes it; put it there, or name its folder in"
    f" ${VARIABLE} and include it by its name"
)


class _Joined(NamedTuple):
    """A list of tables of which an including file's rows join the included ones."""

    key: str
    name: str  # key of a row that says which it is
    drop: str  # key of the patterns that leave included rows out
    one: str  # what a row is called
    example: str


_JOINED = (
    _Joined("tests", "id", "drop_tests", "test", "VD5*"),
    _Joined("not_covered", "what", "drop_not_covered", "entry", "flicker*"),
)
_LISTS = {each.key: each for each in _JOINED}


class Row(NamedTuple):
    """A row of such a list, with the files that say something of it and its place in each."""

    content: Any
    parts: tuple[tuple[Source, int], ...]

    def named(self, name: str) -> str | None:
        """What its key ``name`` says which row it is; None where it does not."""
        found = self.content.get(name) if isinstance(self.content, dict) else None
        return found if isinstance(found, str) else None


Rows = dict[str, tuple[Row, ...]]


class Merged(NamedTuple):
    """The files of a profile, deepest include first, and what they say together."""

    sources: tuple[Source, ...]
    head: Table  # everything but the lists whose rows join
    rows: Rows  # of each list, by its key
    problems: tuple[str, ...]

    @property
    def table(self) -> Table:
        """The resolved profile as one table."""
        lists = {key: [row.content for row in rows] for key, rows in self.rows.items() if rows}
        for_the_merge = {"include", *(each.drop for each in _JOINED)}
        return {key: value for key, value in self.head.items() if key not in for_the_merge} | lists

    def describe(self, location: Location, text: str) -> str:
        """A problem of the resolved profile, told at the file, line and key that it comes from."""
        source, place = self.said_by(location)
        return source.problem(place, text)

    def said_by(self, location: Location) -> tuple[Source, Location]:
        """The file that a part of the resolved profile comes from, and where it stands there."""
        return max(reversed(self._places(location)), key=lambda found: _depth(*_within(*found)))

    def _places(self, location: Location) -> list[tuple[Source, Location]]:
        """The same location as each file has it, the file that wins last."""
        match location:
            case (str(key), int(index), *rest) if index < len(self.rows.get(key, ())):
                return [(source, (key, own, *rest)) for source, own in self.rows[key][index].parts]
        return [(source, location) for source in self.sources]


def merge_file(
    path: Path, version: int, chain: tuple[Path, ...] = (), known: dict[Path, Merged] | None = None
) -> Merged:
    """Read a file and what it includes, each file once.

    Parameters
    ----------
    path : Path
    version : int
        The ``schema_version`` that each file must state.
    chain : tuple of Path
        The files that led here by their includes.
    known : dict, optional
        What has been read on the way, by its file; what is read is added.

    Raises
    ------
    ProfileError
        When a file cannot be read or is not TOML, an include leads nowhere or back, or there are too many of them.
    """
    known = {} if known is None else known
    source = Source(path, PROFILE, origin_of(path))
    here = real(path)
    merged = Merged((), {}, {}, ())
    for index, name in enumerate(_includes_of(source)):
        included = _included(name, source, index)
        resolved = real(included)
        if resolved in (*chain, here):
            raise source.refusal((("include", index), _loop((*chain, here), resolved)))
        too_deep = len(chain) + 1 >= MOST_FILES
        if not too_deep and resolved not in known:
            known[resolved] = merge_file(included, version, (*chain, here), known)
        if too_deep or len(merged.sources) + len(known[resolved].sources) >= MOST_FILES:
            many = f"leads to more than {MOST_FILES} files, each counted as often as it is included"
            raise source.refusal((("include", index), f"{name!r:.60} {many}"))
        merged = _joined(merged, known[resolved])
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
    """File of an include: a bare name beside the including file or known, a path in or below that file's folder."""
    if is_path(name) and not has_suffix(
        name
    ):  # whatever else others name is not opened: a problem shows keys of a file
        allowed = f"must be the name of a profile, or the path of one, which ends in {SUFFIX}"
        raise including.refusal((("include", index), f"{name!r:.60} {allowed}"))
    folder = including.path.parent
    beside = folder / (name if is_path(name) else f"{name}{SUFFIX}")
    try:
        if not _lies_in(beside, folder):
            raise including.refusal((("include", index), f"{name!r:.60} {_OUTSIDE}"))
        found = beside if beside.is_file() else None if is_path(name) else find_profile(name)
    except (OSError, ValueError):
        found = None
    if found is None:
        hint = did_you_mean(name, known_profiles())
        raise including.refusal((("include", index), f"there is no profile {name!r}{hint}"))
    return found


def _lies_in(file: Path, folder: Path) -> bool:
    """Whether a file lies in a folder or below it by its path and, a link's target, by its true place."""
    stays = file.is_relative_to(folder) and ".." not in file.relative_to(folder).parts
    return stays and (not file.is_file() or file.resolve().is_relative_to(folder.resolve()))


def _without_dropped(merged: Merged, source: Source, version: int) -> tuple[Merged, Merged]:
    """What a file includes without the rows that it drops and what is of the included text alone, and its own."""
    problems = list(_head_problems(source, version))
    kept, own = Rows(), Rows()
    for each in _JOINED:
        kept[each.key], wrong = _kept(merged.rows.get(each.key, ()), source, each)
        own[each.key], missing = _own_rows(source, each)
        problems += [*wrong, *missing]
    base = merged._replace(rows=kept, head={key: value for key, value in merged.head.items() if key not in OWN})
    head = {key: value for key, value in source.table.items() if key not in _LISTS}
    return base, Merged((source,), head, own, tuple(problems))


def _kept(rows: tuple[Row, ...], source: Source, each: _Joined) -> tuple[tuple[Row, ...], list[str]]:
    """The rows that a file does not drop, and what is wrong with its patterns."""
    dropped = source.table.get(each.drop, [])
    if not isinstance(dropped, list) or not all(isinstance(pattern, str) for pattern in dropped):
        return rows, [source.problem((each.drop,), f'must be a list of patterns: ["{each.example}"]')]
    problems = [
        source.problem((each.drop, index), f"{pattern!r} drops no {each.one} that is included")
        for index, pattern in enumerate(dropped)
        if not any(_fits(row, pattern, each) for row in rows)
    ]
    return tuple(row for row in rows if not any(_fits(row, pattern, each) for pattern in dropped)), problems


def _own_rows(source: Source, each: _Joined) -> tuple[tuple[Row, ...], list[str]]:
    """The rows of a file itself, and what is wrong with the list."""
    rows = source.table.get(each.key, [])
    if not isinstance(rows, list):
        text = f"must be a list of tables, [[{each.key}]], not {rows!r:.60}"
        return (), [source.problem((each.key,), text)]
    return tuple(Row(content, ((source, index),)) for index, content in enumerate(rows)), []


def _fits(row: Row, pattern: str, each: _Joined) -> bool:
    name = row.named(each.name)
    return name is not None and fnmatchcase(name, pattern)


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
        {
            each.key: _joined_rows(base.rows.get(each.key, ()), over.rows.get(each.key, ()), each.name)
            for each in _JOINED
        },
        tuple(dict.fromkeys(base.problems + over.problems)),
    )


def _joined_rows(base: tuple[Row, ...], over: tuple[Row, ...], name: str) -> tuple[Row, ...]:
    """Rows of the base, each overridden by the row of its name; all others follow. A name overrides once."""
    rows = list(base)
    places = {known: index for index, row in enumerate(base) if (known := row.named(name)) is not None}
    for row in over:
        index = places.pop(row.named(name) or "", None)
        if index is None:
            rows.append(row)
        else:
            rows[index] = Row(_merge(rows[index].content, row.content), rows[index].parts + row.parts)
    return tuple(rows)


def _merge(base: Table, over: Table) -> Table:
    both_tables = {k for k in base.keys() & over.keys() if isinstance(base[k], dict) and isinstance(over[k], dict)}
    return base | over | {key: _merge(base[key], over[key]) for key in both_tables}


def _within(source: Source, location: Location) -> tuple[Any, Location]:
    """What a location is of: a row of a list whose rows join, or the file."""
    match location:
        case (str(key), int(index), *rest) if key in _LISTS:
            return source.table[key][index], tuple(rest)
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
