"""Several profiles judge one run: each scenario is simulated once."""

from collections import Counter
from collections.abc import Iterable, Sequence

from pvlvrt_compliance.scenario.parameters import Parameters
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.study.run import Simulator
from pvlvrt_compliance.study.selection import Assignment
from pvlvrt_compliance.waveforms import Waveforms


def rows_of(assignments: Iterable[Assignment]) -> list[tuple[Assignment, ...]]:
    """Runs of the same row together, in the order in which they come; a test outside any table is a row of its own."""
    rows: dict[tuple[str, str], list[Assignment]] = {}
    for assignment in assignments:
        rows.setdefault((assignment.profile.id, assignment.test.row or assignment.test.id), []).append(assignment)
    return [tuple(row) for row in rows.values()]


def shared_together(rows: Sequence[tuple[Assignment, ...]]) -> list[tuple[Assignment, ...]]:
    """The rows in an order in which those that begin with the same scenario follow one another.

    The records that `SharedSimulator` keeps are then few.
    """
    first = [row[0].test.scenario for row in rows]
    place: dict[Scenario, int] = {}
    for index, scenario in enumerate(first):
        place.setdefault(scenario, index)
    return [rows[index] for index in sorted(range(len(rows)), key=lambda index: place[first[index]])]


class SharedSimulator:
    """A simulator that keeps a record for as long as another of the tests it was told of has the same scenario.

    Parameters
    ----------
    simulator : callable
        What makes the records.
    assignments : iterable of Assignment
        All tests that will be run.
    """

    def __init__(self, simulator: Simulator, assignments: Iterable[Assignment]) -> None:
        self._simulator = simulator
        self._wanted = Counter(assignment.test.scenario for assignment in assignments)
        self._kept: dict[Scenario, Waveforms] = {}

    def __call__(self, scenario: Scenario, parameters: Parameters) -> Waveforms:
        """The record of a scenario, simulated unless it is at hand; an error of the simulator is raised each time."""
        self._wanted[scenario] -= 1
        waveforms = self._kept.get(scenario)
        if waveforms is None:
            waveforms = self._simulator(scenario, parameters)
        if self._wanted[scenario] > 0:
            self._kept[scenario] = waveforms
        else:
            self._kept.pop(scenario, None)
        return waveforms
