"""Tests that go on from where one of them has settled, in place of settling each for itself."""

from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING

from pvlvrt_compliance.errors import UsageError

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator
    from pvlvrt_compliance.study.job import Asked, Job
    from pvlvrt_compliance.study.run import Simulator


def settles_once(asked: "Asked", spell: Callable[[str], str]) -> bool:
    """Whether tests go on from settled states, as of `Asked`.

    Raises
    ------
    UsageError
        When it does not go with what else is asked for.
    """
    if asked.settle_once and asked.cluster is not None:
        said = "a settled state stays with the process that has it; it does not go with"
        raise UsageError(f"{spell('settle_once')}: {said} {spell('cluster')}")
    if asked.settle_once and asked.debug:
        said = "what is looked at by a debugger is run from its beginning; it does not go with"
        raise UsageError(f"{spell('settle_once')}: {said} {spell('debug')}")
    return asked.settle_once


def settling_notes(job: "Job", controller: "ForeignSimulator | None") -> Iterator[str]:
    """What is to be known of it before the first test."""
    if not job.settle_once:
        return
    sharing = {key: count for key, count in Counter(_keys(job, controller)).items() if count > 1}
    tests, states = sum(sharing.values()), len(sharing)
    if not sharing:
        yield "no two tests start from the same settled state: each settles for itself"
    else:
        yield f"{tests} scenarios start from {states} settled state{'s' * (states > 1)}, each to be simulated once"


def settling_simulator(job: "Job", controller: "ForeignSimulator | None") -> "Simulator":
    """What makes the records of a job, of which each is the same to the bit whichever way it is made."""
    from pvlvrt_compliance.simulation.simulate import simulate

    if not job.settle_once:
        return controller or simulate
    if controller is None:
        from pvlvrt_compliance.simulation.common_start import CommonStarts

        return partial(simulate, starts=CommonStarts(_keys(job, None)))
    from pvlvrt_compliance.controllers.settling import SettlesOnce

    def tell(said: str) -> None:
        controller.note([said])

    return partial(controller, settles=SettlesOnce(_keys(job, controller), tell))


def _keys(job: "Job", controller: "ForeignSimulator | None") -> Iterator[str]:
    """Keys of the scenarios that others may start as, one of each."""
    if controller is None:
        from pvlvrt_compliance.simulation.settled_run import start_of
    else:
        start_of = controller.start_of
    for scenario in dict.fromkeys(item.test.scenario for item in job.tests):
        if (start := start_of(scenario, job.parameters)) is not None:
            yield start.key
