"""The executor of a cluster (`executors.executor`)."""

from collections.abc import Callable, Generator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from pvlvrt_compliance.study.executors.arranging import Arranged
from pvlvrt_compliance.study.executors.cluster.connecting import connected, named
from pvlvrt_compliance.study.executors.cluster.dispatch import Dispatch
from pvlvrt_compliance.study.executors.cluster.luggage import packed
from pvlvrt_compliance.study.executors.executor import Finished
from pvlvrt_compliance.study.executors.units import Begins, Unit, items_of
from pvlvrt_compliance.study.work import Work

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator


class Cluster(NamedTuple):
    """Runs units on the workers of a dask scheduler (`Executor`).

    Parameters
    ----------
    address : str
        Of the scheduler, or `LOCAL`.
    workers : int
        How many are started, of `LOCAL`.
    controller : ForeignSimulator, optional
        The job's own, opened; each worker has one of its own by it.
    tell : callable
        Told of workers that are refused or lost.
    """

    address: str
    workers: int = 1
    controller: "ForeignSimulator | None" = None
    tell: Callable[[str], None] = lambda _: None

    def run(self, work: Work, units: Sequence[Unit], begins: Begins) -> Generator[Finished, None, None]:
        """Run units, as of `Executor`.

        Raises
        ------
        UsageError
            When the scheduler cannot be reached, the controller cannot be sent, or no worker can be used.
        LostError
            When the scheduler is gone, or all workers are.
        """
        parcel = packed(work, self.controller)

        def begins_unit(number: int) -> None:
            for item in items_of(units[number]):
                begins(item)

        with connected(self.address, min(self.workers, len(units))) as client:
            dispatch = Dispatch(
                client,
                parcel,
                Arranged(work, units),
                len(units),
                begins=begins_unit,
                tell=self.tell,
                named=named(self.address),
            )
            try:
                yield from dispatch.run()
            finally:
                dispatch.close()
