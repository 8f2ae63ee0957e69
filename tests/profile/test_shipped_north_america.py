"""The tests of the shipped North American codes against their regions, and the frequencies of all."""

from itertools import accumulate, pairwise

import pytest

from pvlvrt_compliance.profile import Profile
from pvlvrt_compliance.scenario.events import FrequencyRamp, FrequencyStep, FurtherSag, VoltageProfile
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.scenario.timeline import asked_sequences_pu, entries

NORTH_AMERICA = ("ieee1547-cat-ii", "ieee1547-cat-iii", "nerc-prc-029")


def scenarios_of(profile: Profile, start: str = "") -> list[Scenario]:
    """Scenarios of the runs whose ids begin with some letters."""
    return [test.scenario for test in profile.tests() if test.id.startswith(start)]


@pytest.mark.parametrize("name", NORTH_AMERICA)
def test_corner_tests_lie_inside_their_region(shipped, name):
    """A test made from a corner is shorter than its region's time, at a voltage of that region."""
    profile = shipped[name]
    regions, tests = profile.requirements.ride_through.regions, profile.procedure.corners
    corners = [row for row in profile.all_rows if row not in profile.rows]
    for row in corners:
        swell = next((event.points[1][1] for event in row.events if isinstance(event, VoltageProfile)), None)
        voltage_pu = 1 - row.sag.depth if swell is None else swell
        (region,) = [r for r in regions.rows if r.voltage_pu[0] < voltage_pu < r.voltage_pu[1]]
        assert row.duration_s == pytest.approx(region.ride_through_s(voltage_pu) - tests.inside_s)
        edges = [abs(voltage_pu - edge) for edge in region.voltage_pu]
        assert min(edges) == pytest.approx(tests.inside_pu)
        assert row.long == (row.duration_s > 600)
    timed = [row for row in regions.rows if row.ride_s is not None]
    assert {row.voltage_pu for row in timed} == {
        next(r.voltage_pu for r in regions.rows if r.voltage_pu[0] < v < r.voltage_pu[1])
        for v in (float(row.id.partition("pu")[0]) for row in corners)
    }


def test_long_runs(shipped):
    """Only the half hour of PRC-029-1 waits for a request."""
    long = {name: [test.id for test in profile.tests() if test.long] for name, profile in shipped.items()}
    assert {name: ids for name, ids in long.items() if ids} == {
        "nerc-prc-029": ["1.095pu-1800s-full", "1.095pu-1800s-partial"]
    }


@pytest.mark.parametrize(
    ("name", "test_id", "orders_s"),
    [
        ("ieee1547-cat-ii", "low-voltage-full", (15.0, 135.0, 138.0)),
        ("ieee1547-cat-ii", "high-voltage-full", (11.0, 131.0)),
        ("ieee1547-cat-iii", "low-voltage-full", (25.0, 25.0, 145.0, 145.0)),
        ("ieee1547-cat-iii", "high-voltage-full", (17.0, 17.0, 137.0, 137.0)),
    ],
)
def test_step_sequences_last_as_listed(shipped, name, test_id, orders_s):
    """A sequence lasts as long as the orders that it joins."""
    (scenario,) = scenarios_of(shipped[name], test_id)
    assert scenario.duration_s == pytest.approx(sum(orders_s), abs=1e-9)
    assert scenario.frequency_hz == 60


@pytest.mark.parametrize(
    ("name", "table", "order"),
    [
        ("ieee1547-cat-ii", "cat-ii-low", "BCDE"),
        ("ieee1547-cat-ii", "cat-ii-high", "BCD"),
        ("ieee1547-cat-iii", "cat-iii-low", "B"),
        ("ieee1547-cat-iii", "cat-iii-high", "B"),
    ],
)
def test_steps_end_on_the_corners_of_the_regions(shipped, name, table, order):
    """The time since the first step, at the end of each, is what a region that has its level demands."""
    profile = shipped[name]
    steps = profile.procedure.steps[table].in_order(order)
    regions = profile.requirements.ride_through.regions.rows
    for step, since_s in zip(steps, accumulate(step.duration_s for step in steps), strict=True):
        low_to_high = [r for r in regions if r.voltage_pu[0] <= step.voltage_pu <= r.voltage_pu[1]]
        meeting = [r for r in low_to_high if r.ride_s is not None]
        demands = [r.ride_through_s(step.voltage_pu) for r in meeting]
        assert any(since_s == pytest.approx(demand, abs=0.0015) for demand in demands)


@pytest.mark.parametrize(
    ("table", "step", "range_pu"),
    [
        ("cat-iii-low", "A", (0.88, 1.0)),
        ("cat-iii-low", "B", (0.0, 0.05)),
        ("cat-iii-low", "C", (0.0, 0.5)),
        ("cat-iii-low", "C'", (0.52, 0.70)),
        ("cat-iii-low", "D", (0.50, 0.70)),
        ("cat-iii-low", "E", (0.88, 1.0)),
        ("cat-iii-high", "A", (1.0, 1.1)),
        ("cat-iii-high", "B", (1.18, 1.20)),
        ("cat-iii-high", "B'", (1.12, 1.20)),
        ("cat-iii-high", "C", (1.0, 1.1)),
    ],
)
def test_conditions_lie_inside_their_ranges(shipped, table, step, range_pu):
    """Voltages of 1547.1's conditions lie in their ranges, and clear of an edge beyond which another region begins."""
    profile = shipped["ieee1547-cat-iii"]
    (used,) = profile.procedure.steps[table].in_order(step)
    low, high = range_pu
    assert low <= used.voltage_pu <= high
    edges = {edge for region in profile.ride_through.regions.rows for edge in region.voltage_pu}
    assert used.voltage_pu not in edges


def test_largest_jump_of_prc_029(shipped):
    """R1's 25 degrees are jumped ahead and back, and are no more than must be ridden through."""
    profile = shipped["nerc-prc-029"]
    demand = profile.requirements.phase_jump_ride_through
    assert (demand.all_phases_deg.value, demand.all_phases_deg.confidence) == (25, "confirmed")
    jumps = {scenario.events[0].angle_deg for scenario in scenarios_of(profile, "phase-jump-")}
    assert jumps == {25, -25}


@pytest.mark.parametrize("name", NORTH_AMERICA[:2])
@pytest.mark.parametrize(("test_id", "phases"), [("low-voltage-one-phase", "a"), ("low-voltage-two-phases", "ab")])
def test_step_sequences_of_some_phases(shipped, name, test_id, phases):
    """In one and two phases the steps follow one another without a gap and reach the levels of all three."""
    (scenario,) = scenarios_of(shipped[name], test_id)
    (together,) = scenarios_of(shipped[name], "low-voltage-full")
    steps = [event for event in scenario.events if isinstance(event, FurtherSag)]
    assert {event.sag.phases for event in steps} == {phases}
    assert all(b.t_s == pytest.approx(a.t_s + a.duration_s) for a, b in pairwise(steps))
    for step in steps:
        middle_s = scenario.start_s + step.t_s + step.duration_s / 2
        assert 1 - step.sag.depth == pytest.approx(abs(asked_sequences_pu(together, middle_s).positive))
        positive = 1 - step.sag.depth * len(phases) / 3
        assert abs(asked_sequences_pu(scenario, middle_s).positive) == pytest.approx(positive)


@pytest.mark.parametrize("name", [*NORTH_AMERICA, "dk-rfg", "es-nts-631-lt110kv"])
def test_frequencies_stay_within_the_bands(shipped, name):
    """No test drives the frequency out of the bands in which the inverter must stay connected."""
    demand = shipped[name].requirements.frequency_ride_through
    for scenario in scenarios_of(shipped[name]):
        moves = [event for event in scenario.events if isinstance(event, FrequencyRamp | FrequencyStep)]
        if moves:
            rows = demand.bands.rows
            frequencies_hz = [entry.frequency_hz for entry in entries(scenario)]
            assert rows[0].frequency_hz[0] - 1e-9 <= min(frequencies_hz)
            assert max(frequencies_hz) <= rows[-1].frequency_hz[1] + 1e-9


@pytest.mark.parametrize("name", NORTH_AMERICA)
@pytest.mark.parametrize(("test_id", "edge_hz"), [("frequency-high", 61.2), ("frequency-low", 58.8)])
def test_time_in_the_outer_frequency_bands(shipped, name, test_id, edge_hz):
    """The frequency stays beyond the edge of continuous operation for 298 s and comes back to nominal."""
    (scenario,) = scenarios_of(shipped[name], test_id)
    there, back = (event for event in scenario.events if isinstance(event, FrequencyRamp))
    crossing_s = (edge_hz - 60) / there.rate_hz_s
    furthest_hz = 60 + there.rate_hz_s * there.duration_s
    returning_s = back.t_s + (edge_hz - furthest_hz) / back.rate_hz_s
    assert returning_s - crossing_s == pytest.approx(298)
    assert furthest_hz + back.rate_hz_s * back.duration_s == pytest.approx(60)


@pytest.mark.parametrize(
    ("name", "rate_hz_s"), [("ieee1547-cat-ii", 2.0), ("ieee1547-cat-iii", 3.0), ("nerc-prc-029", 5.0)]
)
def test_rates_of_change_are_those_demanded(shipped, name, rate_hz_s):
    """Frequency moves up and down, there and back, at the rate that must be ridden through."""
    assert shipped[name].requirements.frequency_ride_through.rocof_hz_s.value == rate_hz_s
    for scenario in scenarios_of(shipped[name], "rocof-"):
        assert [abs(event.rate_hz_s) for event in scenario.events] == [rate_hz_s, rate_hz_s]
        assert sum(event.rate_hz_s * event.duration_s for event in scenario.events) == pytest.approx(0)


def test_cumulative_dips(shipped):
    """Two dips of PRC-029-1 together stay 20 ms below the time of their region, within its window."""
    regions = shipped["nerc-prc-029"].requirements.ride_through.regions
    for scenario in scenarios_of(shipped["nerc-prc-029"], "cumulative-"):
        dips = [event for event in scenario.events if isinstance(event, FurtherSag)]
        residual_pu = 1 - dips[0].sag.depth
        (region,) = [r for r in regions.rows if r.voltage_pu[0] <= residual_pu < r.voltage_pu[1]]
        assert sum(dip.duration_s for dip in dips) == pytest.approx(region.ride_s - 0.02)
        assert scenario.duration_s <= regions.cumulative_window_s
        assert abs(asked_sequences_pu(scenario, scenario.start_s).positive) == pytest.approx(residual_pu)


@pytest.mark.parametrize("name", NORTH_AMERICA[:2])
def test_power_quality_is_judged_in_steady_operation(shipped, name):
    """Harmonics and direct current are judged on a healthy grid alone, and nothing else there."""
    for test in shipped[name].tests():
        kinds = {kind for kind, _ in shipped[name].requirements.by_kind() if test.judges(kind)}
        assert (kinds == {"harmonics", "dc_injection"}) == test.id.startswith("steady")
        assert kinds.isdisjoint({"harmonics", "dc_injection"}) != test.id.startswith("steady")
