"""What a worker is given of a job: all that it needs, as bytes with their digests, since it shares no disk with us."""

import hashlib
import pickle
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.scenario.events import Event, Recording
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.study.executors.cluster.identity import identity, kinds_of
from pvlvrt_compliance.study.executors.cluster.travelling import Travelling, travelling
from pvlvrt_compliance.study.work import Work

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator

_MAIN_MODULE = b"__main__"
_OF_COMTRADE = (".cfg", ".dat", ".hdr", ".inf")


class Packed(NamedTuple):
    """A file that travels."""

    place: str  # in the worker's folder
    content: bytes
    digest: str  # SHA-256 (hexadecimal)


@dataclass(frozen=True, kw_only=True)
class Luggage:
    """A job on its way.

    Parameters
    ----------
    work : bytes
        The job, pickled, with nothing in it that is of this process alone.
    files : tuple of Packed
        Of the controller, and recordings that are played back.
    controller : Travelling, optional
        The user's own.
    recordings : mapping
        Place of a recording by the name that scenarios have for it.
    """

    work: bytes
    files: tuple[Packed, ...]
    controller: Travelling | None
    recordings: Mapping[str, str]


class Parcel(NamedTuple):
    """Luggage as bytes, and what a worker must be to unpack it."""

    content: bytes
    digest: str  # SHA-256 (hexadecimal)
    kinds: tuple[str, ...]  # of checks that the job judges
    needed: Mapping[str, str]  # as of `identity`


def packed(work: Work, controller: "ForeignSimulator | None") -> Parcel:
    """A job as it is sent.

    Raises
    ------
    UsageError
        When something of it is of this process only, or a file cannot be read.
    """
    own = travelling(controller, work.job) if controller is not None else None
    recordings = {name: f"recordings/{k}/{Path(name).name}" for k, name in enumerate(_recordings(work))}
    files = [item for name, place in recordings.items() for item in _of_recording(Path(name), Path(place))]
    luggage = Luggage(
        work=_pickled(replace(work, job=replace(work.job, controller=own and own.spec))),
        files=tuple(_read(file, place) for place, file in (*files, *(own.files.items() if own else ()))),
        controller=own and own._replace(files={}),
        recordings=recordings,
    )
    content = pickle.dumps(luggage)
    kinds = kinds_of(work.job.profiles)
    return Parcel(content, digest_of(content), kinds, identity(kinds))


def digest_of(content: bytes) -> str:
    """SHA-256 (hexadecimal)."""
    return hashlib.sha256(content).hexdigest()


def with_recordings(scenario: Scenario, places: Mapping[str, Path]) -> Scenario:
    """A scenario whose recordings are played back from where they are here."""
    events = tuple(_with_recording(event, places) for event in scenario.events)
    return scenario.model_copy(update={"events": events})


def _pickled(work: Work) -> bytes:
    try:
        content = pickle.dumps(work)
    except (pickle.PicklingError, TypeError, AttributeError) as error:
        raise UsageError(f"something that was given cannot be sent to other machines: {error}") from None
    if _MAIN_MODULE in content:
        raise UsageError("something that was given is of the script that runs, and cannot be sent to other machines")
    return content


def _with_recording(event: Event, places: Mapping[str, Path]) -> Event:
    if not isinstance(event, Recording) or event.file not in places:
        return event
    return event.model_copy(update={"file": str(places[event.file])})


def _recordings(work: Work) -> list[str]:
    """Recordings of a job that can be read; of any other each test says what is wrong with it."""
    events = (event for item in work.job.tests for event in item.test.scenario.events)
    names = dict.fromkeys(event.file for event in events if isinstance(event, Recording))
    return [name for name in names if Path(name).is_file()]


def _of_recording(file: Path, place: Path) -> Iterator[tuple[str, Path]]:
    """A recording, and the other files of a COMTRADE file, by their places."""
    yield place.as_posix(), file
    if file.suffix.lower() in _OF_COMTRADE:
        for other in file.parent.iterdir():
            if other.stem == file.stem and other.suffix.lower() in _OF_COMTRADE and other.name != file.name:
                yield place.with_name(other.name).as_posix(), other


def _read(file: Path, place: str) -> Packed:
    try:
        content = file.read_bytes()
    except OSError as error:
        raise UsageError(f"{file} cannot be read: {error.strerror or error}") from None
    return Packed(place, content, digest_of(content))


def unpack(files: Iterable[Packed], folder: Path) -> None:
    """Put files into a folder.

    Raises
    ------
    ValueError
        When one is not what was sent.
    """
    for file in files:
        if digest_of(file.content) != file.digest:
            raise ValueError(f"{file.place} has not arrived as it was sent")
        place = folder / file.place
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(file.content)
