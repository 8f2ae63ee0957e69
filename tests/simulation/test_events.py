"""Whole runs through the events that a grid code or the paper knows besides a single sag."""

import math

import numpy as np
import pytest

from pvlvrt_compliance.measure.fourier import component
from pvlvrt_compliance.measure.power import instantaneous_power
from pvlvrt_compliance.measure.sequences import sequence_phasors
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.simulate import simulate


def run(*events, settings=(), depth=0.0, duration_s=0.5, **fields):
    """Waveforms of a scenario with these events; its sag starts at 0.3 s."""
    scenario = Scenario(sag=Sag(depth=depth), duration_s=duration_s, events=events, **fields)
    return simulate(scenario, parameters_from(settings)).segments[0]


def harmonics(phase5, phase7):
    """The paper's distortion of section 5: 5th and 7th at 10 %, with these phases (deg)."""
    return (
        {"kind": "harmonic", "order": 5, "amplitude_pu": 0.1, "phase_deg": phase5},
        {"kind": "harmonic", "order": 7, "amplitude_pu": 0.1, "phase_deg": phase7},
    )


def swing(x, segment, order):
    """Amplitude of a multiple of 50 Hz over the last ten cycles."""
    n = segment.index_at(segment.end_s - 0.2)
    return abs(component(x[n:], segment.dt_s, order * 50.0))


def test_source_is_the_closed_form():
    """The recorded source is the sum of fundamental and harmonics, through jump, ramp and profile."""
    profile = {"kind": "voltage_profile", "points": [[0.0, 1.0], [0.2, 0.9]]}
    jump = {"kind": "phase_jump", "t_s": 0.3, "angle_deg": 15}
    segment = run(profile, jump, *harmonics(30, -40), {"kind": "harmonic", "order": 3, "amplitude_pu": 0.05})
    t = segment.t_s
    factor = np.interp(t - 0.3, [0, 0.2], [1.0, 0.9])
    theta = 2 * math.pi * 50 * (t - 0.3) + np.where(t >= 0.6, math.radians(15), 0.0)
    u = factor * np.cos(theta) + 0.1 * np.cos(5 * theta + math.radians(30)) + 0.1 * np.cos(7 * theta - math.radians(40))
    peak = math.sqrt(2) * 230
    assert np.abs(segment["u0_a_v"] - peak * (u + 0.05 * np.cos(3 * theta))).max() < 1e-6 * peak


def test_natural_sequences():
    """The 5th turns backwards and the 7th forwards: each phase has the same wave, a third of a period later."""
    segment = run(*harmonics(0, 0))
    shift = 1 / 150
    n = segment.index_at(0.1)
    t = segment.t_s
    later = np.interp(t[n : n + 2000] - shift, t, segment["u0_a_v"])
    assert np.abs(segment["u0_b_v"][n : n + 2000] - later).max() < 0.5


@pytest.mark.parametrize(("phase5", "phase7", "steady"), [(0, 180, "p"), (0, 0, "q")])
def test_harmonics_swing_one_power(phase5, phase7, steady):
    """5th and 7th in antiphase leave P steady and swing Q by 0.2 S at six times the frequency; in phase, P swings."""
    segment = run(*harmonics(phase5, phase7))
    power = instantaneous_power(segment)
    p, q = swing(power.p, segment, 6) / 5e5, swing(power.q, segment, 6) / 5e5
    calm, swinging = (p, q) if steady == "p" else (q, p)
    assert calm < 0.01
    assert swinging == pytest.approx(0.2, abs=0.01)


@pytest.mark.parametrize(
    ("gains", "thd"),
    [((), (0.0, 0.6)), (tuple(f"controller.hc{h}_integral_gain=0" for h in (5, 7, 11, 13)), (6.5, 8.0))],
)
def test_harmonic_compensators(gains, thd):
    """At 10 % of 5th and 7th the currents are distorted by about 7 % without compensators, by under 0.6 % with them."""
    segment = run(*harmonics(0, 180), settings=gains)
    one = swing(segment["i_a_a"], segment, 1)
    rest = math.hypot(*(swing(segment["i_a_a"], segment, h) for h in range(2, 41)))
    low, high = thd
    assert low <= 100 * rest / one <= high


def test_irradiance_step():
    """A shadow takes P from about 500 kW to 400 to 415 kW and back, and leaves Q alone."""
    shadow = {"kind": "irradiance", "t_s": 0.0, "to_w_m2": 800}
    sun = {"kind": "irradiance", "t_s": 1.0, "to_w_m2": 1000}
    segment = run(shadow, sun, after_s=2.0)
    power = instantaneous_power(segment)
    means = {}
    for name, end in (("before", 0.3), ("shadow", 1.25), ("after", 2.75)):
        span = slice(segment.index_at(end - 0.1), segment.index_at(end))
        means[name] = (power.p[span].mean() / 1e3, power.q[span].mean() / 1e3)
    assert means["before"][0] == pytest.approx(500, abs=10)
    assert 400 <= means["shadow"][0] <= 415
    assert means["after"][0] == pytest.approx(500, abs=10)
    assert max(abs(q) for _, q in means.values()) < 8


def test_grid_strength_changes_at_clearing():
    """A grid that grows weak as the fault clears gives the PCC voltage of a weak grid afterwards."""
    strong = run(depth=0.5, scr=20.0)
    weakened = run({"kind": "grid_strength", "t_s": 0.5, "scr": 5.0}, depth=0.5, scr=20.0)
    weak = run(depth=0.5, scr=5.0)
    before = slice(strong.index_at(0.5), strong.index_at(0.79))
    assert np.array_equal(strong["u_a_v"][before], weakened["u_a_v"][before])
    last = slice(-2000, None)

    def sample(segment):
        return abs(sequence_phasors(segment, "u", 50.0).positive[last]).mean()

    assert sample(weakened) == pytest.approx(sample(weak), rel=1e-3)
    assert abs(sample(weakened) - sample(strong)) > 0.003 * sample(strong)


def test_frequency_follows_a_ramp():
    """The estimated frequency follows a ramp of 1 Hz/s with the lag of the loop, and settles on its end."""
    ramp = {"kind": "frequency_ramp", "t_s": 0.0, "rate_hz_s": 1.0, "duration_s": 1.0}
    segment = run(ramp, duration_s=1.0)
    estimate = segment["frequency_estimate_hz"]
    assert estimate[segment.index_at(1.2)] == pytest.approx(50.9, abs=0.03)
    assert estimate[-1] == pytest.approx(51.0, abs=1e-3)
    assert segment["connected"].min() == 1


def test_frequency_relay_trips():
    """A step to 56 Hz trips the frequency relay of a 50 Hz plant 0.2 s later; one to 54 Hz does not."""
    out = run({"kind": "frequency_step", "t_s": 0.0, "to_hz": 56.0})
    opened = out.t_s[np.argmin(out["connected"])]
    assert opened == pytest.approx(0.3 + 0.2 + 0.04, abs=0.04)
    assert run({"kind": "frequency_step", "t_s": 0.0, "to_hz": 54.0})["connected"].min() == 1


def test_two_sags_in_a_row():
    """The controller rides through a second sag as through the first."""
    again = {"kind": "sag", "t_s": 0.8, "duration_s": 0.3, "sag": {"depth": 0.9}}
    segment = run(again, depth=0.9, duration_s=0.3, after_s=1.6)
    assert segment["connected"].min() == 1
    power = instantaneous_power(segment)
    for end in (0.58, 1.38):
        span = slice(segment.index_at(end - 0.1), segment.index_at(end))
        assert power.q[span].mean() == pytest.approx(50e3, abs=2e3)
    assert power.p[-4000:].mean() == pytest.approx(497e3, rel=0.01)
