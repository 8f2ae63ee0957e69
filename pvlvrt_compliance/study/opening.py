"""A job's controller, opened."""

from typing import TYPE_CHECKING

from pvlvrt_compliance.controllers.process.command import is_the_server
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.study.job import Given, Job

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator


def open_controller(job: Job) -> "ForeignSimulator | None":
    """Open the user's own controller, if there is one.

    Raises
    ------
    UsageError
        When it cannot be opened, does not command all phases, or its sample time does not fit; in the process of a
        controller, always.
    """
    if is_the_server():
        said = "a controller's file is imported to run it, and must not begin a run itself"
        raise UsageError(f'{said}; put what does under `if __name__ == "__main__":`')
    if job.controller is None:
        return None
    controller = _opened(job.controller, job)
    controller.check_commands()
    controller.provenance(job.parameters)
    return controller


def _opened(given: str | Given, job: Job) -> "ForeignSimulator":
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator

    if isinstance(given, str) and job.debug:
        from pvlvrt_compliance.controllers.in_process import Debugged

        return Debugged(given, job.given, job.mapping, allow_out_of_range=job.allow_out_of_range)
    if isinstance(given, str):
        return ForeignSimulator(
            given, job.given, job.mapping, parameters=job.parameters, allow_out_of_range=job.allow_out_of_range
        )
    from pvlvrt_compliance.controllers.here import SimulatorHere, spec_of

    if job.is_elsewhere and (spec := spec_of(given)):
        return ForeignSimulator(spec, job.given, parameters=job.parameters, allow_out_of_range=job.allow_out_of_range)
    return SimulatorHere(given, job.given, allow_out_of_range=job.allow_out_of_range)
