"""What the process of a controller answers, and how it is read: data of somebody else, to be checked, never objects.

A head in JSON (`ANSWER`) says which job it answers, and what; the record of a run lies beside it (`RECORD`), nothing
but its numbers, row by row, as little-endian float64. So does what it remembers at its end (`STATE`), where that is
asked for: bytes, which nobody reads but a later process of the same controller. All are ordinary files of a size that
is known or bounded; whatever else is found there is no answer.
"""

import json
import math
import os
import stat
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, TypeAdapter, ValidationError

from pvlvrt_compliance.controllers.channels import check_channel
from pvlvrt_compliance.controllers.description import Description
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.errors import SimulationError
from pvlvrt_compliance.simulation.columns import RECORDED
from pvlvrt_compliance.texts import all_printable

ANSWER, RECORD, STATE = "answer.json", "record.f64", "state.bin"
"""Files in the folder of a job."""

_NUMBER = np.dtype("<f8")
_LONGEST_HEAD = 16 << 20
"""Bytes: a controller of 10 000 ports, each described in a line, has a fifth of it."""

_LONGEST_TEXT = 4000  # characters of an error or a note
_LONGEST_END = 1000  # of it
_MOST_NOTES = 100
_MOST_CHANNELS = 10_000
_ROWS_AT_ONCE = 4096
_LARGEST_STATE = 256 << 20  # bytes: chosen, for a controller with all its tables has a hundredth of it

Text = Annotated[str, Field(max_length=_LONGEST_TEXT)]


class BadAnswerError(SimulationError):
    """What a process has left is no answer to its job."""

    def __init__(self, why: str) -> None:
        super().__init__(f"its answer cannot be used: {why}")


class Head(BaseModel):
    """Head of an answer: one of an error, of a description, of faults, or of a record with what goes with it."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    job: str
    error: Text | None = None
    faults: Annotated[tuple[Text, ...], Field(max_length=_MOST_NOTES)] | None = None  # of one that is only looked at
    description: dict[str, Any] | None = None
    channels: Annotated[tuple[str, ...], Field(max_length=_MOST_CHANNELS)] | None = None
    notes: Annotated[tuple[Text, ...], Field(max_length=_MOST_NOTES)] = ()
    tripped_at_s: FiniteFloat | None = None
    missing: Annotated[tuple[Text, ...], Field(max_length=_MOST_CHANNELS)] = ()  # what a replay was not given
    state_bytes: Annotated[int, Field(ge=0, le=_LARGEST_STATE)] | None = None
    stateless: Text = ""


class Due(NamedTuple):
    """What the record of a replay has: rows, and at least so many columns; further ones have names."""

    rows: int
    columns: int


class Answer(NamedTuple):
    """An answer that has been checked."""

    head: Head
    description: Description | None = None
    samples: NDArray[np.float64] | None = None
    state: bytes | None = None


def write_answer(
    folder: Path,
    job: str,
    answer: Mapping[str, Any],
    samples: NDArray[np.float64] | None = None,
    state: bytes | None = None,
) -> None:
    """Leave an answer: its record first, the head last and at once.

    Raises
    ------
    OSError
        When the head cannot be written.
    """
    if samples is not None:
        try:
            with (folder / RECORD).open("xb") as file:
                file.write(np.ascontiguousarray(samples, _NUMBER).data)
        except OSError as error:
            (folder / RECORD).unlink(missing_ok=True)  # room for the answer
            answer = {"error": f"{folder / RECORD} cannot be written: {error.strerror or error}"}
    bounded = dict(answer)
    if state is not None:
        bounded |= _put_state(folder / STATE, state)
    if "error" in bounded:
        bounded["error"] = _bounded(bounded["error"])
    if "stateless" in bounded:
        bounded["stateless"] = _bounded(bounded["stateless"])
    for key in ("faults", "notes"):
        if key in bounded:
            bounded[key] = [_bounded(text) for text in bounded[key][:_MOST_NOTES]]
    unfinished = folder / f"{ANSWER}.part"
    unfinished.write_text(json.dumps({"job": job, **all_printable(bounded)}), "utf-8")
    unfinished.replace(folder / ANSWER)


def read_answer(folder: Path, job: str, rows: int | Due | None) -> Answer | None:
    """Read the answer to a job; None where there is none.

    Parameters
    ----------
    folder : Path
        Of the job.
    job : str
        What was told to the process, and to no other.
    rows : int, Due or None
        Samples that the record of a run must have, or what that of a replay must; None where the controller was to be
        described.

    Raises
    ------
    BadAnswerError
        When what is there is anything else, with the reason.
    """
    data = _bytes_of(folder / ANSWER, None)
    if data is None:
        return None
    try:
        head = Head.model_validate_json(data)
    except ValidationError as error:
        raise BadAnswerError(_first_of(error)) from None
    if head.job != job:
        raise BadAnswerError("it is to another question")
    if head.error is not None:
        return Answer(head)
    if rows is None and head.faults is not None and head.description is None:
        return Answer(head)
    if rows is None:
        return Answer(head, description=_description(head.description))
    if isinstance(rows, Due):
        columns = rows.columns + len(_own(head.channels or ()))
        return Answer(head, samples=None if head.missing else _numbers(folder / RECORD, columns, rows.rows))
    samples = _samples(folder / RECORD, _channels(head.channels), rows)
    state = None if head.state_bytes is None else _bytes_of(folder / STATE, head.state_bytes)
    return Answer(head, samples=samples, state=None if state is None else bytes(state))


def _put_state(file: Path, state: bytes) -> dict[str, Any]:
    """Write what a run remembers; what the head says of it, also where that cannot be."""
    if len(state) > _LARGEST_STATE:
        return {"stateless": f"what it remembers takes {len(state)} bytes; {_LARGEST_STATE} are allowed"}
    try:
        file.write_bytes(state)
    except OSError as error:
        file.unlink(missing_ok=True)  # room for the answer
        return {"stateless": f"what it remembers cannot be written: {error.strerror or error}"}
    return {"state_bytes": len(state)}


def _bounded(text: str) -> str:
    """A text that is not too long; its end stays, where the reason most often stands."""
    if len(text) <= _LONGEST_TEXT:
        return text
    end = text[-_LONGEST_END:].lstrip()
    return f"{text[: _LONGEST_TEXT - len(end) - 5].rstrip()} ... {end}"


def _first_of(error: ValidationError) -> str:
    first = error.errors(include_url=False, include_input=False, include_context=False)[0]
    place = ".".join(map(str, first["loc"]))[:80]
    return f"{place}: {first['msg'][:200]}" if place else str(first["msg"])[:200]


_DESCRIPTION = TypeAdapter(Description)


def _description(data: dict[str, Any] | None) -> Description:
    try:
        found = _DESCRIPTION.validate_json(json.dumps(data), strict=True)
    except ValidationError as error:
        raise BadAnswerError(f"description.{_first_of(error)}") from None
    widths = [port.width for port in (*found.inputs, *found.outputs)]
    if not all(0 <= width <= _LONGEST_HEAD for width in widths) or not math.isfinite(found.sample_time_s):
        raise BadAnswerError("description: the width of a port, or the sample time, is not possible")
    return found


def _channels(names: tuple[str, ...] | None) -> tuple[str, ...]:
    """Names of the channels of a record: those that every one has, and the controller's own.

    Raises
    ------
    BadAnswerError
        When they are others.
    """
    if names is None or names[: len(RECORDED)] != RECORDED:
        raise BadAnswerError("channels: those that every record has are missing")
    _own(names[len(RECORDED) :])
    return names


def _own(own: tuple[str, ...]) -> tuple[str, ...]:
    """Names of the controller's own channels.

    Raises
    ------
    BadAnswerError
        When one is no name of a channel, or there twice.
    """
    try:
        for name in own:
            check_channel(name)
    except DoorError as error:
        raise BadAnswerError(f"channels: {_bounded(str(error))[:200]}") from None
    if len(set(own)) < len(own):
        raise BadAnswerError("channels: a name is there twice")
    return own


def _samples(file: Path, channels: tuple[str, ...], rows: int) -> NDArray[np.float64]:
    """Rows of a record; those of the plant are finite."""
    samples = _numbers(file, len(channels), rows)
    for first in range(0, rows, _ROWS_AT_ONCE):
        finite = np.isfinite(samples[first : first + _ROWS_AT_ONCE, : len(RECORDED)]).all(axis=0)
        if not finite.all():
            raise BadAnswerError(f"the record's {RECORDED[int(np.argmin(finite))]} is not finite")
    return samples


def _numbers(file: Path, columns: int, rows: int) -> NDArray[np.float64]:
    data = _bytes_of(file, rows * columns * _NUMBER.itemsize)
    if data is None:
        raise BadAnswerError("there is no record")
    return np.frombuffer(data, _NUMBER).reshape(rows, columns).astype(np.float64, copy=False)


def _bytes_of(file: Path, size: int | None) -> bytearray | None:
    """All of an ordinary file, which is to have a size where that is known; None where there is none.

    Raises
    ------
    BadAnswerError
        When it is no ordinary file, has another size, or cannot be read.
    """
    # Neither a link nor a pipe is followed or waited for: whoever may write here may put anything in its place.
    flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    try:
        descriptor = os.open(file, flags)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise BadAnswerError(f"{file.name} cannot be read ({error.strerror or error})") from None
    try:
        found = os.fstat(descriptor)
        if not stat.S_ISREG(found.st_mode):
            raise BadAnswerError(f"{file.name} is no ordinary file")
        if found.st_size > _LONGEST_HEAD if size is None else found.st_size != size:
            due = f"at most {_LONGEST_HEAD}" if size is None else str(size)
            raise BadAnswerError(f"{file.name} has {found.st_size} bytes; {due} are due")
        data = bytearray(found.st_size)
        with os.fdopen(descriptor, "rb", closefd=False) as stream:
            read = stream.readinto(data)
    except OSError as error:
        raise BadAnswerError(f"{file.name} cannot be read ({error.strerror or error})") from None
    finally:
        os.close(descriptor)
    if read != len(data):
        raise BadAnswerError(f"{file.name} ends too early")
    return data
