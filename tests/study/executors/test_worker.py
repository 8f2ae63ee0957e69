"""What a worker's process does, in this one."""

import pytest

from pvlvrt_compliance.study.executors import worker
from pvlvrt_compliance.study.executors.executor import Finished
from pvlvrt_compliance.study.job import Asked, make_job
from pvlvrt_compliance.study.named import Named
from pvlvrt_compliance.study.work import Work


class NoMoreError(Exception):
    """No further number comes."""


class Numbers:
    """Numbers of units, as the command sends them."""

    def __init__(self, *numbers):
        self._numbers = list(numbers)

    def get(self):
        """The next."""
        if not self._numbers:
            raise NoMoreError
        return self._numbers.pop(0)


class UnsentError(Exception):
    """What cannot be put together again elsewhere."""

    def __init__(self, one, other):
        super().__init__(f"{one} and {other}")


def work(each=None):
    """One short sag."""
    return Work(job=make_job(Asked(profiles=("iec61400-21",), sag="50%", duration="50ms")), each=each)


def test_a_unit_is_told_from_its_beginning_to_its_end():
    """That its test is begun, what has come of it, and that it is over; nothing is run unasked."""
    said, asked = [], work()
    with pytest.raises(NoMoreError):
        worker._work(asked, None, Numbers(0), said.append)
    begun, finished, ended = said
    (item,) = asked.job.tests
    assert begun == worker.Begun(item.profile.id, item.test)
    assert isinstance(finished, Finished)
    assert finished.result.id == item.test.id
    assert ended == worker.UnitEnded(0, False)


def test_an_error_goes_out_with_its_place():
    """One of the program ends the work, as it is and with its lines; of one that cannot be sent its words go."""
    with pytest.raises(ZeroDivisionError) as raised:
        worker._work(work(Named("makings:failing")), None, Numbers(0), [].append)
    told = worker._failed(raised.value)
    assert isinstance(told.error, ZeroDivisionError)
    assert "makings.py" in told.trace
    told = worker._failed(UnsentError("this", "that"))
    assert (type(told.error), str(told.error)) == (RuntimeError, "UnsentError: this and that")
