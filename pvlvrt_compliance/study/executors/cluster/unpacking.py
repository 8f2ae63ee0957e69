"""A job that has arrived: its files in a folder of this machine, its controller opened."""

import pickle
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from pvlvrt_compliance.errors import PvlvrtError, UsageError
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.study.executors.cluster.luggage import Called, Luggage, unpack, with_recordings
from pvlvrt_compliance.study.executors.cluster.travelling import Travelling
from pvlvrt_compliance.study.executors.units import Unit, units_of
from pvlvrt_compliance.study.work import Work

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator
    from pvlvrt_compliance.study.run import Simulator


class RefusedError(Exception):
    """Why this process cannot do a job."""


class Unpacked:
    """A job in this process.

    Parameters
    ----------
    content : bytes
        Luggage, pickled: it comes from whoever may run whatever he likes here, by the same way as any task.

    Raises
    ------
    RefusedError
        When a file is not what was sent, or the controller is not what it was there.
    """

    def __init__(self, content: bytes) -> None:
        from pvlvrt_compliance.controllers.process.scratch import clear_abandoned, job_folder
        from pvlvrt_compliance.study.reuse.opening import simulator_for

        luggage: Luggage = pickle.loads(content)
        clear_abandoned()
        with ExitStack() as stack:
            self.folder = stack.enter_context(job_folder())
            try:
                unpack(luggage.files, self.folder)
            except (ValueError, OSError) as error:
                raise RefusedError(str(error)) from None
            self.work: Work = self._placed(pickle.loads(luggage.work))
            self.units: Sequence[Unit] = units_of(self.work.job.tests, self.work.job.first)
            own = luggage.controller
            places = {name: self.folder / place for name, place in luggage.recordings.items()}
            self.controller = _opened(own, self.folder, self.work.job.parameters) if own is not None else None
            self.simulator = _played_back(simulator_for(self.work.job, self.controller), places)
            self._stack = stack.pop_all()

    @property
    def staging(self) -> Path:
        """Where records are written, before they are sent."""
        return self.folder / "staging"

    def close(self) -> None:
        """Remove the folder."""
        self._stack.close()

    def _placed(self, work: Work) -> Work:
        """The work with records in a folder of this machine: its messages name where they cannot be written."""
        if work.keeping is None:
            return work
        return replace(work, keeping=replace(work.keeping, staging=self.staging, folder=self.staging))


def _played_back(simulator: "Simulator", places: Mapping[Called, Path]) -> "Simulator":
    """A simulator that reads recordings where they are here."""
    if not places:
        return simulator
    return lambda scenario, parameters: simulator(with_recordings(scenario, places), parameters)


def _opened(own: Travelling, folder: Path, parameters: Parameters) -> "ForeignSimulator":
    """The controller as it was sent, else as it is at the same place on this machine, if that is the same.

    Raises
    ------
    RefusedError
        When it is neither.
    """
    tries = [(str(folder / own.sent_spec), _under(folder, own.sent_mapping), str(folder))] if own.sent_spec else []
    if Path(own.beside).is_dir():
        tries.append((own.spec, own.mapping, own.beside))
    reasons = [f"it cannot be sent ({own.why_not})"] if own.why_not else []
    for spec, mapping, beside in tries:
        found = _tried(own, spec, mapping, beside, parameters)
        if not isinstance(found, str):
            return found
        reasons.append(f"{'as it was sent' if spec != own.spec else f'in {beside}'}: {found}")
    raise RefusedError(f"controller {own.spec}: {'; '.join(reasons) or f'there is no folder {own.beside}'}")


def _tried(
    own: Travelling, spec: str, mapping: str | None, beside: str, parameters: Parameters
) -> "ForeignSimulator | str":
    """The controller at a place, or why it is not usable."""
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator

    try:
        controller = ForeignSimulator(
            *(spec, own.given, mapping),
            beside=beside,
            parameters=parameters,
            allow_out_of_range=own.allow_out_of_range,
        )
    except UsageError as error:
        return str(error).removeprefix(f"--controller {spec}: ")
    except PvlvrtError as error:
        return str(error)
    found = controller.description.digest
    return controller if found == own.digest else f"its digest is {found[:12]} where {own.digest[:12]} is needed"


def _under(folder: Path, place: str) -> str | None:
    return str(folder / place) if place else None
