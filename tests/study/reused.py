"""Records that are made up to be stored, and a controller that has not to be there."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from pvlvrt_compliance.controllers.description import Description
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.waveforms import Segment, Waveforms

SCENARIO = Scenario(sag=Sag(depth=0.5), duration_s=0.2)

DEFAULTS = Parameters()

RECORD = Waveforms((Segment(0.0, 1e-3, {"x": np.arange(4.0)}),))


@dataclass
class Controller:
    """What the key is told of a user's own controller, without one."""

    description: Description = field(
        default_factory=lambda: Description("ieee-cigre", "mine 1.0", "d" * 64, 1e-4, parameters=())
    )
    spec: str = "libctrl.so"
    given: dict[str, Any] = field(default_factory=lambda: {"gain": 1.0})
    said: tuple[str, ...] = ()

    def mapping(self):
        """Its mapping file."""
        return self.description.mapping

    def parameter_values(self):
        """Its parameters."""
        return {"gain": 1.0, "limit": 2.0} | self.given

    @property
    def last_notes(self):
        """What it has said in the last run."""
        return self.said

    def note(self, said):
        """Hear what it said in an earlier run."""
        self.heard = tuple(said)
