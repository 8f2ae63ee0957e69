import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.phase_quantities import line_to_line, line_to_line_amplitudes
from pvlvrt_compliance.space_vectors import phases

phasors = st.complex_numbers(max_magnitude=400)


@given(phasors, phasors, phasors, st.floats(45, 66))
@draws(30)
def test_line_to_line_amplitudes(three_phase, segment, positive, negative, zero, frequency_hz):
    """|U_a - U_b| and so on of the phase phasors; the zero sequence plays no part."""
    record = segment(three_phase("u", (positive, negative, zero), frequency_hz, 1200))
    a, b, c = phases(positive, negative, 0)
    expected = np.abs([a - b, b - c, c - a])[:, np.newaxis]
    assert np.nanmax(np.abs(line_to_line_amplitudes(record, "u", frequency_hz) - expected)) < 1e-5


def test_waveforms_sum_to_zero(three_phase, segment):
    """u_ab + u_bc + u_ca = 0 at every sample, and u_ab leads u_a by 30 degrees at sqrt(3) times its size."""
    ab, bc, ca = line_to_line(segment(three_phase("u0", (1, 0, 0.5), 50, 600)), "u0")
    assert np.abs(ab + bc + ca).max() < 1e-12
    assert ab[0] == pytest.approx(np.sqrt(3) * np.cos(np.pi / 6))


def test_a_missing_channel_is_named(three_phase, segment):
    """A record without the channels says which one is missing."""
    with pytest.raises(MeasurementError, match="u_a_v"):
        line_to_line(segment(three_phase("i", (1, 0, 0), 50, 600)), "u")
