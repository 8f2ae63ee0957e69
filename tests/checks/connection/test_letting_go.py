"""What lets an inverter go, and what does not: the grid's voltage, the row of a test table, a profile that speaks."""

import pytest

from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.events import FrequencyStep
from pvlvrt_compliance.scenario.sag import Sag

KIND = "ride_through"
SOURCE = ("u0_a_v", "u0_b_v", "u0_c_v")
DEMANDED_S = 0.15 + 0.1 / 0.85 * 1.35
ENVELOPE = {"points": [[0.0, 0.0], [0.15, 0.0], [1.5, 0.85]], "voltage_quantity": "positive_sequence",
            "interpolation": "linear", "clause": "Fig. 26", "confidence": "code", "source": "a test"}  # fmt: skip


@pytest.fixture
def limited(profile_with):
    """Make a profile of ride-through alone, with an envelope of low voltages."""

    def make(**more):
        demand = {"clause": "5", "source": "a test", "envelope": ENVELOPE, "envelope_tolerance_pu": 0.001} | more
        return profile_with(KIND, demand)

    return make


def row_of(made, expect, by_s=None, **row):
    """The record as a run of a row that demands something; further fields are the row's."""
    made.test = made.test.model_copy(update={"expect": expect, "by_s": by_s} | row)
    return made


@pytest.mark.parametrize(("tripped_s", "status"), [(0.297, Status.FAIL), (0.312, Status.PASS)])
def test_dragging_ones_own_voltage_down_lets_nobody_go(bench, limited, tripped_s, status):
    """The terminals are at 0 pu, which would let go after 0.15 s; the source at 0.10 pu demands 0.309 s."""
    made = bench(
        asked=Sag(depth=0.9), duration_s=0.5, profile=limited(), sag=Sag(depth=1.0), no_load_sag=Sag(depth=0.9),
        q_sag_kvar=0, p_sag_kw=0, disconnected_after_s=tripped_s, flows=lambda t: 1.0 + 0 * t,
        extra_current_pu=lambda t: [0.1 + 0 * t, -0.1 + 0 * t, 0 * t],
    )  # fmt: skip
    check = made.check(KIND)
    assert check.status is status, check.message
    assert check.limit == pytest.approx(DEMANDED_S, abs=1e-3)
    assert check.measured == pytest.approx(tripped_s, abs=1e-3)
    assert check.bound == "at_least"
    assert check.margin == pytest.approx(check.measured - check.limit)


def test_the_terminals_alone_let_nobody_go_for_certain(bench, limited):
    """A record without the source's voltage cannot tell whose doing a release is; a trip before any still fails."""
    settings = {"depth": 0.9, "duration_s": 0.5, "profile": limited(), "without": SOURCE}
    check = bench(disconnected_after_s=0.33, **settings).check(KIND)
    assert check.status is Status.NOT_EVALUATED
    assert "no-load voltage missing" in check.message
    assert bench(disconnected_after_s=0.2, **settings).check(KIND).status is Status.FAIL
    assert bench(**settings).check(KIND).status is Status.PASS


@pytest.mark.parametrize(("tripped_s", "status"), [(0.30, Status.FAIL), (0.32, Status.PASS)])
def test_of_one_depth_one_verdict(bench, limited, tripped_s, status):
    """However long a sag of the user's own lasts, what was done before it clears is judged alike."""
    found = [
        bench(depth=0.9, duration_s=duration_s, profile=limited(), disconnected_after_s=tripped_s).check(KIND)
        for duration_s in (0.34, 0.5, 0.9)
    ]
    assert {check.status for check in found} == {status}


def test_a_row_is_ridden_through_as_a_whole(bench, limited):
    """Beyond the envelope's time a row still demands its own length; after it, connection for ever."""
    made = bench(depth=0.9, duration_s=0.5, profile=limited(), disconnected_after_s=0.487)
    assert made.check(KIND).status is Status.PASS
    check = row_of(made, "ride_through").check(KIND)
    assert check.status is Status.FAIL
    assert (check.measured, check.limit) == (pytest.approx(0.487, abs=1e-3), pytest.approx(0.5))
    assert "the test demands 0.500 s" in check.message
    late = row_of(bench(depth=0.9, duration_s=0.5, profile=limited(), disconnected_after_s=0.6), "ride_through")
    check = late.check(KIND)
    assert check.status is Status.FAIL
    assert check.limit is check.margin is None


@pytest.mark.parametrize(
    ("tripped_s", "clause", "confidence"),
    [(0.2, "Fig. 26", "code"), (0.32, "row", "confirmed"), (None, "row", "confirmed"), (0.6, "Fig. 26", "code")],
)
def test_whose_demand_it_is(bench, limited, tripped_s, clause, confidence):
    """Of 0.5 s the envelope demands 0.309 s: a trip before that breaks both and is the envelope's, then the row's.

    After the row's end connection is demanded by the envelope again.
    """
    made = bench(
        depth=0.9, duration_s=0.5, profile=limited(), disconnected_after_s=tripped_s, q_sag_kvar=50, p_sag_kw=0
    )
    check = row_of(made, "ride_through", clause="row", confidence="confirmed").check(KIND)
    assert check.status is (Status.PASS if tripped_s is None else Status.FAIL), check.message
    assert (check.clause, check.confidence) == (clause, confidence)


def test_a_sag_within_the_envelope_is_demanded_by_the_envelope(bench, limited):
    """A row that asks for no more than the envelope does decides nothing; nor does one of the user's own."""
    made = bench(depth=0.9, duration_s=0.3, profile=limited(), disconnected_after_s=0.25)
    check = row_of(made, "ride_through", clause="row", confidence="confirmed").check(KIND)
    assert (check.status, check.clause, check.confidence) == (Status.FAIL, "Fig. 26", "code")


def test_without_a_step_of_the_voltage_the_row_demands(bench, limited):
    """A step of the frequency is ridden through because its row says so: the voltage stayed above every envelope."""
    events = (FrequencyStep(t_s=0.0, to_hz=50.5),)
    made = bench(depth=0.0, duration_s=0.5, profile=limited(), scenario={"events": events})
    own = made.check(KIND)
    assert (own.status, own.clause) == (Status.PASS, "Fig. 26")
    check = row_of(made, "ride_through", clause="row", confidence="confirmed").check(KIND)
    assert (check.status, check.clause, check.confidence) == (Status.PASS, "row", "confirmed")


def test_a_row_that_may_trip(bench, limited):
    """It demands what the voltage's limits demand, as a sag of the user's own does."""
    made = bench(depth=0.9, duration_s=0.5, profile=limited(), disconnected_after_s=0.32)
    assert row_of(made, "may_trip").check(KIND).status is Status.PASS
    early = bench(depth=0.9, duration_s=0.5, profile=limited(), disconnected_after_s=0.3)
    assert row_of(early, "may_trip").check(KIND).status is Status.FAIL


@pytest.mark.parametrize(("tripped_s", "status"), [(0.398, Status.PASS), (0.402, Status.FAIL), (None, Status.FAIL)])
def test_a_row_that_must_trip(bench, limited, tripped_s, status):
    """The breaker must be open in time, and not before the envelope lets go."""
    made = bench(depth=0.9, duration_s=0.5, profile=limited(), disconnected_after_s=tripped_s)
    check = row_of(made, "must_trip", 0.4).check(KIND)
    assert check.status is status, check.message
    early = row_of(bench(depth=0.9, duration_s=0.5, profile=limited(), disconnected_after_s=0.2), "must_trip", 0.4)
    assert early.check(KIND).status is Status.FAIL


@pytest.mark.parametrize("depth", [0.0, 0.05])
def test_a_trip_in_a_normal_grid_fails(bench, limited, depth):
    """Where nothing has left normal operation nothing lets the inverter go."""
    check = bench(depth=depth, duration_s=0.4, profile=limited(), p_sag_kw=500, disconnected_after_s=0.2).check(KIND)
    assert check.status is Status.FAIL, check.message


def test_a_trip_in_the_normal_grid_after_a_sag_that_let_go(bench, limited):
    """Once the voltage is back, that it might have let go before is no excuse."""
    check = bench(depth=0.9, duration_s=0.4, profile=limited(), disconnected_after_s=0.9).check(KIND)
    assert check.status is Status.FAIL
    assert "in a grid that was normal" in check.message


@pytest.mark.parametrize(
    ("event", "words"),
    [
        ({"kind": "voltage_profile", "points": [(0, 1), (0, 1.3), (0.5, 1.3), (0.5, 1)]}, "nothing of over-voltage"),
        ({"kind": "frequency_step", "t_s": 0.0, "to_hz": 51.0}, "nothing of frequency"),
        ({"kind": "phase_jump", "t_s": 0.15, "angle_deg": 40.0}, "nothing of jumps of the angle"),
    ],
)
def test_a_profile_that_is_silent_on_what_moved(bench, limited, event, words):
    """Whether the inverter might let go then, nobody can say."""
    made = bench(depth=0, duration_s=0.5, profile=limited(), scenario={"events": [event]}, p_sag_kw=500,
                 disconnected_after_s=0.2)  # fmt: skip
    check = made.check(KIND)
    assert check.status is Status.NOT_EVALUATED
    assert words in check.message


@pytest.mark.parametrize(("since_s", "status"), [(0.19, Status.NOT_EVALUATED), (0.21, Status.FAIL)])
def test_how_long_a_jump_counts(bench, limited, since_s, status):
    """A fifth of a second after a jump the grid is normal again."""
    jump = {"kind": "phase_jump", "t_s": 0.1, "angle_deg": 40.0}
    made = bench(depth=0, duration_s=0.5, profile=limited(), scenario={"events": [jump]}, p_sag_kw=500,
                 disconnected_after_s=0.1 + since_s)  # fmt: skip
    assert made.check(KIND).status is status


def test_a_jump_that_comes_with_a_sag_is_the_sags_matter(bench, limited):
    """Every real fault turns the angle: the envelope decides all the same."""
    made = bench(asked=Sag(depth=0.5, angle_deg=40), duration_s=0.3, profile=limited(), disconnected_after_s=0.05)
    assert made.check(KIND).status is Status.FAIL
    after = bench(asked=Sag(depth=0.5, angle_deg=40), duration_s=0.3, profile=limited(), disconnected_after_s=0.4)
    assert after.check(KIND).status is Status.FAIL


def test_other_checks_have_their_own_matters(bench, demanding):
    """With bands of its own the frequency is left to the check of the frequency."""
    bands = {"rows": [{"frequency_hz": (47, 49), "ride_s": 60}, {"frequency_hz": (49, 51)}], "clause": "7",
             "confidence": "code", "source": "a test"}  # fmt: skip
    profile = demanding(ride_through={"envelope": ENVELOPE, "envelope_tolerance_pu": 0.001},
                        frequency_ride_through={"bands": bands})  # fmt: skip
    ramp = {"kind": "frequency_ramp", "t_s": 0.0, "rate_hz_s": -2.0, "duration_s": 0.4}
    made = bench(depth=0, duration_s=2.0, profile=profile, scenario={"events": [ramp]}, p_sag_kw=500,
                 disconnected_after_s=1.0)  # fmt: skip
    found = {check.check: check.status for check in made.result().checks}
    assert found == {KIND: Status.NOT_APPLICABLE, "frequency_ride_through": Status.FAIL}


def test_a_row_leaves_out_ride_through_but_not_a_trip(bench, iec):
    """Letting go is judged in every test, also where the row names other checks."""
    made = bench(depth=0, duration_s=0.5, profile=iec, p_sag_kw=500, disconnected_after_s=0.2)
    made.test = made.test.model_copy(update={"checks": ("dc_ripple",)})
    assert {check.check: check.status for check in made.result().checks}[KIND] is Status.FAIL
    made.disconnected_after_s = None
    assert KIND not in {check.check for check in made.result().checks}


def test_a_row_leaves_out_the_check_that_decides(bench, demanding):
    """A trip that ride-through leaves to the check of the frequency is judged by it, whatever the row names."""
    bands = {"rows": [{"frequency_hz": (47, 49), "ride_s": 60}, {"frequency_hz": (49, 51)}], "clause": "7",
             "confidence": "code", "source": "a test"}  # fmt: skip
    profile = demanding(ride_through={"envelope": ENVELOPE, "envelope_tolerance_pu": 0.001},
                        frequency_ride_through={"bands": bands}, current_limit={"limit_pu": 1.0, "tolerance_pu": 0.02,
                        "settling_s": 0.06, "peak_pu": 2.0})  # fmt: skip
    ramp = {"kind": "frequency_ramp", "t_s": 0.0, "rate_hz_s": -2.0, "duration_s": 0.4}
    made = bench(depth=0, duration_s=0.5, profile=profile, scenario={"events": [ramp]}, p_sag_kw=500,
                 disconnected_after_s=1.0)  # fmt: skip
    made.test = made.test.model_copy(update={"checks": (KIND, "current_limit")})
    found = {check.check: check.status for check in made.result().checks}
    assert found["frequency_ride_through"] is Status.FAIL
    made.disconnected_after_s = None
    assert "frequency_ride_through" not in {check.check for check in made.result().checks}


@pytest.mark.parametrize(("expect", "status"), [(None, Status.NOT_EVALUATED), ("may_trip", Status.NOT_APPLICABLE)])
def test_a_test_in_which_nothing_was_judged(bench, limited, expect, status):
    """It is no evidence, unless its row says that nothing need be due."""
    high = ENVELOPE | {"points": [[0, 0.2], [1.0, 0.85]]}
    made = bench(depth=0.9, duration_s=0.3, profile=limited(envelope=high), disconnected_after_s=0.1, expect=expect)
    check = made.check(KIND)
    assert check.status is status
    assert "demands nothing" in check.message
