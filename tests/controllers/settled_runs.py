"""Runs of a controller that go on from settled states, beside whole ones."""

from pvlvrt_compliance.controllers.settling import SettlesOnce
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from same_records import are_the_same

DEFAULTS = Parameters()
SHORT = {"duration_s": 0.15, "after_s": 0.1, "before_s": 0.25}
SAGS = [Scenario(sag=Sag(depth=0.5, phases=phases), **SHORT) for phases in ("abc", "a", "bc")]


def settling(controller, scenarios, parameters=DEFAULTS):
    """What has its runs go on from settled states, and what it tells of that."""
    told: list[str] = []
    keys = [controller.start_of(scenario, parameters).key for scenario in scenarios]
    return SettlesOnce(keys, told.append), told


def both(controller, scenarios=SAGS, parameters=DEFAULTS):
    """Whether each record is that of one run; what is told."""
    settles, told = settling(controller, scenarios, parameters)
    records = [controller(scenario, parameters, settles) for scenario in scenarios]
    wholes = [controller(scenario, parameters) for scenario in scenarios]
    return [are_the_same(one, whole) for one, whole in zip(records, wholes, strict=True)], told
