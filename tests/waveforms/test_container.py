import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.waveforms import Segment, Waveforms
from pvlvrt_compliance.waveforms.container import unit_of

DT_S = 40.9568e-6


def ramp(t0_s, dt_s, n):
    """A channel that holds its own time."""
    return Segment(t0_s, dt_s, {"t_s": t0_s + dt_s * np.arange(n)})


@given(st.floats(-0.01, 0.1), st.floats(-0.01, 0.1), st.floats(-5, 5))
def test_a_slice_holds_the_samples_between_its_ends(start_s, stop_s, t0_s):
    """A slice holds exactly the samples with start <= t < stop, each at its own time still."""
    segment = ramp(t0_s, DT_S, 2000)
    piece = segment.slice(t0_s + start_s, t0_s + stop_s)
    t = segment["t_s"] - t0_s
    assert np.allclose(piece.t_s, piece["t_s"], rtol=0, atol=1e-12)
    # An end within round-off of a sample may fall on either side of it.
    for slack in (2e-6 * DT_S, -2e-6 * DT_S):
        inside = np.count_nonzero((t >= start_s - slack) & (t < stop_s - slack))
        assert abs(len(piece) - inside) <= 1
    assert np.all((piece["t_s"] - t0_s >= start_s - 1e-10) & (piece["t_s"] - t0_s < stop_s))


def test_a_window_in_one_segment():
    """A window is taken from the segment that holds it."""
    record = Waveforms((ramp(0.0, 1e-3, 100), ramp(0.1, 1e-2, 50)))
    assert (record.window(0.02, 0.05).dt_s, record.window(0.2, 0.4).dt_s) == (1e-3, 1e-2)
    assert len(record.window(0.2, 0.4)) == 20


def test_a_window_across_a_change_of_step_is_refused():
    """The reason is named."""
    record = Waveforms((ramp(0.0, 1e-3, 100), ramp(0.1, 1e-2, 50)))
    with pytest.raises(MeasurementError, match="crosses a change of the sampling step"):
        record.window(0.05, 0.3)


@pytest.mark.parametrize("span", [(-0.1, 0.05), (0.3, 0.9)])
def test_a_window_outside_the_record_is_refused(span):
    """A window that the record does not hold is refused, not shortened."""
    record = Waveforms((ramp(0.0, 1e-3, 100), ramp(0.1, 1e-2, 50)))
    with pytest.raises(MeasurementError, match="leaves the record"):
        record.window(*span)


def test_a_record_is_in_order_and_of_one_kind():
    """Overlapping segments and segments with other channels are refused."""
    with pytest.raises(ValueError, match="overlap"):
        Waveforms((ramp(0.0, 1e-3, 100), ramp(0.05, 1e-3, 100)))
    with pytest.raises(ValueError, match="same channels"):
        Waveforms((ramp(0.0, 1e-3, 100), Segment(1.0, 1e-3, {"v_dc_v": np.zeros(3)})))
    with pytest.raises(ValueError, match="at least one"):
        Waveforms(())
    with pytest.raises(ValueError, match="same length"):
        Segment(0.0, 1e-3, {"a": np.zeros(3), "b": np.zeros(4)})


def test_a_missing_channel_is_named():
    """Asking for a channel that is not there says which."""
    with pytest.raises(MeasurementError, match="'v_dc_v'"):
        ramp(0.0, 1e-3, 10)["v_dc_v"]


@pytest.mark.parametrize(
    ("channel", "unit"),
    [
        ("u_a_v", "V"),
        ("i_a_a", "A"),
        ("irradiance_w_m2", "W/m2"),
        ("q_ref_var", "var"),
        ("connected", ""),
        ("t_s", "s"),
        ("apparent_power_nominal_va", "VA"),
        ("m_a", ""),
        ("m_b", ""),
    ],
)
def test_the_unit_is_in_the_name(channel, unit):
    """The end of a channel's name is its unit, none for a pure number."""
    assert unit_of(channel) == unit
