import base64

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from pvlvrt_compliance.report.decimation import decimate, typed_array

signals = arrays(np.float64, st.integers(1, 400), elements=st.floats(-1e6, 1e6))


@given(x=signals, buckets=st.integers(1, 60))
def test_extremes_survive(x, buckets):
    """However short a peak is, the drawn trace reaches it; nothing is invented; the number of points is bounded."""
    trace = decimate(0.0, 1.0, x, buckets)
    assert trace.y.max() == x.max()
    assert trace.y.min() == x.min()
    assert np.isin(trace.y, x).all()
    assert len(trace.y) <= 2 * buckets or len(trace.y) == len(x)


@given(x=signals, buckets=st.integers(1, 60), at=st.integers(0, 399))
def test_a_spike_is_drawn_near_its_instant(x, buckets, at):
    """The point of a spike lies within its bucket."""
    x[at % len(x)] = 1e9
    trace = decimate(5.0, 0.1, x, buckets)
    drawn_s = trace.x0 + trace.dx * int(np.argmax(trace.y))
    assert abs(drawn_s - (5.0 + 0.1 * (at % len(x)))) <= 2 * trace.dx


def test_a_sine_stays_a_sine():
    """A mains voltage over a whole record is drawn within 1 % of its amplitude, also when zoomed into."""
    dt_s, w = 40.9568e-6, 2 * np.pi * 50
    x = np.sin(w * dt_s * np.arange(41_000))
    trace = decimate(0.0, dt_s, x)
    drawn_s = trace.x0 + trace.dx * np.arange(len(trace.y))
    # Its ends are extreme among their neighbours, so they are kept as peaks are.
    assert np.abs(trace.y - np.sin(w * drawn_s))[2:-2].max() < 0.01


def test_what_is_not_finite_is_a_gap():
    """A record that blew up is drawn as far as it goes, without a warning."""
    x = np.concatenate([np.ones(5000), [np.inf, 1e300], np.full(5000, np.nan)])
    y = np.frombuffer(base64.b64decode(typed_array(decimate(0.0, 1e-4, x).y)["bdata"]), "<f4")
    assert np.isnan(y[-1])
    assert (y[np.isfinite(y)] == 1).all()
    assert np.isfinite(y).sum() > 0.45 * len(y)
