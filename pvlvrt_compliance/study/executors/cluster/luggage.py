"""What a worker is given of a job: all that it needs, as bytes with their digests, since it shares no disk with us."""

import hashlib
import pickle
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.ordinary_file import NotOrdinaryError, TooLargeError, content_of
from pvlvrt_compliance.scenario.events import Event, Recording
from pvlvrt_compliance.scenario.recordings import Named
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.study.executors.cluster.identity import identity, kinds_of
from pvlvrt_compliance.study.executors.cluster.travelling import Travelling, travelling
from pvlvrt_compliance.study.played import recordings_of
from pvlvrt_compliance.study.work import Work
from pvlvrt_compliance.waveforms.playback import LARGEST_PLAYED_BYTES
from pvlvrt_compliance.waveforms.recording import LARGEST_RECORD_BYTES, files_of

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator

_MAIN_MODULE = b"__main__"


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
        Place of a recording by what scenarios call it, and by which file.
    """

    work: bytes
    files: tuple[Packed, ...]
    controller: Travelling | None
    recordings: "Mapping[Called, str]"


Called = tuple[str, Named | None]
"""What a scenario calls a recording, and the file that it is named by: others may have that name for another."""


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
    found = _recordings(work)
    recordings = {called: f"recordings/{k}/{file.name}" for k, (called, (file, _)) in enumerate(found.items())}
    files = [
        (other, place, LARGEST_PLAYED_BYTES, within)
        for called, (file, within) in found.items()
        for other, place in _of_recording(file, Path(recordings[called]))
    ]
    luggage = Luggage(
        work=_pickled(replace(work, job=replace(work.job, controller=own and own.spec))),
        files=(
            *(_read(*each) for each in files),
            *(_read(file, place) for place, file in (own.files.items() if own else ())),
        ),
        controller=own and own._replace(files={}),
        recordings=recordings,
    )
    content = pickle.dumps(luggage)
    kinds = kinds_of(work.job.profiles)
    return Parcel(content, digest_of(content), kinds, identity(kinds))


def digest_of(content: bytes) -> str:
    """SHA-256 (hexadecimal)."""
    return hashlib.sha256(content).hexdigest()


def with_recordings(scenario: Scenario, places: Mapping[Called, Path]) -> Scenario:
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


def _with_recording(event: Event, places: Mapping[Called, Path]) -> Event:
    if not isinstance(event, Recording) or _called(event) not in places:
        return event
    return event.moved_to(places[_called(event)])


def _called(event: Recording) -> Called:
    return event.file, event.named


def _recordings(work: Work) -> dict[Called, tuple[Path, Path | None]]:
    """Recordings of a job and the folders that they must lie in; each has been read when the job was made."""
    found = (event for item in work.job.tests for event in recordings_of(item.test.scenario))
    return {_called(event): event.located() for event in found}


def _of_recording(file: Path, place: Path) -> Iterator[tuple[Path, str]]:
    """The files of a recording by their places."""
    for each in files_of(file):
        yield each, place.with_name(each.name).as_posix()


def _read(file: Path, place: str, most_bytes: int = LARGEST_RECORD_BYTES, within: Path | None = None) -> Packed:
    try:
        content = content_of(file, most_bytes, within)
    except TooLargeError:
        raise UsageError(f"{file} is larger than {most_bytes >> 20} MiB") from None
    except NotOrdinaryError as error:
        raise UsageError(f"{file} {error}") from None
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
