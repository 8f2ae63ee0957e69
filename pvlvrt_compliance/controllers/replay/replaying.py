"""A replay: what a controller gives to what was recorded, compared with what was expected of it."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from pvlvrt_compliance.controllers.description import Description, Value
from pvlvrt_compliance.controllers.endings import advice, end_in_words, with_said
from pvlvrt_compliance.controllers.given_parameters import beyond_their_ranges, beyond_words
from pvlvrt_compliance.controllers.limits import limits_of_opening, limits_of_run
from pvlvrt_compliance.controllers.mapping.file import load_mapping
from pvlvrt_compliance.controllers.process.answer import Due
from pvlvrt_compliance.controllers.process.isolation import do_apart
from pvlvrt_compliance.controllers.process.worker import DescribeJob, ReplayJob
from pvlvrt_compliance.controllers.replay.expecting import expectation
from pvlvrt_compliance.controllers.replay.feed import Feed
from pvlvrt_compliance.controllers.replay.feeding import fed, held_numbers, missing_words
from pvlvrt_compliance.controllers.replay.terminals import PYTHON, Terminal, terminals_of
from pvlvrt_compliance.controllers.replay.vectors import read_vectors
from pvlvrt_compliance.errors import UnfinishedError, UsageError
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.texts import one_line
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.agreement import Agreement
from pvlvrt_compliance.waveforms.container import Samples, Segment, unit_of

OUTSIDE_STATUS, UNUSABLE_STATUS = 1, 3
"""Exit statuses: an output differs by more than is allowed; one that is not compared is no number."""


class Asked(NamedTuple):
    """What is to be replayed, as it was typed."""

    spec: str
    inputs: str  # file
    expect: str | None = None  # file
    mapping: str | None = None  # file
    tolerances: Sequence[str] = ()
    held: Sequence[str] = ()
    allow_out_of_range: bool = False  # of the ranges that the controller states for its parameters


class Replay(NamedTuple):
    """What a replay has given.

    Parameters
    ----------
    title : str
        The controller: name, kind and specification.
    outputs : Segment
        Every output by its name, sample by sample, in the unit of its port.
    agreements : tuple of Agreement
        Of the outputs that something was expected of; empty: nothing was compared.
    notes : tuple of str
        What there is to know of it.
    """

    title: str
    outputs: Segment
    units: Mapping[str, str]
    agreements: tuple[Agreement, ...]
    notes: tuple[str, ...]

    @property
    def status(self) -> int:
        """Exit status: 0 when all is as expected."""
        if self.agreements:
            return 0 if all(each.is_inside for each in self.agreements) else OUTSIDE_STATUS
        return 0 if all(np.isfinite(column).all() for column in self.outputs.channels.values()) else UNUSABLE_STATUS


def replay(asked: Asked, given: Mapping[str, Value], parameters: Parameters) -> Replay:
    """Feed a file to a controller in a process of its own, and compare what it gives.

    Parameters
    ----------
    asked : Asked
    given : mapping
        Parameters of the controller, as far as they are set.
    parameters : Parameters
        Limits and rating; there is no plant.

    Raises
    ------
    UsageError
        When a file, an option or the controller cannot be used, or an input has no column.
    UnfinishedError
        When the controller fails, with the time, the reason and what it had printed.
    """
    expected, held = expectation(asked.expect, asked.tolerances), held_numbers(asked.held)
    vectors = read_vectors(Path(asked.inputs))
    description = _described(asked, given, parameters)
    # Of the rating of a plant, without the plant: what 1 pu is where a port is tied to a quantity.
    nominal = Nominal(1e3 * parameters.plant.apparent_power_kva, parameters.plant.phase_voltage_v)
    known = terminals_of(description, load_mapping(description.mapping), nominal)
    is_class = description.kind == PYTHON
    what = fed(vectors, known.inputs, held, description.sample_time_s, may_lack=is_class)
    if expected is not None and not is_class:  # whose further signals are known later alone
        expected.columns(known.outputs)
    done = _run(asked, given, parameters, description, what.feed, nominal, len(known.outputs))
    if done.missing:
        raise UsageError(missing_words(vectors, done.missing))
    outputs = (*known.outputs, *(Terminal(name, unit_of(name), name) for name in done.further))
    columns = {terminal.name: done.samples[:, k] for k, terminal in enumerate(outputs)}
    record = Segment(vectors.rows.t0_s, description.sample_time_s, columns)
    agreements, said = ((), ()) if expected is None else expected.compared(record, outputs)
    files = (vectors,) if expected is None or asked.expect == asked.inputs else (vectors, expected.vectors)
    others = [each.others([*known.inputs, *outputs]) for each in files]
    beyond = beyond_words(beyond_their_ranges(given, description.parameters)) if asked.allow_out_of_range else ""
    notes = (known.note, beyond, *what.notes, *others, *said, *_not_finite(record), *done.notes)
    return Replay(
        f"{one_line(description.name)} ({description.kind}), {asked.spec}",
        record,
        {t.name: t.unit for t in outputs},
        agreements,
        tuple(filter(None, notes)),
    )


def _described(asked: Asked, given: Mapping[str, Value], parameters: Parameters) -> Description:
    """What the controller says of itself; its ports need not be tied."""
    limits = limits_of_opening(parameters.simulation)
    ended = do_apart(
        DescribeJob(asked.spec, given, asked.mapping, allow_out_of_range=asked.allow_out_of_range, bare=True), limits
    )
    if ended.answer is not None and ended.answer.description is not None:
        return ended.answer.description
    why = f"{ended.reason}{advice(ended)}" if ended.answer is None else str(ended.answer.head.error)
    raise UsageError(f"{asked.spec}: {with_said(why, ended, limits)}")


class _Done(NamedTuple):
    """What the process of the controller has given."""

    samples: Samples
    further: tuple[str, ...]  # names of the last columns
    notes: tuple[str, ...]
    missing: tuple[str, ...]  # what a class has read that has no column


def _run(
    asked: Asked,
    given: Mapping[str, Value],
    parameters: Parameters,
    description: Description,
    feed: Feed,
    nominal: Nominal,
    outputs: int,
) -> _Done:
    limits = limits_of_run(parameters.simulation, feed.calls * feed.sample_time_s)
    job = ReplayJob(
        *(asked.spec, given, asked.mapping),
        allow_out_of_range=asked.allow_out_of_range,
        feed=feed,
        nominal=nominal,
        digest=description.digest,
    )
    ended = do_apart(job, limits, Due(feed.calls, outputs))
    if ended.answer is None:
        raise UnfinishedError(f"{asked.spec}: {with_said(end_in_words(ended), ended, limits)}")
    head, samples = ended.answer.head, ended.answer.samples
    if samples is None and not head.missing:
        raise UnfinishedError(f"{asked.spec}: {with_said(str(head.error), ended, limits)}")
    return _Done(np.empty((0, outputs)) if samples is None else samples, head.channels or (), head.notes, head.missing)


def _not_finite(record: Segment) -> list[str]:
    """Where outputs are no numbers, each with the first time."""
    found = []
    for name, column in record.channels.items():
        bad = np.flatnonzero(~np.isfinite(column))
        if len(bad):
            value = column[bad[0]]
            said = "not a number" if math.isnan(value) else f"{value:g}"
            at = record.t0_s + int(bad[0]) * record.dt_s
            found.append(f"{name} is {said} in {len(bad)} samples, first at {at:.9g} s (sample {bad[0]})")
    return found
