"""Simulated records with their measurements, each made once."""

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import pytest

from pvlvrt_compliance.measure.quantities import MeasuredWindows
from pvlvrt_compliance.measure.summary import measure
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.simulation.translate import nominal_of
from pvlvrt_compliance.waveforms.container import Segment


class Record(NamedTuple):
    """A simulated run."""

    scenario: Scenario
    samples: Segment
    measured: MeasuredWindows


@pytest.fixture(scope="session")
def simulated() -> Callable[..., Record]:
    """Build ``simulated(depth, phases, two_phase, settings=("group.name=value", ...), **scenario) -> Record``."""

    @cache
    def make(
        depth: float = 0.9,
        phases: str = "abc",
        two_phase: bool = False,
        settings: tuple[str, ...] = (),
        duration_s: float = 0.309,
        **others: Any,
    ) -> Record:
        sag = Sag.model_validate({"depth": depth, "phases": phases, "two_phase": two_phase})
        scenario = Scenario(sag=sag, duration_s=duration_s, **others)
        parameters = parameters_from(settings)
        waveforms = simulate(scenario, parameters)
        measured = measure(waveforms, nominal_of(parameters, scenario), scenario.start_s, scenario.clear_s)
        return Record(scenario=scenario, samples=waveforms.segments[0], measured=measured)

    return make
