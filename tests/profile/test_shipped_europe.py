"""The tests of the shipped European codes against what the envelopes demand, and of the paper."""

from itertools import accumulate

import pytest

from pvlvrt_compliance.profile import Profile
from pvlvrt_compliance.scenario.events import PhaseJump
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.timeline import asked_sequences_pu

NTS = ("es-nts-631-lt110kv", "es-nts-631-ge110kv")
DENMARK = ("dk-rfg", "dk-rfg-dk2", "dk-rfg-lt110kv")
KINDS = ("3ph", "2phg", "1ph")


def scenarios_of(profile: Profile, start: str = "") -> list[Scenario]:
    """Scenarios of the runs whose ids begin with some letters."""
    return [test.scenario for test in profile.tests() if test.id.startswith(start)]


def rows_of(profile: Profile, start: str = ""):
    """Rows of the test table whose ids begin with some letters."""
    return [row for row in profile.all_rows if row.id.startswith(start)]


def v_positive(row) -> float:
    """V+ that the sag of a row leaves (pu)."""
    return abs(row.sag.sequences_pu().positive)


@pytest.mark.parametrize("name", NTS)
def test_sixteen_categories_twice(shipped, name):
    """NTS 631 has 16 categories of two runs, those at least power with K = 6, one each at the ends of the Q range."""
    profile = shipped[name]
    rows = rows_of(profile, "U")[:16]
    assert len([test for test in profile.tests() if test.id[0] == "U"]) == 32
    assert {row.k_factor for row in rows if row.id.endswith("Pmin")} == {6.0}
    assert {row.k_factor for row in rows if not row.id.endswith("Pmin")} == {None}
    low, high = profile.requirements.reactive_current.k_range.values
    assert (low, high) == (2, 6)
    assert {row.id: row.reactive_power_pu for row in rows if row.reactive_power_pu} == {
        "U75TPmedQmax": 0.3,
        "U75TPmedQmin": -0.3,
    }
    deepest = "U5" if name == NTS[0] else "U0"
    assert [row.id.startswith(deepest) for row in rows].count(True) == 4


@pytest.mark.parametrize("name", NTS)
def test_categories_last_as_long_as_the_envelope_demands(shipped, name):
    """Three-phase categories last at least as long as the line demands of their residual voltage.

    The label of 1.34 s is rounded: at and above 110 kV the line passes 0.75 pu 1.2 ms later.
    """
    profile = shipped[name]
    for row in rows_of(profile, "U")[:16]:
        residual_pu = v_positive(row)
        if not row.sag.two_phase:
            assert row.duration_s >= profile.envelope.time_of(residual_pu) - 0.0013
        still_demanded = float(profile.envelope.voltage_at(row.duration_s)) - residual_pu
        assert still_demanded <= profile.conditions.no_load_tolerance_pu.value + 1e-9


@pytest.mark.parametrize("name", NTS)
def test_records_outlast_the_recovery(shipped, name):
    """A record goes on for as long as the recovery of its depth may take, and one more window."""
    profile = shipped[name]
    table = profile.requirements.active_power_recovery.rows
    for test in profile.tests():
        row = table.row_for(abs(test.scenario.sag.sequences_pu().positive))
        if row is not None:
            allowed_s = row.first_s + row.final_extra_s + profile.windows.after_length_s.value
            assert test.scenario.after_s >= allowed_s


@pytest.mark.parametrize("drop", ["VD1", "VD2", "VD3", "VD4", "VD5", "VD6"])
def test_voltage_drops_stay_inside_the_envelope(shipped, drop):
    """IEC 61400-21 has no envelope of its own; its drops end before the borrowed one lets the inverter go."""
    profile = shipped["iec61400-21"]
    (row,) = rows_of(profile, drop)
    allowed_s = profile.envelope.time_of(round(v_positive(row), 9))
    assert allowed_s is None or row.duration_s < allowed_s


def test_pvvc_tests_lie_on_the_corner(shipped):
    """The lowest phase of PVVC's tests is at the level that the envelope of its kind of fault has until 0.5 s."""
    demand = shipped["es-po-12.3"].requirements.ride_through
    for row in shipped["es-po-12.3"].all_rows:
        envelope = demand.envelope_two_phase if row.sag.two_phase else demand.envelope
        lowest_pu = min(abs(phasor) for phasor in row.sag.phasors_pu())
        assert lowest_pu == pytest.approx(float(envelope.voltage_at(row.duration_s)), abs=2e-4)
        assert row.duration_s == 0.5


@pytest.mark.parametrize("name", DENMARK)
def test_faults_of_the_list_lie_on_the_envelopes(shipped, name):
    """Single faults of three and two phases in the Danish lists are to be ridden through; those of a minute are not."""
    profile = shipped[name]
    for row in profile.all_rows:
        if row.sag.depth == 0 or row.grid is not None or row.sag.phases == "a":
            continue
        residual_pu = 1 - row.sag.depth
        allowed_s = profile.envelope.time_of(round(residual_pu, 9))
        inside = allowed_s is None or row.duration_s <= allowed_s + 1e-9
        assert inside != row.id.endswith("-60s"), row.id


def test_danish_durations_are_those_of_the_eastern_line(shipped):
    """The durations of the list are 0.15 s + 1.35 s x residual/0.90, the envelope of DK2."""
    for residual_pu, duration_s in ((0.0, 0.15), (0.2, 0.45), (0.4, 0.75), (0.8, 1.35)):
        assert shipped["dk-rfg-dk2"].envelope.time_of(residual_pu) == pytest.approx(duration_s, abs=1e-12)
        rows = [row for row in shipped["dk-rfg"].all_rows if row.id in {f"{k}-{residual_pu:.2f}" for k in KINDS}]
        assert {row.duration_s for row in rows} == {duration_s}
        assert len(rows) == 3


@pytest.mark.parametrize("name", DENMARK)
def test_ride_through_profiles_follow_the_envelopes(shipped, name):
    """The voltage of the ride-through profiles is the envelope itself, just after every instant."""
    profile = shipped[name]
    demand = profile.requirements.ride_through
    for test_id, envelope in (("uvrt-profile", demand.envelope), ("ovrt-profile", demand.envelope_over_voltage)):
        scenario = scenarios_of(profile, test_id)[0]
        for share in (0.0, 0.05, 0.2, 0.5, 0.8, 0.99):
            t_s = share * scenario.duration_s + 1e-4
            applied = abs(asked_sequences_pu(scenario, scenario.start_s + t_s).positive)
            assert applied == pytest.approx(float(envelope.voltage_at(t_s)), abs=1e-9)


def test_danish_phase_jumps(shipped):
    """Jumps reach the bench's angles: 20, 0, -20 and 0 deg; 6.5, 13.25 and 20 deg within 40 ms."""
    angles = {}
    for name in ("phase-jumps-full", "phase-jump-split-full"):
        (scenario,) = scenarios_of(shipped["dk-rfg"], name)
        jumps = [event.angle_deg for event in scenario.events if isinstance(event, PhaseJump)]
        angles[name] = list(accumulate(jumps))
    assert angles == {"phase-jumps-full": [20, 0, -20, 0], "phase-jump-split-full": [6.5, 13.25, 20]}


def test_the_paper_is_complete(shipped):
    """Every figure of a test in the paper is there: simulations at both frequencies, experiments at theirs."""
    found = {(test.id.split("-")[0], test.scenario.frequency_hz) for test in shipped["rey-boue-500kva"].tests()}
    simulations = {(f"fig{n:02d}", f) for n in (7, 8, 9, 10) for f in (50.0, 60.0)}
    assert found == simulations | {(f"fig{n}", 50.0 if n < 16 else 60.0) for n in range(13, 19)}
