"""Jumps of the angle, on both sides of each limit."""

import pytest

from pvlvrt_compliance.checks.connection.phase_jump_ride_through import jump_at
from pvlvrt_compliance.evidence.collect import collect
from pvlvrt_compliance.results import Status
from pvlvrt_compliance.scenario.sag import Sag

KIND = "phase_jump_ride_through"
DEMAND = {"clause": "6.5.2.6", "source": "a test", "all_phases_deg": 20, "single_phase_deg": 60,
          "recovery_fraction": 0.8, "recovery_time_s": 0.4}  # fmt: skip


@pytest.fixture
def jumping(profile_with, bench):
    """Make a record with jumps of the angle."""

    def make(*jumps, **settings):
        events = [{"kind": "phase_jump", "t_s": t_s, "angle_deg": angle} for t_s, angle in jumps]
        return bench(depth=0, duration_s=1.0, profile=profile_with(KIND, DEMAND),
                     scenario={"events": events}, p_sag_kw=500, **settings)  # fmt: skip

    return make


@pytest.mark.parametrize(("angle", "status"), [(20, Status.FAIL), (-20, Status.FAIL), (20.3, Status.NOT_APPLICABLE)])
def test_trip_after_a_jump(jumping, angle, status):
    """A trip after a jump up to the limit, forwards or backwards, fails; beyond it nothing is demanded."""
    check = jumping((0.2, angle), disconnected_after_s=0.3).check(KIND)
    assert check.status is status, check.message
    if status is Status.FAIL:
        assert check.measured == pytest.approx(0.1, abs=1e-4)
        assert f"{angle:.1f} deg" in check.message


@pytest.mark.parametrize(("angle", "status"), [(60, Status.PASS), (-60, Status.PASS), (61, Status.NOT_APPLICABLE)])
def test_jump_of_one_phase(bench, profile_with, angle, status):
    """One phase may be asked to jump further: 60 degrees turn the positive sequence by 19.1 only."""
    made = bench(asked=Sag(depth=0, phases="b", angle_deg=angle), duration_s=0.5, profile=profile_with(KIND, DEMAND),
                 p_sag_kw=500)  # fmt: skip
    check = made.check(KIND)
    assert check.status is status, check.message
    assert "of one phase" in check.message


@pytest.mark.parametrize(("back_s", "status"), [(0.38, Status.PASS), (0.39, Status.FAIL)])
def test_power_back_after_the_last_jump(jumping, back_s, status):
    """P must be back at 80 % within 0.4 s of the last jump; a one-cycle mean takes 16 ms to rise there."""
    made = jumping((0.1, 20), (0.5, -20), p_kw=lambda t: 500.0 * ((t < 0.5) | (t > 0.5 + back_s)))
    check = made.check(KIND)
    assert check.status is status, check.message
    assert check.measured == pytest.approx(back_s + 0.016, abs=1e-3)


def test_what_does_not_jump_is_not_judged(jumping):
    """A test without a jump, and a trip before the first one, are not this check's matter."""
    assert jumping().check(KIND).status is Status.NOT_APPLICABLE
    assert jumping((0.5, 20), disconnected_after_s=0.3).check(KIND).status is Status.NOT_APPLICABLE


@pytest.mark.parametrize(("jumps", "seen"), [([(0.2, 13.0)], "measured"), ([(0.2, 6.5), (0.22, 6.75)], "asked for")])
@pytest.mark.parametrize("hz", [50.0, 50.3])
def test_size_of_a_jump(jumps, seen, hz, bench, profile_with):
    """The jump that is measured is the one asked for, also off nominal; jumps a cycle apart cannot be measured."""
    events = [{"kind": "phase_jump", "t_s": t_s, "angle_deg": angle} for t_s, angle in jumps]
    made = bench(depth=0, duration_s=1.0, profile=profile_with(KIND, DEMAND), p_sag_kw=500,
                 scenario={"events": events, "frequency_hz": hz})  # fmt: skip
    evidence = collect(made.profile, made.test, made.waveforms(), made.nominal, 500e3)
    jump = jump_at(evidence, made.test.scenario.start_s + jumps[0][0])
    assert jump.seen == seen
    assert jump.positive_deg == pytest.approx(jumps[0][1], abs=0.05)
    assert jump.phase_deg == pytest.approx(jumps[0][1], abs=0.05)


@pytest.mark.parametrize("t_s", [0.1, 0.3, 0.5919555802163262, 0.7])
@pytest.mark.parametrize("lasts_s", [0.012330603413469258, 0.1, 0.2])
def test_instants_of_jumps_are_those_of_the_timeline(bench, profile_with, t_s, lasts_s):
    """Both ends of a further sag with an angle are breakpoints, however their sum rounds."""
    sag = {"kind": "sag", "t_s": t_s, "duration_s": lasts_s, "sag": Sag(depth=0.0, phases="a", angle_deg=30)}
    made = bench(depth=0, duration_s=1.0, profile=profile_with(KIND, DEMAND), scenario={"events": [sag]}, p_sag_kw=500)
    assert made.check(KIND).status is Status.PASS


def test_a_jump_as_the_frequency_begins_to_move(bench, profile_with):
    """What a ramp of the frequency turns in the cycles of the measurement is no part of the jump."""
    ramp = {"kind": "frequency_ramp", "t_s": 0.2, "rate_hz_s": 2.0, "duration_s": 0.5}
    events = [{"kind": "phase_jump", "t_s": 0.2, "angle_deg": 20}, ramp]
    profile = profile_with(KIND, DEMAND)
    check = bench(depth=0, duration_s=1.0, profile=profile, scenario={"events": events}, p_sag_kw=500).check(KIND)
    assert check.status is Status.PASS, check.message
    assert "20.0 deg" in check.message
