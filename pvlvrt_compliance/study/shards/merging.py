"""Parts of a run as one: the job that they are of, and what runs it by taking what they have found."""

from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import fields, replace
from itertools import islice
from typing import Any, NamedTuple

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.ordinary_file import NotOrdinaryError, TooLargeError, content_of
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.results import TestResult, Verdict
from pvlvrt_compliance.results.files import FOLDER, RESULTS, WAVEFORMS
from pvlvrt_compliance.study.executors.executor import Finished
from pvlvrt_compliance.study.executors.units import Begins, Row, Unit
from pvlvrt_compliance.study.job import HOW, Asked, Job, make_job
from pvlvrt_compliance.study.provenance import created_at, provenance
from pvlvrt_compliance.study.selection import row_of_further
from pvlvrt_compliance.study.shards.part import Head, Part
from pvlvrt_compliance.study.work import Work
from pvlvrt_compliance.waveforms.recording import LARGEST_RECORD_BYTES

_OF_ONE_RUN = ("created", "command", "controller_notes", "files", "reuse", "settings")
"""Of the provenance: what may differ between parts, or is compared by itself."""

_OF_THE_PART = ("shard", "output", "exit_zero", "quiet", "verbose", "reuse", "reuse_size", *HOW)
"""Fields that each part may have given as it liked."""

_MOST_NAMED = 10  # of parts that are missing

_SHARD, _OUTPUT, _EXIT_ZERO, _FORMAT = "--shard", "--output", "--exit-zero", "--format"


class Whole(NamedTuple):
    """The run that parts are of."""

    job: Job
    command: tuple[str, ...]
    settings: Mapping[str, Any]
    others: dict[str, Any]  # what else was given, by field
    executor: "FromParts"
    controller: "Recorded | None"


class Recorded:
    """What stands for a controller that has run elsewhere (`ForeignSimulator`): what its parts have recorded of it."""

    def __init__(self, spec: str, recorded: Mapping[str, Any], notes: Sequence[str]) -> None:
        self.spec = spec
        self.notes: list[str] = list(notes)
        self._recorded = recorded

    def provenance(self, _parameters: Any) -> dict[str, Any]:
        """As of `ForeignSimulator`."""
        return {**self._recorded, "controller_notes": list(self.notes)}


class FromParts(NamedTuple):
    """Takes from parts what they have found (`Executor`); nothing is run."""

    parts: Sequence[Part]

    def run(self, work: Work, units: Sequence[Unit], begins: Begins) -> Generator[Finished, None, None]:
        """Give the tests of units, as of `Executor`.

        Raises
        ------
        UsageError
            When no part has a test, or a part has not come to its end.
        """
        del work, begins
        owners = {result.key: part for part in self.parts for result in part.results.tests}
        for number, unit in enumerate(units):
            for row in unit:
                yield from _of_row(number, row, owners)


def _of_row(number: int, row: Row, owners: Mapping[str, Part]) -> Iterator[Finished]:
    """The tests of a row in the order of its part, further runs among them."""
    for item in row:
        if item.key not in owners:
            raise UsageError(f"{item.key}: no part has run it")
    first, tests = row[0], {item.key: item.test for item in row}
    part = owners[first.key]
    for result in part.results.tests:
        if result.key in tests:
            yield _finished(number, tests[result.key], part, result)
        elif first.test.row and (result.profile, row_of_further(result.id)) == (first.profile.id, first.test.row):
            yield _finished(number, first.test.model_copy(update={"id": result.id}), part, result)


def _finished(number: int, test: TestCase, part: Part, result: TestResult) -> Finished:
    made = part.made.get(result.key)
    return Finished(number, test, _unmarked(result), made, files=_files(part, result.waveforms))


def _unmarked(result: TestResult) -> TestResult:
    """A result without what a baseline has made of it: the whole run is held against it again."""
    marks = {name: Verdict.model_fields[name].default for name in ("known", "known_reason", "worse")}
    return result.model_copy(update={"checks": tuple(check.model_copy(update=marks) for check in result.checks)})


def _files(part: Part, waveforms: str | None) -> dict[str, bytes]:
    """The record that a result names, and what lies beside it."""
    if waveforms is None:
        return {}
    record = part.folder / waveforms
    found = {}
    try:
        for path in sorted(path for path in record.parent.iterdir() if path.stem == record.stem):
            name = path.relative_to(part.folder).as_posix()
            found[name] = content_of(path, LARGEST_RECORD_BYTES, part.folder)
    except OSError as error:
        raise UsageError(f"{error.filename}: cannot be read: {error.strerror or error}") from None
    except TooLargeError:
        raise UsageError(f"{path}: larger than {LARGEST_RECORD_BYTES >> 20} MiB, which a record may have") from None
    except NotOrdinaryError as error:
        raise UsageError(f"{path}: {error}") from None
    return found


def whole_of(parts: Sequence[Part], output: str, formats: Sequence[str] = ()) -> Whole:
    """The run that parts are of.

    Parameters
    ----------
    parts : sequence of Part
    output : str
        Where its files are to go, for the command that is recorded.
    formats : sequence of str
        Names of those that are written besides what the parts were asked for.

    Raises
    ------
    UsageError
        When a part is missing or there twice, two are of different runs, or were made by something else than what
        would run here.
    """
    _refuse_incomplete(parts)
    first = parts[0]
    for part in parts[1:]:
        _refuse_others(first, part)
    for part in parts:
        _refuse_lost_records(part)
    given = {name: value for name, value in first.head.given.items() if name not in _OF_THE_PART}
    further = tuple(name for name in formats if name not in given.get("formats", ()))
    if further:
        given["formats"] = (*given.get("formats", ()), *further)
    names = {field.name for field in fields(Asked)}
    asked = Asked(**{name: value for name, value in given.items() if name in names})
    job = make_job(asked, _spell, is_simulated=False)
    recorded = _recorded(job, parts)
    _refuse_versions(job, first, recorded)
    return Whole(
        job=job if recorded is None else replace(job, controller=recorded.spec),
        command=(*_command(first.head, output), *(word for name in further for word in (_FORMAT, name))),
        settings=first.head.settings,
        others={name: value for name, value in given.items() if name not in names},
        executor=FromParts(parts),
        controller=recorded,
    )


def _spell(name: str) -> str:
    return f"--{name.replace('_', '-')}"


def _refuse_incomplete(parts: Sequence[Part]) -> None:
    count = parts[0].shard.count
    folders: dict[int, Part] = {}
    for part in parts:
        if part.shard.count != count:
            said = f"is part {part.head.shard}, and {parts[0].folder} is part {parts[0].head.shard}"
            raise UsageError(f"{part.folder}: {said}: they are not of one run")
        if (other := folders.get(part.shard.number)) is not None:
            raise UsageError(f"{part.folder}: is part {part.head.shard}, as {other.folder} is")
        if part.results.interrupted:
            raise UsageError(f"{part.folder}: part {part.head.shard} was interrupted; run it to its end")
        folders[part.shard.number] = part
    if more := count - len(folders):
        missing = (f"{number}/{count}" for number in range(1, count + 1) if number not in folders)
        named = ", ".join(islice(missing, _MOST_NAMED)) + f" and {more - _MOST_NAMED} others" * (more > _MOST_NAMED)
        raise UsageError(f"missing: {'part' if more == 1 else 'parts'} {named} of the run")


def _refuse_lost_records(part: Part) -> None:
    """Refuse a part whose results name records that are not in its folder of records, or not there at all."""
    folder = part.folder / WAVEFORMS
    there = {f"{WAVEFORMS}/{file.name}" for file in folder.iterdir()} if folder.is_dir() else set()
    for result in part.results.tests:
        if result.waveforms is not None and result.waveforms not in there:
            said = f"waveforms of {result.key}: there is no {result.waveforms!r} in {part.folder}"
            raise UsageError(f"{part.folder / RESULTS}: {said}")


def _refuse_others(first: Part, part: Part) -> None:
    """Refuse a part of another run."""
    for name, one, other in (
        ("options", _of_the_run(first.head.given), _of_the_run(part.head.given)),
        ("settings", first.head.settings, part.head.settings),
        ("record", _of_the_run(first.results.provenance), _of_the_run(part.results.provenance)),
    ):
        if found := _difference(one, other):
            key, own, theirs = found
            said = f"{name} {key}: {theirs!r} is not what {first.folder} has: {own!r}"
            raise UsageError(f"{part.folder}: {said}; parts of different runs are not merged")


def _refuse_versions(job: Job, part: Part, recorded: "Recorded | None") -> None:
    """Refuse parts that were made by something else than what is here."""
    own = recorded.provenance(job.parameters) if recorded else None
    here = _of_the_run(provenance(job.profiles, job.parameters, "", created_at(), own))
    there = _of_the_run(part.results.provenance)
    if found := _difference(there, here):
        key, was, now = found
        raise UsageError(f"{part.folder}: {key} was {was!r}, and is {now!r} here; merge it by what made it")


def _of_the_run(found: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in found.items() if name not in (*_OF_ONE_RUN, *_OF_THE_PART)}


def _difference(one: Mapping[str, Any], other: Mapping[str, Any]) -> tuple[str, Any, Any] | None:
    """The first name of which two have different values, within a mapping that of its entry, with both values."""
    for name in (*one, *other):
        own, theirs = one.get(name), other.get(name)
        if own == theirs:
            continue
        if isinstance(own, Mapping) and isinstance(theirs, Mapping) and (within := _difference(own, theirs)):
            return f"{name} {within[0]}", *within[1:]
        return name, own, theirs
    return None


def _recorded(job: Job, parts: Sequence[Part]) -> "Recorded | None":
    """What parts have recorded of the user's own controller, if there is one; their notes in the order of the parts."""
    if job.controller is None:
        return None
    found = {name: value for name, value in parts[0].results.provenance.items() if name in _of_controllers(parts[0])}
    notes = (note for part in parts for note in part.results.provenance.get("controller_notes", ()))
    return Recorded(str(job.controller), found, list(dict.fromkeys(notes)))


def _of_controllers(part: Part) -> list[str]:
    others = ("created", "command", "profile", "profile_digest", "files", "versions", "parameters", "settings", "reuse")
    return [name for name in part.results.provenance if name not in others]


def _command(head: Head, output: str) -> tuple[str, ...]:
    """The words of a part's command without what makes it a part, and with the folder of the whole."""
    words: list[str] = []
    given = iter(head.command)
    for word in given:
        name, equals, _ = word.partition("=")
        if name in (_SHARD, _OUTPUT) and not equals:
            next(given, None)
        if name == _OUTPUT and output != FOLDER:
            words += [f"{_OUTPUT}={output}"] if equals else [_OUTPUT, output]
        elif name not in (_SHARD, _OUTPUT, _EXIT_ZERO):
            words.append(word)
    return tuple(words)
