"""Which unit is run next where several are run at once, and in which order their tests are handed on."""

from collections.abc import Iterator, Sequence

from pvlvrt_compliance.checks.evaluate import errored
from pvlvrt_compliance.checks.rows import is_judged_as_one
from pvlvrt_compliance.study.executors.executor import Finished
from pvlvrt_compliance.study.executors.units import Unit, cost_s
from pvlvrt_compliance.study.work import Work

_TRIES = 2  # of a unit whose worker is lost


class Arranged:
    """The units of a job on their way through workers that may be lost.

    What takes longest is begun first, for the workers then end together, and tests are handed on as they come. Where
    the job ends at its first failure, units are begun and handed on in their order instead.

    Parameters
    ----------
    work : Work
    units : sequence of Unit
    """

    def __init__(self, work: Work, units: Sequence[Unit]) -> None:
        self._work = work
        self._units = units
        self._is_in_order = work.job.fail_fast
        numbers = range(len(units))
        self._to_begin = list(numbers if self._is_in_order else sorted(numbers, key=lambda n: -cost_s(units[n])))
        self._open = set(numbers)  # neither finished nor given up
        self._lost = dict.fromkeys(numbers, 0)
        self._seen: set[str] = set()  # keys of results
        self._held: dict[int, list[Finished]] = {}  # what comes before its turn, by unit
        self._end = len(units)  # the first unit that is of no account any more

    @property
    def is_done(self) -> bool:
        """Whether there is nothing to wait for."""
        return not any(number < self._end for number in self._open)

    @property
    def has_next(self) -> bool:
        """Whether there is a unit to begin with now."""
        return bool(self._to_begin) and self._to_begin[0] < self._end

    def next(self) -> int:
        """The unit to begin with, which is begun then."""
        return self._to_begin.pop(0)

    def finished(self, test: Finished) -> Iterator[Finished]:
        """Take a test; what can be handed on now."""
        if test.result.key not in self._seen:  # of a unit that is repeated
            self._seen.add(test.result.key)
            self._held.setdefault(test.unit, []).append(test)
        yield from self._due()

    def ended(self, number: int, is_end: bool = False) -> Iterator[Finished]:
        """Take the end of a unit, and whether it is that of the run; what can be handed on now."""
        self._open.discard(number)
        if is_end:
            self._end = min(self._end, number + 1)
        yield from self._due()

    def lost(self, number: int, reason: str) -> Iterator[Finished]:
        """Take the loss of the worker that had a unit, which is repeated once; what can be handed on now.

        Its tests that have no result then are an `error` with the reason.
        """
        self._lost[number] += 1
        if self._lost[number] < _TRIES:
            self._to_begin.insert(0, number)
            return
        is_end = False
        for row in self._units[number]:
            for item in row:
                if is_end and not is_judged_as_one(item.profile, item.test):
                    break
                result = errored(item.profile, item.test, reason)
                is_end = is_end or (result.key not in self._seen and self._work.ends_with(result))
                yield from self.finished(Finished(number, item.test, result))
            if is_end:
                break
        yield from self.ended(number, is_end)

    def _due(self) -> Iterator[Finished]:
        first = min(self._open, default=len(self._units))
        for number in sorted(self._held):
            if number < self._end and (number <= first or not self._is_in_order):
                yield from self._held.pop(number)
