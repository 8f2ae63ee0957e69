"""What runs the units of a job, wherever that is, and what comes back of it."""

from collections.abc import Generator, Mapping, Sequence
from typing import Any, NamedTuple, Protocol

from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.results import TestResult
from pvlvrt_compliance.study.executors.units import Begins, Unit
from pvlvrt_compliance.study.work import Work


class Finished(NamedTuple):
    """A test that is finished, as it comes from where it was run: small and plain, no profile and no record.

    Parameters
    ----------
    unit : int
        Number of its unit in what `Executor.run` was given.
    test : TestCase
        One of the unit's, or a further run of its row.
    result : TestResult
        With the id of its profile, which is one of the unit's.
    made : optional
        What `Work.each` has made of its record.
    notes : sequence of str
        What the user's own controller has said in this unit since the test before, each once a unit.
    files : mapping of str to bytes
        Records by their names in the output folder (``waveforms/x.cfg``), of a worker that does not share the folder
        that records are staged in; of one that does, they are there.
    is_reused : bool
        Whether the record is one of an earlier run (`reuse`).
    """

    unit: int
    test: TestCase
    result: TestResult
    made: Any = None
    notes: Sequence[str] = ()
    files: Mapping[str, bytes] = {}
    is_reused: bool = False


class Executor(Protocol):
    """Runs units.

    Whatever it is, the results are those of one core: the tests of a unit come in its order (`units.run_unit`). Units
    come as they are finished; where the job ends at its first failure (`Work.job.fail_fast`) they come in their
    order, nothing comes after the unit that has ended it, and that unit ends with the failure (`arranging`).
    """

    def run(self, work: Work, units: Sequence[Unit], begins: Begins) -> Generator[Finished, None, None]:
        """Run units.

        Parameters
        ----------
        work : Work
            What is done with each test.
        units : sequence of Unit
            As `units.units_of` gives them for the job: another process that has the job makes the same, so that the
            number of a unit is all that goes there.
        begins : callable
            Told of each test before it is run, in the process of the session.

        Yields
        ------
        Finished
            A test whose worker is lost twice is an `error` with the reason, as one that cannot be simulated.

        Raises
        ------
        PvlvrtError
            When a record cannot be kept, or the workers cannot be used at all.
        BaseException
            Whatever else has gone wrong where a test was run. However it ends (closed, interrupted), whatever it has
            started is gone then.
        """
        ...
