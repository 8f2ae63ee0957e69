"""When a test counts at all: the start, the voltage without the inverter's current, the length of the record."""

import pytest

from pvlvrt_compliance.checks.evaluate import evaluate
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.study.run import run_test
from pvlvrt_compliance.waveforms.container import Segment, Waveforms


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


def judged_with(made, tripped_at_s=None, **channels):
    """Result of a bench's record in which some channels are others."""
    segment = made.waveforms().segments[0]
    record = Waveforms(
        (Segment(segment.t0_s, segment.dt_s, {**segment.channels, **channels}),), tripped_at_s=tripped_at_s
    )
    return evaluate(made.profile, made.test, record, made.nominal, made.available_power_w)


@pytest.mark.parametrize(
    ("from_s", "tripped_at_s", "message"),
    [
        (0.0, -0.98, "tripped at -0.980 s by the over-current relay of the plant, before the record"),
        (0.0, None, "tripped by the over-current relay of the plant, before the record"),
        (0.2, None, "tripped at 0.200 s by the over-current relay of the plant, before the sag began"),
        (0.2, 0.2, "tripped at 0.200 s by the over-current relay of the plant, before the sag began"),
    ],
)
def test_trip_before_the_sag_is_told_with_its_relay(bench, from_s, tripped_at_s, message):
    """A test that a relay has ended before it began says which and when, not that there was no power."""
    made = bench(q_sag_kvar=250, disconnected_after_s=from_s - 0.3, p_before_kw=0.0)
    tripped = made.waveforms().segments[0].t_s >= from_s
    result = judged_with(made, tripped_at_s, trip_cause=1.0 * tripped, connected=1.0 * ~tripped)
    assert {check.message for check in result.checks} == {message}
    assert {check.status for check in result.checks} == {Status.NOT_EVALUATED}


def test_breaker_open_from_the_first_sample(bench):
    """A record that names no relay says that its breaker was open all along."""
    made = bench(q_sag_kvar=250, p_before_kw=0.0)
    result = judged_with(made, connected=0 * made.waveforms().segments[0].t_s)
    assert {check.message for check in result.checks} == {"the breaker was open before the record began"}


def test_controller_that_gives_no_current_before_the_sag(bench):
    """With the breaker closed and no current at all it was the controller, and the message says so."""
    made = bench(p_before_kw=0.0, p_sag_kw=0.0, p_after_kw=0.0, blocked_after_s=-0.3)
    for check in made.result().checks:
        assert "the controller gave no current, the breaker stayed closed" in check.message


@pytest.mark.parametrize("kinds", [("u", "u0"), ("u",)])
def test_negative_phase_order_is_told(bench, kinds):
    """Phases b and c interchanged, or of a record without a source's voltage those at the terminals."""
    made = bench(q_sag_kvar=250)
    segment = made.waveforms().segments[0]
    names = [f"{kind}_{phase}_v" for kind in kinds for phase in "bc"] + ["i_b_a", "i_c_a"]
    others = str.maketrans("bc", "cb")
    swapped = {name: segment[name[:-3] + name[-3:].translate(others)] for name in names}
    if "u0" not in kinds:
        channels = {n: x for n, x in segment.channels.items() if not n.startswith("u0")}
        record = Waveforms((Segment(segment.t0_s, segment.dt_s, {**channels, **swapped}),))
        result = evaluate(made.profile, made.test, record, made.nominal, made.available_power_w)
    else:
        result = judged_with(made, **swapped)
    assert {check.status for check in result.checks} == {Status.NOT_EVALUATED}
    for check in result.checks:
        assert check.message.startswith("negative phase order: V- 1.000 pu and V+ 0.000 pu")


@pytest.mark.parametrize(("p_kw", "counts"), [(0.0, True), (9.9, True), (10.1, False), (-9.9, True), (-10.1, False)])
def test_start_without_sun(bench, p_kw, counts):
    """Where the array gives nothing, P before must be nothing, within 2 % of rated power; then the test counts."""
    made = bench(q_sag_kvar=250, p_before_kw=p_kw, p_sag_kw=0.0, p_after_kw=p_kw, available_power_w=0.0)
    result = made.result()
    assert (result.status is not Status.NOT_EVALUATED) == counts
    if not counts:
        assert all("not within 10 kW of the 0.0 kW meant" in check.message for check in result.checks)


def test_without_power_before_no_share_of_it_is_judged(bench):
    """At night recovery is not applicable, with the reason; that the breaker stayed closed and support are judged."""
    checks = {
        check.check: check
        for check in bench(q_sag_kvar=250, p_before_kw=0.0, p_sag_kw=0.0, p_after_kw=0.0, available_power_w=0.0)
        .result()
        .checks
    }
    assert checks["ride_through"].status is Status.PASS
    assert checks["reactive_support"].status is Status.PASS
    recovery = run_of("es-nts-631-lt110kv", irradiance_w_m2=0.0, before_s=0.6)["active_power_recovery"]
    assert recovery.status is Status.NOT_APPLICABLE
    assert recovery.message.startswith("no active power before: ")


def run_of(profile, *settings, **fields):
    """Verdicts of a short sag on the bundled inverter by the name of their check."""
    scenario = Scenario(sag=Sag(depth=0.5), duration_s=0.2, **fields)
    test = TestCase(id="own", title="own", scenario=scenario)
    checks = run_test(load_profile(profile), test, parameters_from(settings)).result.checks
    return {check.check: check for check in checks}


@pytest.mark.parametrize(
    ("settings", "fields", "message"),
    [
        (
            (),
            {"cell_temperature_c": -40.0},
            "tripped at -0.500 s by the DC over-voltage relay of the plant, before the record; the array's open-circuit"
            " voltage at -40 C is 1218 V",
        ),
        (
            ("protection.overcurrent_pu=0.8", "simulation.settling_s=0.1"),
            {},
            "tripped at -0.100 s by the over-current relay of the plant, before the record",
        ),
    ],
)
def test_trip_while_settling(settings, fields, message):
    """A plant that trips before its record begins is judged by what ended it: each verdict has the relay and when."""
    assert {check.message for check in run_of("spain-q-curve", *settings, **fields).values()} == {message}
