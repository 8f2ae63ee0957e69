import math

import pytest

from pvlvrt_compliance.evidence.collect import disturbance_of
from pvlvrt_compliance.profile import known_profiles, load_profile
from pvlvrt_compliance.report.drawing.parts import LEAST_A_CYCLE, Grid, buckets_for, parts_of
from pvlvrt_compliance.scenario.timeline import busy_stretches
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.recorder import plan_of
from pvlvrt_compliance.simulation.simulate import _played
from pvlvrt_compliance.simulation.translate import control_period_s, plant_tables

SHIPPED = [name for name, known in known_profiles().items() if known.origin == "shipped"]


def grids_of(scenario):
    """Grids of the record that a scenario gives, without running it."""
    period_s = control_period_s(Parameters())
    busy = [*busy_stretches(scenario), *_played(plant_tables(Parameters(), scenario).playback)]
    plan = plan_of(busy, math.floor(scenario.end_s / period_s) + 1, period_s)
    stretches = zip(plan.first.tolist(), plan.step.tolist(), plan.rows, strict=False)
    return [Grid(first * period_s, step * period_s, rows) for first, step, rows in stretches]


@pytest.fixture(scope="module", params=SHIPPED)
def shipped(request):
    """Each test of a shipped profile: grids of its record, when something happens (s), a cycle (s)."""
    profile = load_profile(request.param)
    found = {}
    for test in profile.tests():
        steps_s = [step.at_s for step in disturbance_of(profile, test).steps]
        found[test.id] = grids_of(test.scenario), steps_s, 1 / test.scenario.frequency_hz
    return found


@pytest.mark.parametrize("figures", [1, 35, 500])
def test_what_is_drawn_as_a_curve_has_points_enough(shipped, figures):
    """In every shipped test a curve has four buckets of two points a cycle at least, or all samples; the rest is bands.

    A sine through fewer points than that is another curve.
    """
    for name, (grids, steps_s, cycle_s) in shipped.items():
        for part in parts_of(grids, steps_s, cycle_s, buckets_for(figures)):
            samples_a_cycle = cycle_s / part.grid.dt_s
            if part.half_bucket == 1:
                assert samples_a_cycle >= 2 * LEAST_A_CYCLE, name
            elif not part.is_band:
                assert samples_a_cycle / (2 * part.half_bucket) >= LEAST_A_CYCLE, name
            else:
                length_s = (part.end - part.first) * part.grid.dt_s
                assert part.buckets == 1 or length_s / part.buckets >= cycle_s * (1 - 1e-9), name


@pytest.mark.parametrize("figures", [1, 35, 500])
def test_every_sample_is_in_one_part_and_few_points_are_drawn(shipped, figures):
    """The parts follow each other from the first sample to the last, and need no more buckets than there are."""
    for grids, steps_s, cycle_s in shipped.values():
        buckets = buckets_for(figures)
        parts = parts_of(grids, steps_s, cycle_s, buckets)
        spans = [(part.offset + part.first, part.offset + part.end) for part in parts]
        assert [end for _, end in spans[:-1]] == [begin for begin, _ in spans[1:]]
        assert (spans[0][0], spans[-1][1]) == (0, sum(grid.samples for grid in grids))
        assert sum(min(part.buckets, part.end - part.first) for part in parts) <= buckets + len(grids) + len(parts)
        assert all(part.goes_on for part in parts[:-1])


def test_steps_are_drawn_close():
    """Where a record is too long for a curve, the cycles around each step have one, with points enough to be read."""
    grid, steps_s = Grid(0.0, 4e-5, 100_000), [1.0, 3.0]
    parts = parts_of([grid], steps_s, 0.02, 300)
    curves = [(part.first * grid.dt_s, part.end * grid.dt_s) for part in parts if not part.is_band]
    assert len(curves) == 2
    for (begin_s, end_s), step_s in zip(curves, steps_s, strict=True):
        assert begin_s == pytest.approx(step_s - 0.02, abs=1e-3)
        assert end_s > step_s + 0.08


def test_with_many_steps_the_first_and_the_last_are_drawn_close():
    """Buckets that are too few for all are for the first departure and the last return."""
    parts = parts_of([Grid(0.0, 4e-5, 400_000)], [1.0 + 0.5 * k for k in range(20)], 0.02, 300)
    begins_s = [part.first * 4e-5 for part in parts if not part.is_band]
    assert begins_s == pytest.approx([0.98, 10.48], abs=1e-3)


def test_a_gap_in_a_record_stays_one():
    """Segments that do not follow each other are not joined."""
    parts = parts_of([Grid(0.0, 1e-3, 100), Grid(0.1, 1e-3, 100), Grid(0.3, 1e-3, 100)], [], 0.02, 1500)
    assert [part.goes_on for part in parts] == [True, False, False]


def test_the_more_figures_the_fewer_points():
    """A single figure has 1500 buckets, one of five hundred has 120."""
    assert [buckets_for(figures) for figures in (0, 1, 50, 100, 500, 5000)] == [1500, 1500, 1200, 600, 120, 100]
