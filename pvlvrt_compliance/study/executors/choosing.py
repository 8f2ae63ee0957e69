"""Where the tests of a job are run, by what was asked for and by what pays."""

import pickle
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from pvlvrt_compliance.controllers.process.cores import usable_cores
from pvlvrt_compliance.study.executors.executor import Executor
from pvlvrt_compliance.study.executors.here import Here
from pvlvrt_compliance.study.executors.processes import Processes
from pvlvrt_compliance.study.executors.units import Unit, cost_s
from pvlvrt_compliance.study.executors.worker import start_words
from pvlvrt_compliance.study.job import AUTO
from pvlvrt_compliance.study.work import Work

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator

PAYS_FROM_S = 30.0
"""Simulated time of all tests from which on processes pay.

A process takes as long to start as five seconds of a record take to be simulated and judged; in one process records are
made while others are judged, which is worth a third of the time (both measured). A profile is beyond it.
"""

EACH_S = 15.0
"""Simulated time that each process has at least, where nobody says how many there are to be: it takes 150 MB, too."""

_MAIN_MODULE = b"__main__"


class Chosen(NamedTuple):
    """What runs the tests, and what there is to say of it."""

    executor: Executor
    note: str = ""


def choose_executor(
    work: Work,
    units: Sequence[Unit],
    controller: "ForeignSimulator | None",
    tell: Callable[[str], None] = lambda _: None,
) -> Chosen:
    """What runs the units of a job.

    Parameters
    ----------
    work : Work
        Of its job, ``jobs`` says on how many cores, and ``cluster`` that it is run elsewhere.
    units : sequence of Unit
    controller : ForeignSimulator, optional
        The job's own, opened.
    tell : callable
        Told of what happens to workers of a cluster.
    """
    asked = work.job.jobs
    if work.job.cluster is not None:
        from pvlvrt_compliance.study.executors.cluster.executor import Cluster

        workers = usable_cores() if asked in (None, AUTO) else int(asked)
        return Chosen(Cluster(work.job.cluster, workers, controller, tell))
    if asked is None:
        return Chosen(Here(controller))
    cores = usable_cores() if asked == AUTO else int(asked)
    if cores == 1:
        return Chosen(Here(controller, is_ahead=False))
    why = _why_here(work, units, controller)
    if not why:
        worthwhile = int(sum(map(cost_s, units)) / EACH_S) if asked == AUTO else cores
        return Chosen(Processes(max(1, min(cores, len(units), worthwhile)), controller))
    note = f"{asked} processes were asked for, and the tests are run in this one: {why}"
    return Chosen(Here(controller), "" if asked == AUTO else note)


def _why_here(work: Work, units: Sequence[Unit], controller: "ForeignSimulator | None") -> str:
    """Why processes would not do, or not pay; empty where they do."""
    if len(units) == 1:
        return "they share a record, or the verdict on a row"
    if (cost := sum(map(cost_s, units))) < PAYS_FROM_S:
        return (
            f"{cost:.0f} s to be simulated are too little for processes to pay, which they do from {PAYS_FROM_S:g} s on"
        )
    if controller is not None and controller.stays_here:
        return controller.stays_here
    try:
        is_of_main = _MAIN_MODULE in start_words(work, controller)
    except (pickle.PicklingError, TypeError, AttributeError) as error:
        return f"something that was given exists in this process alone ({error})"
    return "something that was given is of the script that runs, which is not begun anew" if is_of_main else ""
