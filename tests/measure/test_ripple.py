import numpy as np
import pytest

from pvlvrt_compliance.errors import MeasurementError
from pvlvrt_compliance.measure.ripple import ripple_amplitude, ripple_percent


@pytest.mark.parametrize("frequency_hz", [47.2, 50.0, 60.0])
def test_the_amplitude_of_a_multiple(sinusoid, dt_s, frequency_hz):
    """Half of the peak-to-peak value of the order asked for, beside a mean and another order."""
    n = int(10 / (frequency_hz * dt_s)) + 1
    x = 800 + sinusoid(3j, 2 * frequency_hz, n) + sinusoid(0.5, 6 * frequency_hz, n)
    assert ripple_amplitude(x, dt_s, frequency_hz) == pytest.approx(3, abs=2e-4)
    assert ripple_amplitude(x, dt_s, frequency_hz, order=6) == pytest.approx(0.5, abs=2e-4)


def test_percent_of_the_mean_on_a_ramp(sinusoid, dt_s):
    """8 V on a ramp around 800 V is 1 %, within what a line fitted to twenty periods takes."""
    t = dt_s * np.arange(4884)
    x = 800 + 300 * (t - t.mean()) + sinusoid(8, 100, len(t))
    assert ripple_percent(x, dt_s, 50) == pytest.approx(1, abs=6 / (20 * np.pi) ** 2 + 1e-4)


def test_nothing_to_compare_with(dt_s):
    """A DC link that is empty has no ripple in percent, and a window under a cycle none at all."""
    assert ripple_percent(np.zeros(3000), dt_s, 50) is None
    with pytest.raises(MeasurementError, match="shorter than one cycle"):
        ripple_amplitude(np.zeros(300), dt_s, 50)
