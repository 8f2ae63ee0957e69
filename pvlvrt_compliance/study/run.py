"""Running tests: from a profile's test to a judged record."""

from collections.abc import Callable
from typing import NamedTuple

from pvlvrt_compliance.checks.evaluate import errored, evidence_of, judge_record
from pvlvrt_compliance.disturbance.found import Thresholds
from pvlvrt_compliance.disturbance.played import disturbance_played
from pvlvrt_compliance.errors import PvlvrtError
from pvlvrt_compliance.evidence.collect import normal_voltage
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile
from pvlvrt_compliance.results import TestResult
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.simulate import available_power_w, simulate
from pvlvrt_compliance.simulation.translate import nominal_of
from pvlvrt_compliance.study.instruments import instruments_for
from pvlvrt_compliance.study.memory import keep_freed_memory
from pvlvrt_compliance.waveforms import Waveforms

Simulator = Callable[[Scenario, Parameters], Waveforms]


class Judged(NamedTuple):
    """A test that has run."""

    result: TestResult
    waveforms: Waveforms | None  # None when the simulation gave none
    evidence: Evidence | None = None  # what the record was judged by; None where there is none


def run_test(profile: Profile, test: TestCase, parameters: Parameters, simulator: Simulator = simulate) -> Judged:
    """Simulate one test and judge its record.

    What goes wrong inside the simulation makes the verdicts `error`, with the reason; nothing is raised.
    """
    keep_freed_memory()
    try:
        waveforms = simulator(test.scenario, parameters)
        available_w = available_power_w(test.scenario, parameters)
    except (PvlvrtError, ArithmeticError) as error:
        return Judged(errored(profile, test, str(error)), None)
    nominal = nominal_of(parameters, test.scenario)
    thresholds = Thresholds(normal_voltage(profile.thresholds))
    played = disturbance_played(test.scenario, waveforms, nominal, thresholds)
    evidence = evidence_of(profile, test, waveforms, nominal, available_w, played, instruments_for(test))
    return Judged(judge_record(profile, test, evidence), waveforms, evidence)
