"""Envelopes and support curves."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.profile import Envelope, SupportCurve

MARK = {"confidence": "chosen", "source": "a test"}


def envelope(points, interpolation="linear") -> Envelope:
    """Envelope of some points, with any mark."""
    return Envelope(points=tuple(points), interpolation=interpolation, voltage_quantity="positive_sequence", **MARK)


RFG = envelope([(0, 0), (0.15, 0), (1.5, 0.85)])


@st.composite
def envelopes(draw):
    """Rising or not, with vertical steps, of both interpolations."""
    gaps = draw(st.lists(st.sampled_from([0.0, 0.01, 0.15, 0.5, 1.0]), min_size=0, max_size=6))
    times = np.concatenate([[0.0], np.cumsum(gaps)])
    levels = draw(st.lists(st.floats(0, 1.2), min_size=len(times), max_size=len(times)))
    return envelope(zip(times.tolist(), levels, strict=True), draw(st.sampled_from(["linear", "step"])))


@pytest.mark.parametrize(("u_pu", "t_s"), [(0.0, 0.15), (0.1, 0.3088), (0.7, 1.2618), (0.83333, 1.4735)])
def test_time_to_ride_through(u_pu, t_s):
    """The envelope's straight line gives how long a voltage must be ridden through."""
    assert RFG.time_of(u_pu) == pytest.approx(t_s, abs=5e-5)
    assert RFG.time_of(u_pu) == pytest.approx(0.15 + u_pu / 0.85 * 1.35)


@pytest.mark.parametrize("u_pu", [0.85, 0.9, 1.0])
def test_for_ever(u_pu):
    """At and above the last level a voltage must be ridden through for ever."""
    assert RFG.time_of(u_pu) is None


def test_levels():
    """Levels are joined by straight lines and held beyond both ends."""
    assert RFG.voltage_at([-1, 0, 0.15, 0.825, 1.5, 99]) == pytest.approx([0, 0, 0, 0.425, 0.85, 0.85])


def test_steps_hold_until_the_next_point():
    """A step envelope holds each level and rises at the point itself."""
    steps = envelope([(0, 0.05), (0.2, 0.5), (1.0, 0.85)], "step")
    assert steps.voltage_at([0, 0.19, 0.2, 0.99, 1.0, 5]) == pytest.approx([0.05, 0.05, 0.5, 0.5, 0.85, 0.85])
    assert [steps.time_of(u) for u in (0.0, 0.05, 0.3, 0.5, 0.85)] == [0, 0.2, 0.2, 1.0, None]


@given(envelopes(), st.floats(0, 1.3))
def test_time_and_level_agree(shape, u_pu):
    """Up to its time a voltage is nowhere below the envelope; just past it, it is."""
    last_s = shape.points[-1][0]
    t_s = shape.time_of(u_pu)
    until = np.linspace(0, last_s + 1 if t_s is None else t_s, 50, endpoint=t_s is None)
    if t_s != 0:
        assert (shape.voltage_at(until) <= u_pu + 1e-9).all()
    if t_s is not None:
        highest = max(level for at_s, level in shape.points if at_s >= t_s)
        assert highest > u_pu


@given(envelopes(), st.lists(st.floats(-1, 10), min_size=1, max_size=20))
def test_levels_stay_between_the_points(shape, times_s):
    """Interpolation never leaves the range of the points, and arrays give what scalars give."""
    levels = shape.voltage_at(times_s)
    assert levels.shape == (len(times_s),)
    assert min(u for _, u in shape.points) - 1e-12 <= levels.min()
    assert levels.max() <= max(u for _, u in shape.points) + 1e-12
    assert levels.tolist() == [float(shape.voltage_at(t)) for t in times_s]


@given(st.floats(0, 1))
def test_eq_9(u_pu):
    """The shipped curve's points are eq (9) of the paper at every voltage."""
    curve = SupportCurve(points=((0, 0.75), (0.5, 0.75), (0.85, 0), (1, 0)), **MARK)
    expected = 0.75 if u_pu < 0.5 else 15 / 7 * (0.85 - u_pu) if u_pu < 0.85 else 0
    assert float(curve.reactive_power_at(u_pu)) == pytest.approx(expected, abs=1e-12)
