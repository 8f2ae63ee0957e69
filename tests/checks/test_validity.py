"""When a test counts at all: the start, the voltage without the inverter's current, the length of the record."""

import pytest

from pvlvrt_compliance.checks.evaluate import evaluate
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.waveforms.container import Waveforms


@pytest.mark.parametrize(
    ("p_kw", "counts"), [(451.0, True), (449.0, False), (549.0, True), (551.0, False), (0.0, False)]
)
def test_starting_condition(bench, p_kw, counts):
    """P before the sag must lie within 10 % of what the inverter was to start from."""
    result = bench(q_sag_kvar=250, p_before_kw=p_kw, p_after_kw=p_kw).result()
    assert (result.status is not Status.NOT_EVALUATED) == counts
    if not counts:
        assert {check.status for check in result.checks} == {Status.NOT_EVALUATED}
        assert all("P before the sag" in check.message for check in result.checks)


@pytest.mark.parametrize(("available_kw", "counts"), [(105, True), (600, False)])
def test_starting_power_is_the_lesser_of_available_and_rated(bench, available_kw, counts):
    """At little sun the array sets the power to start from; with plenty the rating does."""
    made = bench(q_sag_kvar=250, p_before_kw=105, p_after_kw=105, available_power_w=1e3 * available_kw)
    assert (made.result().status is Status.PASS) == counts


@pytest.mark.parametrize(("depth", "counts"), [(0.549, True), (0.551, False), (0.451, True), (0.449, False)])
def test_no_load_positive_sequence(bench, depth, counts):
    """A sag whose V+ misses what was asked by more than 0.05 pu is no test of anything."""
    result = bench(q_sag_kvar=250, no_load_sag=Sag(depth=depth)).result()
    assert (result.status is Status.PASS) == counts
    if not counts:
        assert {check.status for check in result.checks} == {Status.NOT_EVALUATED}
        assert "V+ without the inverter's current" in result.checks[0].message


def test_no_load_negative_sequence(bench):
    """V- is looked at too: two phases at 0.34 have V+ = 0.56 like all three at 0.56, but V- = 0.22."""
    asked, applied = Sag(depth=0.44), Sag(depth=0.66, phases="bc")
    result = bench(asked=asked, q_sag_kvar=250, no_load_sag=applied).result()
    assert "V- without the inverter's current was 0.220 pu" in result.checks[0].message


@pytest.mark.parametrize(("duration_s", "counts"), [(0.01, True), (0.05, False)])
def test_no_load_of_a_short_sag(bench, duration_s, counts):
    """A sag under one cycle cannot be checked and counts; one of a few cycles is checked without a window."""
    result = bench(duration_s=duration_s, p_sag_kw=10, no_load_sag=Sag(depth=0.3)).result()
    assert (result.status is not Status.NOT_EVALUATED) == counts


def test_record_that_ends_before_a_later_sag(bench):
    """A record that ends before the last step of the voltage is not evaluated: what it lacks could have failed."""
    again = {"kind": "sag", "t_s": 0.8, "duration_s": 0.1, "sag": Sag(depth=0.5)}
    made = bench(q_sag_kvar=250, scenario={"events": [again]})
    segment = made.waveforms().segments[0].slice(0.0, 1.0)
    result = evaluate(made.profile, made.test, Waveforms((segment,)), made.nominal, made.available_power_w)
    assert {check.status for check in result.checks} == {Status.NOT_EVALUATED}
    assert "before the voltage's step at 1.100 s" in result.checks[0].message
    slack = made.profile.thresholds.record_slack_s.model_copy(update={"value": made.test.scenario.end_s - 1.05})
    thresholds = made.profile.thresholds.model_copy(update={"record_slack_s": slack})
    profile = made.profile.model_copy(update={"thresholds": thresholds})
    result = evaluate(profile, made.test, Waveforms((segment,)), made.nominal, made.available_power_w)
    assert not any("step at 1.100 s" in check.message for check in result.checks)


def test_record_that_ends_in_the_sag(bench):
    """A record that ends before clearing is not evaluated."""
    made = bench(q_sag_kvar=250)
    whole = made.waveforms().segments[0]
    cut = Waveforms((whole.slice(0, 0.5),))
    result = evaluate(made.profile, made.test, cut, made.nominal, 500e3)
    assert {check.status for check in result.checks} == {Status.NOT_EVALUATED}


def test_breaker_open_before_the_sag(bench):
    """An inverter that was gone before the sag began shows nothing about the sag."""
    result = bench(q_sag_kvar=250, disconnected_after_s=-0.01).result()
    assert {check.status for check in result.checks} == {Status.NOT_EVALUATED}
    assert "before the sag began" in result.checks[0].message
