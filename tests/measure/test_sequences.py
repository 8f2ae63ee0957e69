import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.sequences import phase_amplitudes, sequence_phasors
from pvlvrt_compliance.space_vectors import phases

phasors = st.complex_numbers(max_magnitude=400)


@given(phasors, phasors, phasors, st.floats(45, 66))
@draws(40)
def test_sequences_come_back(three_phase, segment, positive, negative, zero, frequency_hz):
    """A record made of three sequences gives these sequences at every sample after the first cycle."""
    record = segment(three_phase("u", (positive, negative, zero), frequency_hz, 1200))
    found = sequence_phasors(record, "u", frequency_hz)
    for phasor, expected in zip(found, (positive, negative, zero), strict=True):
        assert np.nanmax(np.abs(phasor - expected)) < 1e-5


@given(phasors, phasors)
@draws(20)
def test_phase_amplitudes_are_those_of_the_phasors(three_phase, segment, positive, negative):
    """Each phase's amplitude is that of the sum of its sequences, for currents too."""
    record = segment(three_phase("i", (positive, negative, 0), 50, 1200))
    found = phase_amplitudes(record, "i", 50)
    assert found.shape == (3, 1200)
    assert np.nanmax(np.abs(found - np.abs(phases(positive, negative, 0))[:, np.newaxis])) < 1e-5


def test_harmonics_do_not_show(three_phase, segment):
    """10 % of 5th (negative) and 7th (positive sequence) change the sequences by less than 1e-6."""
    harmonics = {5: (0, 0.1, 0), 7: (0.1j, 0, 0)}
    record = segment(three_phase("u0", (1, 0.2, 0.1), 50, 1200, harmonics))
    found = sequence_phasors(record, "u0", 50)
    assert [np.nanmax(np.abs(x - e)) < 1e-6 for x, e in zip(found, (1, 0.2, 0.1), strict=True)] == [True] * 3


def test_a_missing_channel_is_named(three_phase, segment):
    """A record without the channels says which one is missing."""
    with pytest.raises(MeasurementError, match="i_a_a"):
        sequence_phasors(segment(three_phase("u", (1, 0, 0), 50, 1000)), "i", 50)
