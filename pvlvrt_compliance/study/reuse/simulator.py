"""A simulator that simulates only what no earlier run has."""

from typing import TYPE_CHECKING

from pvlvrt_compliance.controllers.run import IGNORED_WORDS
from pvlvrt_compliance.errors import PvlvrtError
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.study.reuse.key import controller_parts, key_of, surroundings_digest
from pvlvrt_compliance.study.reuse.record_file import Kept
from pvlvrt_compliance.study.reuse.store import RecordStore
from pvlvrt_compliance.waveforms import Waveforms

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.simulator import ForeignSimulator
    from pvlvrt_compliance.study.run import Simulator


class ReusingSimulator:
    """Simulator that takes a record from a store, and gives it those that it has to simulate.

    What fails is not stored, nor is what the time that something took may have decided, nor a record of which anything
    has changed while it was made.

    Parameters
    ----------
    simulator : callable
        Makes records.
    controller : ForeignSimulator, optional
        The user's own, which is the simulator then; without, it is the bundled one.
    store : RecordStore
    """

    def __init__(self, simulator: "Simulator", controller: "ForeignSimulator | None", store: RecordStore) -> None:
        self._simulator = simulator
        self._controller = controller
        self._store = store
        self._surroundings = surroundings_digest()
        self._identity = controller_parts(controller)  # as it was opened: what verdicts of a run speak of

    def __call__(self, scenario: Scenario, parameters: Parameters) -> Waveforms:
        """The record of a scenario.

        Raises
        ------
        PvlvrtError
            As of the simulator.
        """
        key = key_of(scenario, parameters, self._identity, self._surroundings)
        kept = self._store.read(key)
        if kept is not None:
            if self._controller is not None:
                self._controller.note(kept.notes)
            return kept.waveforms
        waveforms = self._simulator(scenario, parameters)
        notes = tuple(self._controller.last_notes) if self._controller is not None else ()
        if self._is_repeatable(notes) and self._key_now(scenario, parameters) == key:
            self._store.write(key, Kept(waveforms, notes))
        return waveforms

    def _is_repeatable(self, notes: tuple[str, ...]) -> bool:
        """Whether a run says the same every time; what came of a fault after a trip may go by how long that took."""
        return not any(note.startswith(IGNORED_WORDS) for note in notes)

    def _key_now(self, scenario: Scenario, parameters: Parameters) -> str:
        try:
            return key_of(scenario, parameters, controller_parts(self._controller), self._surroundings)
        except PvlvrtError:  # of a mapping: the next run of the controller says so
            return ""
