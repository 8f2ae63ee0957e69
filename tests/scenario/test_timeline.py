"""Scenarios as breakpoints of the grid."""

import math

import numpy as np
import pytest
from pydantic import ValidationError

from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.timeline import asked_sequences_pu, entries, irradiance_points


def scenario(*events, depth=0.0, duration_s=0.5, **fields):
    """A scenario with these events; its sag starts at 0.3 s."""
    return Scenario(sag=Sag(depth=depth), duration_s=duration_s, events=events, **fields)


def angle_at(found, t):
    """Angle of phase a from the entries alone (rad)."""
    entry = [e for e in found if e.t_s <= t][-1]
    dt = t - entry.t_s
    return entry.angle_rad + 2 * math.pi * (entry.frequency_hz * dt + 0.5 * entry.rocof_hz_s * dt**2)


def turns_apart(a, b):
    """Difference of two angles, whole turns left out (rad)."""
    return math.remainder(a - b, 2 * math.pi)


def test_plain_sag():
    """A sag is three entries: healthy, sagged, healthy, and the angle runs on through them."""
    found = entries(scenario(depth=0.9, point_on_wave_deg=30))
    assert [abs(e.sequences_pu.positive) for e in found] == pytest.approx([1, 0.1, 1])
    assert [e.t_s for e in found[1:]] == [0.3, 0.8]
    assert turns_apart(angle_at(found, 0.3), math.radians(30)) == pytest.approx(0, abs=1e-9)
    assert turns_apart(angle_at(found, 0.3 - 1e-9), math.radians(30)) == pytest.approx(0, abs=1e-6)


def test_phase_jump():
    """A jump moves the angle at its instant, by its angle, for good."""
    calm, jumped = entries(scenario()), entries(scenario({"kind": "phase_jump", "t_s": 0.1, "angle_deg": -20}))
    for t, moved in ((0.39, 0.0), (0.41, -20.0), (2.0, -20.0)):
        assert turns_apart(angle_at(jumped, t), angle_at(calm, t)) == pytest.approx(math.radians(moved), abs=1e-9)


def test_phase_jump_with_the_sag():
    """A jump at the start of the sag leaves the angle before it as the point on wave says."""
    found = entries(scenario({"kind": "phase_jump", "t_s": 0, "angle_deg": 45}, point_on_wave_deg=10))
    assert turns_apart(angle_at(found, 0.3 - 1e-9), math.radians(10)) == pytest.approx(0, abs=1e-6)
    assert turns_apart(angle_at(found, 0.3), math.radians(55)) == pytest.approx(0, abs=1e-9)


def test_frequency_ramp_and_step():
    """The angle is the integral of the frequency over step and ramp."""
    found = entries(
        scenario(
            {"kind": "frequency_ramp", "t_s": 0.1, "rate_hz_s": 2.0, "duration_s": 0.5},
            {"kind": "frequency_step", "t_s": 0.9, "to_hz": 49.0},
        )
    )
    t = np.linspace(0.0, 2.0, 200_001)
    since = t - 0.3
    f = np.where(since < 0.1, 50.0, np.where(since < 0.6, 50 + 2 * (since - 0.1), np.where(since < 0.9, 51.0, 49.0)))
    integral = np.concatenate(([0.0], np.cumsum(0.5 * (f[1:] + f[:-1]) * np.diff(t)))) * 2 * math.pi
    for k in (50_000, 75_000, 110_000, 199_999):
        moved = angle_at(found, float(t[k])) - angle_at(found, 0.0)
        assert turns_apart(moved, float(integral[k])) == pytest.approx(0, abs=2e-4)


def test_voltage_profile():
    """Ramps and steps multiply the voltages; before the first point nothing changes, the last level is held."""
    profile = {"kind": "voltage_profile", "points": [[0.0, 1.0], [0.1, 0.5], [0.1, 0.6], [0.3, 1.2]]}
    s = scenario(profile)
    for since, level in ((-0.1, 1.0), (0.05, 0.75), (0.0999999, 0.5), (0.1, 0.6), (0.2, 0.9), (5.0, 1.2)):
        assert abs(asked_sequences_pu(s, 0.3 + since).positive) == pytest.approx(level, abs=1e-5)
    for entry, after in zip(entries(s), entries(s)[1:], strict=False):
        end = entry.sequences_pu.positive + (after.t_s - 1e-9 - entry.t_s) * entry.slope_pu_s.positive
        assert abs(end - asked_sequences_pu(s, after.t_s - 1e-9).positive) < 1e-6


def test_several_sags():
    """Of sags that overlap the later one holds; after it the grid is healthy again, or in the earlier one."""
    s = scenario({"kind": "sag", "t_s": 0.2, "duration_s": 0.1, "sag": {"depth": 0.8}}, depth=0.5)
    found = [round(abs(asked_sequences_pu(s, 0.3 + t).positive), 9) for t in (-0.1, 0.1, 0.25, 0.35, 0.6)]
    assert found == [1, 0.5, 0.2, 0.5, 1]


def test_sag_that_begins_with_the_disturbance():
    """A further sag that begins with the sag of the test holds; so does the last listed of several."""
    first, last = ({"kind": "sag", "t_s": 0, "duration_s": 0.1, "sag": {"depth": depth}} for depth in (0.8, 0.4))
    assert abs(asked_sequences_pu(scenario(first), 0.35).positive) == pytest.approx(0.2)
    assert abs(asked_sequences_pu(scenario(first, last), 0.35).positive) == pytest.approx(0.6)


def test_grid_strength():
    """The grid is as strong as its last event says."""
    s = scenario({"kind": "grid_strength", "t_s": 0.5, "scr": 3.0}, scr=20.0)
    assert [(e.scr, e.xr) for e in entries(s)] == [(20.0, 10.0), (20.0, 10.0), (3.0, 10.0)]


def test_irradiance():
    """Irradiance steps and ramps from where it is."""
    s = scenario(
        {"kind": "irradiance", "t_s": 0.1, "to_w_m2": 800},
        {"kind": "irradiance", "t_s": 0.5, "to_w_m2": 1000, "ramp_s": 0.2},
    )
    points = irradiance_points(s)[1:]
    assert points == [(0.4, 1000), (0.4, 800), (0.8, 800), (pytest.approx(1.0), 1000)]


@pytest.mark.parametrize(
    "event",
    [
        {"kind": "phase_jmp", "t_s": 0, "angle_deg": 5},
        {"kind": "phase_jump", "t_s": 0, "angle_deg": 500},
        {"kind": "harmonic", "order": 1, "amplitude_pu": 0.1},
        {"kind": "voltage_profile", "points": [[0.2, 1], [0.1, 1]]},
        {"kind": "sag", "t_s": 0, "duration_s": -1, "sag": {"depth": 0.1}},
        {"kind": "irradiance", "t_s": 0, "to_w_m2": 800, "ramp": 1},
    ],
)
def test_what_is_refused(event):
    """An event of unknown kind, with an unknown field or out of range is refused."""
    with pytest.raises(ValidationError):
        scenario(event)
