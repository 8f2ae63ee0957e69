"""Envelopes of swells, of two-phase faults, and of disturbances that follow each other."""

import numpy as np
import pytest
from demands import CONTROL_STEP_S

from pvlvrt_compliance.checks.connection.envelopes import is_two_phase
from pvlvrt_compliance.evidence.collect import collect
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.sag import Sag

KIND = "ride_through"


def envelope(points, quantity="positive_sequence", interpolation="linear", clause="Fig. 26"):
    """Envelope with a mark."""
    return {"points": points, "voltage_quantity": quantity, "interpolation": interpolation, "clause": clause,
            "confidence": "code", "source": "a test"}  # fmt: skip


@pytest.fixture
def with_envelopes(profile_with):
    """Make a profile of ride-through alone."""
    low = envelope([[0.0, 0.0], [0.15, 0.0], [1.5, 0.85]])

    def make(**envelopes):
        demand = {"clause": "5", "source": "a test", "envelope": low, "envelope_tolerance_pu": 0.005} | envelopes
        return profile_with(KIND, demand)

    return make


HIGH = envelope([[0.0, 1.3], [0.1, 1.2], [0.5, 1.15]], "highest_phase", "step", "Fig. 9")


@pytest.mark.parametrize(
    ("level", "tripped_s", "status"),
    [
        (1.25, 0.098, Status.FAIL),
        (1.25, 0.102, Status.PASS),
        (1.18, 0.498, Status.FAIL),
        (1.18, 0.502, Status.PASS),
        (1.154, 0.9, Status.FAIL),
        (1.156, 0.9, Status.PASS),
        (1.35, 0.02, Status.NOT_APPLICABLE),
    ],
)
def test_trip_around_the_over_voltage_envelope(bench, with_envelopes, level, tripped_s, status):
    """A swell must be ridden through at and below the envelope for as long as it says."""
    points = [(0.0, 1.0), (0.0, level), (1.0, level), (1.0, 1.0)]
    scenario = {"events": [{"kind": "voltage_profile", "points": points}]}
    made = bench(depth=0, duration_s=1.0, profile=with_envelopes(envelope_over_voltage=HIGH), scenario=scenario,
                 p_sag_kw=300, disconnected_after_s=tripped_s)  # fmt: skip
    check = made.check(KIND)
    assert check.status is status, check.message
    if status is not Status.FAIL:
        assert "the over-voltage envelope demands" in check.message
        assert status is Status.NOT_APPLICABLE or check.clause == "Fig. 9"


@pytest.mark.parametrize(
    ("levels", "clause"),
    [((1.12,), "Fig. 9"), ((0.6,), "Fig. 26"), ((1.12, 0.6), "Fig. 26"), ((1.0,), "Fig. 26")],
    ids=["swell", "sag", "both", "neither"],
)
def test_what_is_ridden_through_names_the_envelope_that_decided(bench, with_envelopes, levels, clause):
    """A record that only rises is of the over-voltage envelope, any other of the one below."""
    times = np.linspace(0.0, 1.0, len(levels) + 1)
    points = [
        (0.0, 1.0),
        *((t, x) for a, b, x in zip(times[:-1], times[1:], levels, strict=True) for t in (a, b)),
        (1.0, 1.0),
    ]
    scenario = {"events": [{"kind": "voltage_profile", "points": points}]}
    made = bench(depth=0, duration_s=1.0, profile=with_envelopes(envelope_over_voltage=HIGH), scenario=scenario)
    check = made.check(KIND)
    assert (check.status, check.clause) == (Status.PASS, clause), check.message


@pytest.mark.parametrize(
    ("sag", "two_phase"),
    [
        (Sag(depth=0.5, phases="bc", two_phase=True), True),
        (Sag(depth=0.1, phases="ab", two_phase=True), True),
        (Sag(depth=1.0, phases="ca", two_phase=True), True),
        (Sag(depth=0.5), False),
        (Sag(depth=0.5, phases="bc"), False),
        (Sag(depth=0.9, phases="c"), False),
        (Sag(depth=0.5, type="F"), False),
        (Sag(depth=0.5, type="G"), False),
        (Sag(depth=0.5, type="D"), True),
    ],
)
@pytest.mark.parametrize("without", [(), ("u0_a_v", "u0_b_v", "u0_c_v")])
def test_which_sag_is_two_phase(bench, sag, two_phase, without):
    """The sequences tell an isolated two-phase fault from all others, measured or as asked for."""
    made = bench(asked=sag, duration_s=0.3, without=without)
    assert is_two_phase(collect(made.profile, made.test, made.waveforms(), made.nominal, 500e3)) is two_phase


@pytest.mark.parametrize(
    ("two_phase", "tripped_s", "status"),
    [(True, 0.48, Status.FAIL), (True, 0.52, Status.PASS), (False, 0.52, Status.FAIL)],
)
def test_envelope_of_two_phase_faults(bench, with_envelopes, two_phase, tripped_s, status):
    """Isolated two-phase faults have an envelope of their own, other faults of the same V+ do not."""
    own = envelope([[0.0, 0.6], [0.5, 0.6], [0.5, 0.95]], interpolation="step")
    sag = Sag(depth=0.5, phases="bc", two_phase=True) if two_phase else Sag(depth=0.25)
    made = bench(asked=sag, duration_s=1.0, profile=with_envelopes(envelope_two_phase=own),
                 disconnected_after_s=tripped_s, p_sag_kw=100)  # fmt: skip
    check = made.check(KIND)
    assert check.status is status, check.message
    assert ("two-phase" in check.message) is two_phase


@pytest.mark.parametrize(
    ("second_s", "tripped_s", "status"),
    [(0.14, 2.12, Status.FAIL), (0.3, 2.14, Status.FAIL), (0.3, 2.17, Status.PASS)],
)
def test_a_second_sag_has_its_own_time(bench, with_envelopes, second_s, tripped_s, status):
    """The envelope counts anew from each sag that begins with the voltage back: 0.15 s of the second to zero."""
    events = [{"kind": "sag", "t_s": 2.0, "duration_s": second_s, "sag": {"depth": 1.0}}]
    made = bench(depth=0.5, duration_s=0.3, profile=with_envelopes(), scenario={"events": events, "after_s": 3.0},
                 disconnected_after_s=tripped_s, q_sag_kvar=100)  # fmt: skip
    check = made.check(KIND)
    assert check.status is status, check.message


def test_two_sags_ridden_through(bench, with_envelopes):
    """Recovery counts from the last return of the voltage."""
    events = [{"kind": "sag", "t_s": 1.0, "duration_s": 0.1, "sag": {"depth": 0.8}}]
    profile = with_envelopes(recovery_fraction=0.9, recovery_time_s=0.5)
    power = lambda t: 500.0 * np.where((t < 0) | ((t > 0.5) & (t < 1.0)) | (t > 1.5), 1.0, 0.02)  # noqa: E731
    made = bench(depth=0.5, duration_s=0.3, profile=profile, scenario={"events": events, "after_s": 3.0}, p_kw=power)
    check = made.check(KIND)
    assert check.status is Status.PASS, check.message
    assert check.measured == pytest.approx(0.4 + 0.9 * 0.02, abs=1e-3)


def test_trip_that_is_not_the_voltages_matter(bench, with_envelopes):
    """In a test of the frequency alone a profile without bands cannot judge a trip, and P need not come back."""
    ramp = {"kind": "frequency_ramp", "t_s": 0.0, "rate_hz_s": 1.0, "duration_s": 0.5}
    made = bench(depth=0, duration_s=1.0, profile=with_envelopes(), scenario={"events": [ramp]}, p_sag_kw=500,
                 disconnected_after_s=0.3)  # fmt: skip
    assert made.check(KIND).status is Status.NOT_EVALUATED
    assert made.check(KIND).message == "tripped at 50.30 Hz; this profile says nothing of frequency"
    profile = with_envelopes(recovery_fraction=0.9, recovery_time_s=0.5)
    less = bench(depth=0, duration_s=1.0, profile=profile, scenario={"events": [ramp]}, p_sag_kw=300, p_after_kw=300)
    assert less.check(KIND).message.startswith("connected throughout")


def test_the_drawn_envelope_begins_anew_where_the_judged_one_does(bench):
    """A second sag has its own time: the band of the figure falls to the first level again at its step, not before.

    The same with the tolerance lies as far below it, but not below zero.
    """
    again = {"kind": "sag", "t_s": 1.0, "duration_s": 0.2, "sag": Sag(depth=0.9)}
    scenario = {"events": [again], "after_s": 2.0}
    made = bench(depth=0.9, duration_s=0.2, q_sag_kvar=50, scenario=scenario, dt_s=CONTROL_STEP_S)
    band, widened = (band for band in made.result().bands if band.quantity == "voltage_positive_pu")
    envelope, tolerance_pu = made.profile.envelope, made.profile.ride_through.envelope_tolerance_pu.value
    assert (band.widened, widened.widened) == (False, True)
    assert (widened.name, widened.t_s) == (band.name, band.t_s)
    assert widened.lower == pytest.approx([max(level - tolerance_pu, 0) for level in band.lower])
    for begin_s, until_s in ((0.3, 1.3), (1.3, 2.5)):
        at = np.linspace(begin_s + 1e-6, until_s - 1e-6, 50)
        assert np.interp(at, band.t_s, band.lower) == pytest.approx(envelope.voltage_at(at - begin_s), abs=1e-4)
    assert band.t_s[-1] == pytest.approx(made.waveforms().end_s)
