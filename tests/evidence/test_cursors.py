"""Cursors against closed forms: a lag of first and of second order, and what a one-cycle phasor makes of a step."""

import numpy as np
import pytest

from made_evidence import INNER, evidence_of
from pvlvrt_compliance.evidence.cursors import cursors_of

SAG = {"events": (), "levels": ((0.0, 1.0), (0.3, 0.7), (0.9, 1.0))}
START_S, CLEAR_S, CYCLE_S = 0.3, 0.9, 0.02
CURRENTS = {"i_a_a": np.zeros_like, "i_b_a": np.zeros_like, "i_c_a": np.zeros_like}


def lag(tau_s, change_v=100.0):
    """A DC voltage of 800 V that goes after a change at the start of the sag as a lag of first order does."""
    return lambda t: 800.0 + change_v * np.where(t < START_S, 0.0, 1 - np.exp(-(t - START_S) / tau_s))


def swinging(damping, w=100.0):
    """The same, as one of second order does."""

    def dc_voltage(t):
        t = np.maximum(t - START_S, 0.0)
        wd = w * np.sqrt(1 - damping**2)
        return 800.0 + 100.0 * (1 - np.exp(-damping * w * t) * (np.cos(wd * t) + damping * w / wd * np.sin(wd * t)))

    return dc_voltage


def cursor(evidence, quantity, stretch=1, limited=()):
    """The cursor of a quantity in a stretch; the first is the window before."""
    (found,) = [one for one in cursors_of(evidence, limited)[stretch].cursors if one.quantity == quantity]
    return found


@pytest.mark.parametrize("tau_s", [0.004, 0.02, 0.05])
@pytest.mark.parametrize("change_v", [100.0, -200.0])
def test_a_first_order_lag(tau_s, change_v):
    """10 % of the change after tau ln(1/0.9), 90 % and the band of 10 % after tau ln 10; up or down alike."""
    found = cursor(evidence_of(**SAG, v_dc_v=lag(tau_s, change_v)), "dc_voltage_v")
    assert (found.initial, found.final) == pytest.approx((800, 800 + change_v), abs=0.2)
    assert found.reaction_s == pytest.approx(tau_s * np.log(1 / 0.9), abs=5e-5)
    assert found.response_s == pytest.approx(tau_s * np.log(10), rel=5e-3)
    assert found.rise_s == pytest.approx(tau_s * np.log(9), rel=5e-3)
    assert found.settling_s == pytest.approx(found.response_s)
    assert found.overshoot_percent == pytest.approx(0, abs=0.1)
    settled = 800 + change_v * (1 - np.exp(-1.1 * CYCLE_S / tau_s))
    assert sorted((found.minimum, found.maximum)) == pytest.approx(sorted((settled, 800 + change_v)), abs=0.3)


@pytest.mark.parametrize("damping", [0.2, 0.5])
def test_a_second_order_lag(damping):
    """Overshoot exp(-pi z / sqrt(1 - z^2)); at the settling time 10 % off, and never again after it."""
    evidence = evidence_of(**SAG, v_dc_v=swinging(damping))
    found = cursor(evidence, "dc_voltage_v")
    assert found.overshoot_percent == pytest.approx(100 * np.exp(-np.pi * damping / np.sqrt(1 - damping**2)), abs=0.01)
    t_s, off_v = evidence.t_s, np.abs(evidence.dc_voltage_v - 900)
    assert np.interp(START_S + found.settling_s, t_s, off_v) == pytest.approx(10, abs=0.02)
    assert off_v[(t_s > START_S + found.settling_s) & (t_s < CLEAR_S)].max() <= 10.02


def test_a_one_cycle_voltage_takes_a_cycle():
    """It goes from the old level to the new one along a straight line: reaction 0.1 T, response 0.9 T, rise 0.8 T."""
    found = cursor(evidence_of(**SAG), "voltage_positive_pu")
    times = (found.reaction_s, found.response_s, found.rise_s, found.settling_s)
    assert times == pytest.approx((0.1 * CYCLE_S, 0.9 * CYCLE_S, 0.8 * CYCLE_S, 0.9 * CYCLE_S), abs=1.5e-4)
    assert (found.minimum, found.maximum, found.mean) == pytest.approx((0.7, 0.7, 0.7), abs=1e-9)
    assert (found.initial, found.final) == pytest.approx((1.0, 0.7), abs=1e-9)


def test_each_stretch_has_its_own_and_the_window_before():
    """A sag within a sag: five parts, each with its level; nothing is timed before the disturbance."""
    found = cursors_of(evidence_of(), ())
    assert [part.is_before for part in found] == [True, False, False, False, False]
    assert [part.begin_s for part in found] == pytest.approx([0.08, 0.3, 0.5, 0.65, 0.9])
    assert [part.cursors[0].mean for part in found] == pytest.approx([1.0, 0.7, 0.2, 0.7, 1.0], abs=1e-9)
    assert all(one.initial is None and one.response_s is None for one in found[0].cursors)


@pytest.mark.parametrize(("change_v", "is_timed"), [(39.0, False), (-39.0, False), (41.0, True), (-41.0, True)])
def test_a_small_change_is_not_timed(change_v, is_timed):
    """5 % of what was before is the least: of less a band of 10 % lies within what measurement leaves open."""
    found = cursor(evidence_of(**SAG, v_dc_v=lag(0.005, change_v)), "dc_voltage_v")
    assert found.final == pytest.approx(800 + change_v, abs=0.1)
    assert (found.response_s is not None) is is_timed
    assert (found.overshoot_percent is not None) is is_timed


def test_what_never_settles_has_no_settling_time():
    """A swing that stays 15 % of the change high leaves the band for ever; the other times are there."""

    def dc_voltage(t):
        # Whole periods lie in the last 0.2 s, so that the final value is 900 V; the last sample is on a crest.
        return np.where(t < START_S, 800.0, 900.0 + 15 * np.cos(2 * np.pi * 50 * (t - CLEAR_S)))

    found = cursor(evidence_of(**SAG, v_dc_v=dc_voltage), "dc_voltage_v")
    assert found.settling_s is None
    assert found.response_s == pytest.approx(0, abs=2e-4)
    assert found.overshoot_percent == pytest.approx(15, abs=0.2)


def test_a_stretch_too_short_has_no_levels():
    """Of 15 ms nothing is settled, of 60 ms no settled cycle: extremes at most, no times."""
    for duration_s, extremes in ((0.015, False), (0.06, True)):
        inner, end_s = INNER | {"duration_s": duration_s}, 0.5 + duration_s
        levels = ((0.0, 1.0), (0.3, 0.7), (0.5, 0.2), (end_s, 0.7), (0.9, 1.0))
        short = cursors_of(evidence_of(events=(inner,), levels=levels), ())[2]
        assert (short.begin_s, short.end_s) == pytest.approx((0.5, end_s))
        assert [one.quantity for one in short.cursors] == (["voltage_positive_pu", "voltage_negative_pu"] * extremes)
        assert all(one.final is None and one.response_s is None for one in short.cursors)


def test_nothing_is_timed_while_something_ramps():
    """On a ramp there is no value that would be reached; extremes and mean are there."""
    ramp = {"kind": "irradiance", "t_s": 0.0, "to_w_m2": 600, "ramp_s": 0.6}
    found = cursor(evidence_of(**SAG | {"events": (ramp,)}, v_dc_v=lag(0.01)), "dc_voltage_v")
    assert (found.final, found.response_s) == (None, None)
    assert found.maximum == pytest.approx(900, abs=0.1)


def test_cursors_end_with_the_trip():
    """What a tripped inverter feeds is no response to the grid: the stretch ends where the breaker opens."""
    found = cursors_of(evidence_of(**SAG, connected=lambda t: np.where(t < 0.6, 1.0, 0.0)), ())
    assert [(part.begin_s, part.end_s) for part in found[1:]] == [pytest.approx((0.3, 0.6))]


def test_reactive_currents_have_cursors_where_they_are_judged():
    """Where no limit of them is drawn they are left out; so is what the record has no channels for."""
    evidence = evidence_of(**SAG, **CURRENTS)
    for limited in ((), ("reactive_current_pu",), ("reactive_current_pu", "reactive_current_negative_pu")):
        names = [one.quantity for one in cursors_of(evidence, limited)[1].cursors]
        assert [name for name in names if name.startswith("reactive_current")] == list(limited)
    assert "dc_voltage_v" not in names
    assert "frequency_hz" not in names


def test_no_cursors_without_a_frequency():
    """A record without voltages counts no cycles."""
    evidence = evidence_of(**SAG, u_a_v=lambda t: np.full_like(t, np.nan))
    assert cursors_of(evidence, ()) == ()
