"""Several profiles judge one run: each scenario is simulated once."""

from collections import Counter, deque
from collections.abc import Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Self

from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.study.run import Simulator
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.waveforms import Waveforms


class SharedSimulator:
    """A simulator that makes one record a scenario, and the next while the one before is judged.

    A record is kept for as long as another of the tests it was told of has the same scenario. The compiled loop leaves
    Python alone while it runs, so that a thread is enough to use a second core.

    Parameters
    ----------
    simulator : callable
        What makes the records.
    assignments : iterable of Assignment
        All tests that will be run, in order.
    parameters : Parameters
        Of all runs.
    is_ahead : bool
        Whether a record is made before it is asked for.
    in_thread : bool
        Whether another thread makes the records; else that which asks for them does, none of them ahead.
    """

    def __init__(
        self,
        simulator: Simulator,
        assignments: Iterable[Assignment],
        parameters: Parameters,
        *,
        is_ahead: bool = True,
        in_thread: bool = True,
    ) -> None:
        scenarios = [assignment.test.scenario for assignment in assignments]
        self._simulator = simulator
        self._parameters = parameters
        self._is_ahead = is_ahead and in_thread
        self._in_thread = in_thread
        self._wanted = Counter(scenarios)
        self._to_come = deque(dict.fromkeys(scenarios))
        self._kept: dict[Scenario, Waveforms] = {}
        self._ahead: dict[Scenario, Future[Waveforms]] = {}
        self._pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="simulate")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._pool.shutdown(wait=False, cancel_futures=True)

    def __call__(self, scenario: Scenario, parameters: Parameters) -> Waveforms:
        """The record of a scenario, simulated unless it is at hand; an error of the simulator is raised each time."""
        self._wanted[scenario] -= 1
        waveforms = self._kept.get(scenario)
        if waveforms is None:
            waveforms = self._made(scenario, parameters)
        if self._wanted[scenario] > 0:
            self._kept[scenario] = waveforms
        else:
            self._kept.pop(scenario, None)
        self._begin_next(scenario)
        return waveforms

    def _made(self, scenario: Scenario, parameters: Parameters) -> Waveforms:
        if not self._in_thread:
            return self._simulator(scenario, parameters)
        # Always in the one thread: a simulator need not stand two runs at a time.
        ahead = self._ahead.pop(scenario, None) or self._pool.submit(self._simulator, scenario, parameters)
        return ahead.result()

    def _begin_next(self, done: Scenario) -> None:
        """Begin with the first scenario to come that nobody has begun with."""
        if done in self._to_come:
            self._to_come.remove(done)
        if self._is_ahead and self._to_come and not self._ahead:
            following = self._to_come.popleft()
            self._ahead[following] = self._pool.submit(self._simulator, following, self._parameters)
