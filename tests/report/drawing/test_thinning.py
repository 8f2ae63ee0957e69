import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from pvlvrt_compliance.evidence.outline import bends
from pvlvrt_compliance.report.drawing.model import values
from pvlvrt_compliance.report.drawing.parts import Grid, Part, parts_of
from pvlvrt_compliance.report.drawing.thinning import bucket_edges, enveloped, picked, sketched

signals = arrays(np.float64, st.integers(1, 400), elements=st.floats(-1e6, 1e6))


def picked_of(x, half):
    """The samples that a curve through one signal is drawn through."""
    whole = np.append(x, np.repeat(x[-1:], -len(x) % (2 * half)))
    (index,) = picked(whole[np.newaxis], len(x), half)
    return index


@given(x=signals, half=st.integers(1, 30))
def test_extremes_survive(x, half):
    """However short a peak is, the curve goes through it; it goes through each sample once; it begins and ends."""
    index = picked_of(x, half)
    assert (np.diff(index) > 0).all()
    assert (index[0], index[-1]) == (0, len(x) - 1)
    assert x[index].max() == x.max()
    assert x[index].min() == x.min()
    assert len(index) <= 2 * -(-len(x) // (2 * half)) + 2 or half == 1


@given(x=signals, half=st.integers(1, 30), at=st.integers(0, 399))
def test_a_spike_is_drawn_at_its_instant(x, half, at):
    """The curve goes through the very sample that stands out."""
    x[at % len(x)] = 1e9
    assert at % len(x) in picked_of(x, half)


@given(x=signals, buckets=st.integers(1, 60))
def test_a_band_holds_every_sample(x, buckets):
    """Between straight lines through its corners lies every sample, and each corner is one of the buckets beside it."""
    edges = bucket_edges(len(x), buckets)
    lower, upper = enveloped(x, edges)
    places = np.arange(len(x))
    rounding = 1e-9 * np.abs(x).max()
    assert (np.interp(places, edges, lower) <= x + rounding).all()
    assert (np.interp(places, edges, upper) >= x - rounding).all()
    for k in range(len(edges)):
        near = x[edges[max(k - 1, 0)] : edges[min(k + 1, len(edges) - 1)]]
        assert lower[k] == near.min()
        assert upper[k] == near.max()


@given(x=signals, fine=st.floats(0, 1e6))
def test_what_a_line_leaves_out_is_near_it(x, fine):
    """Straight lines through the points that are kept pass all others within what was asked for."""
    places = np.cumsum(1 + np.arange(len(x)) % 3).astype(float)
    kept = bends(fine, places, x)
    assert kept[[0, -1]].all()
    assert (np.abs(np.interp(places, places[kept], x[kept]) - x) <= fine * (1 + 1e-9) + 1e-9).all()


def test_a_straight_line_needs_few_points():
    """Of a thousand points on a line with one bend the two ends, the bend and a few beside it are left."""
    x = np.arange(1000.0)
    assert bends(1e-9, x, np.maximum(x, 500)).sum() < 25


def test_a_sine_stays_a_sine():
    """A mains voltage over a whole record is drawn within 1 % of its amplitude, also when zoomed into."""
    dt_s, w = 40.9568e-6, 2 * np.pi * 50
    x = np.sin(w * dt_s * np.arange(41_000))
    grid = Grid(0.0, dt_s, len(x))
    (run,), strips = sketched(x, parts_of([grid], [], 0.02, 1500), 1e-4)
    assert not strips
    np.testing.assert_array_equal(run.y, x[run.x.numbers])
    middle_s = (np.asarray(values(run.x))[1:] + np.asarray(values(run.x))[:-1]) / 2
    assert np.abs((run.y[1:] + run.y[:-1]) / 2 - np.sin(w * middle_s)).max() < 0.03


@pytest.mark.parametrize("buckets", [20, 60, 150])
def test_a_sine_with_few_points_is_a_band_as_high_as_it_is(buckets):
    """However few buckets there are, what is drawn of a steady sine is its curve, or a level band between its peaks."""
    dt_s = 40.9568e-6
    x = np.sin(2 * np.pi * 50 * dt_s * np.arange(60_000))
    runs, strips = sketched(x, parts_of([Grid(0.0, dt_s, len(x))], [0.3], 0.02, buckets), 1e-4)
    assert strips
    for strip in strips:
        np.testing.assert_allclose(strip.upper, 1.0, atol=1e-3)
        np.testing.assert_allclose(strip.lower, -1.0, atol=1e-3)
        assert len(strip.lower) < 10
    assert all(len(run.y) >= 4 * 2 * 50 * (values(run.x)[-1] - values(run.x)[0]) for run in runs)


def test_what_is_not_finite_is_a_gap():
    """A record that blew up is drawn as far as it goes, as a curve and as bands, without a warning."""
    x = np.concatenate([np.full(50, np.nan), np.ones(5000), [np.inf], np.ones(300), np.full(5000, np.nan)])
    part = Part(Grid(0.0, 1e-4, len(x)), 0, len(x), 100, is_band=False, offset=0, goes_on=False)
    (run,), _ = sketched(x, [part], 0.0)
    assert np.isfinite(run.y[[0, -1]]).all()
    assert set(run.y[np.isfinite(run.y)]) == {1.0}
    _, strips = sketched(x, [part._replace(is_band=True)], 0.0)
    assert all(np.isfinite(strip.lower).all() for strip in strips)
    assert 0.5 <= values(strips[-1].x)[-1] <= 0.56
