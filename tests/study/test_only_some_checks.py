"""A check says the same of a record whether others judge it, too, or not."""

from typing import NamedTuple

import pytest

from pvlvrt_compliance.checks.evaluate import evidence_of, judge_record
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.profile import TestCase, load_profile
from pvlvrt_compliance.results import Status, TestResult
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.simulate import available_power_w, simulate
from pvlvrt_compliance.simulation.translate import nominal_of

PROFILE = load_profile("iec61400-21")
KINDS = [kind for kind, _ in PROFILE.requirements.by_kind()]
TEST = next(test for test in PROFILE.tests() if test.id == "VD3-full-1")


class Record(NamedTuple):
    """A record of the test, and what all checks say of it."""

    evidence: Evidence
    test: TestCase
    whole: TestResult

    def by(self, *kinds):
        """What only these say of it."""
        return judge_record(PROFILE, self.test.model_copy(update={"only": kinds}), self.evidence)


def record_of(test, *settings):
    """Simulate a test."""
    parameters = parameters_from(settings)
    given = (nominal_of(parameters, test.scenario), available_power_w(test.scenario, parameters))
    evidence = evidence_of(PROFILE, test, simulate(test.scenario, parameters), *given)
    return Record(evidence, test, judge_record(PROFILE, test, evidence))


@pytest.fixture(scope="module")
def ridden_through():
    """The inverter stays connected."""
    return record_of(TEST)


@pytest.fixture(scope="module")
def tripped():
    """The inverter lets go where it must not."""
    return record_of(TEST, "protection.overcurrent_pu=1.1")


@pytest.mark.parametrize("kind", KINDS)
def test_the_verdict_of_a_check_does_not_depend_on_the_others(ridden_through, kind):
    """Alone it has every number and word that it has among all, and nothing else is judged or drawn."""
    alone = ridden_through.by(kind)
    assert alone.checks == tuple(check for check in ridden_through.whole.checks if check.check == kind)
    assert {each.check for each in alone.bands} <= {kind}


@pytest.mark.parametrize("kind", ["dc_ripple", "current_limit"])
def test_where_the_inverter_lets_go_that_is_judged_besides(tripped, kind):
    """What is asked for ends with the trip, and nobody is to take that for a pass."""
    whole = {check.check: check for check in tripped.whole.checks}
    assert whole["ride_through"].status is Status.FAIL
    alone = tripped.by(kind)
    assert alone.checks == (whole[kind], whole["ride_through"])
    assert alone.status is Status.FAIL


def test_what_does_not_apply_is_no_gap_in_what_was_judged():
    """A test in which no check asked for applies is `not_applicable`: others judge it in a whole run."""
    record = record_of(PROFILE.ad_hoc_test(TEST.scenario.sag.model_copy(update={"depth": 0.0}), 0.1))
    idle = [check.check for check in record.whole.checks if check.status is Status.NOT_APPLICABLE]
    assert idle
    alone = record.by(*idle)
    assert {alone.status, *alone.statuses} == {Status.NOT_APPLICABLE}
    assert record.whole.status is Status.PASS


def test_to_name_all_checks_is_to_name_none(ridden_through):
    """Nothing is judged otherwise."""
    assert ridden_through.by(*KINDS) == ridden_through.whole
